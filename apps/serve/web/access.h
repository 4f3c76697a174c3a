// Who may connect: checks of addresses and names, without a network.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace limpid::serve {

/// Whether an address is this machine's own: 127.x.x.x, ::1 or localhost.
bool isLoopback(std::string_view address);

/// An origin as browsers name it: "https://limpid.example" of "https://Limpid.Example/". Throws UsageError if
/// the text is more than a scheme, a name and perhaps a port.
std::string parseOrigin(const std::string& text);

/// Whether a Host header may name this server. On a loopback address only its own names may, with any port,
/// and those of `origins`: a page of another site whose name was made to point here has another one.
/// Elsewhere the machine's names are unknown: all may.
bool isAllowedHost(std::string_view host, std::string_view bind, std::span<const std::string> origins = {});

/// Whether the page that opens a WebSocket came from this server, or from one of `origins`: proxies that pass
/// it on. `origin`: the Origin header; empty: the client is no browser.
bool isAllowedOrigin(std::string_view origin, std::string_view host, bool tls,
                     std::span<const std::string> origins = {});

}  // namespace limpid::serve
