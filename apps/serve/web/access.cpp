#include "serve/web/access.h"

#include <algorithm>
#include <array>
#include <string>

#include "base/error.h"
#include "base/text/lower_case.h"

namespace limpid::serve {
namespace {

constexpr std::string_view separator = "://";

std::string_view hostOf(std::string_view origin) {
    return origin.substr(origin.find(separator) + separator.size());
}

}  // namespace

bool isLoopback(std::string_view address) {
    return address == "localhost" || address == "::1" || address == "[::1]" || address.starts_with("127.");
}

std::string parseOrigin(const std::string& text) {
    std::string origin = lowerCase(text);
    if (origin.ends_with('/')) origin.pop_back();
    const bool isWeb = origin.starts_with("https://") || origin.starts_with("http://");
    if (!isWeb || hostOf(origin).empty() ||
        hostOf(origin).find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.-:[]") != std::string::npos)
        throw UsageError("'" + text + "' is no origin, such as https://limpid.example");
    return origin;
}

bool isAllowedHost(std::string_view host, std::string_view bind, std::span<const std::string> origins) {
    if (host.empty()) return false;
    if (!isLoopback(bind)) return true;
    if (std::ranges::any_of(origins, [&](const std::string& each) { return hostOf(each) == host; }))
        return true;
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

bool isAllowedOrigin(std::string_view origin, std::string_view host, bool tls,
                     std::span<const std::string> origins) {
    return origin.empty() || origin == (tls ? "https://" : "http://") + std::string(host) ||
           std::ranges::find(origins, origin) != origins.end();
}

}  // namespace limpid::serve
