#include "serve/web/access.h"

#include <array>
#include <string>

namespace limpid::serve {

bool isLoopback(std::string_view address) {
    return address == "localhost" || address == "::1" || address == "[::1]" || address.starts_with("127.");
}

bool isAllowedHost(std::string_view host, std::string_view bind) {
    if (host.empty()) return false;
    if (!isLoopback(bind)) return true;
    const std::array<std::string, 4> names{
        "localhost", "127.0.0.1", "[::1]",
        bind.find(':') == std::string_view::npos ? std::string(bind) : "[" + std::string(bind) + "]"};
    for (const std::string& name : names) {
        if (host == name) return true;
        // Any port: behind `ssh -L` it is another one.
        if (host.starts_with(name + ":") &&
            host.find_first_not_of("0123456789", name.size() + 1) == std::string::npos)
            return true;
    }
    return false;
}

bool isAllowedOrigin(std::string_view origin, std::string_view host, bool tls) {
    return origin.empty() || origin == (tls ? "https://" : "http://") + std::string(host);
}

}  // namespace limpid::serve
