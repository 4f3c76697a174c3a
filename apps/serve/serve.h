// `limpid serve`: a session in a browser.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "serve/stream/stream_settings.h"
#include "studio/session.h"

namespace limpid::serve {

struct ServeSettings {
    std::string bind = "127.0.0.1";          ///< address that connections are accepted on
    uint16_t port = 0;                       ///< 0: a free one
    std::filesystem::path certificate, key;  ///< PEM files for TLS; both or none
    /// Of the page, beside its own address: those of proxies that pass it on (web/access.h, parseOrigin()).
    std::vector<std::string> origins = {};
    std::filesystem::path files;  ///< folder whose scenes may be opened; empty: only built-in ones
    uint64_t uploads = 0;         ///< bytes of the largest file that may be uploaded; 0: none
    unsigned headerSeconds = 10;  ///< for a connection to say what it wants
    double stillSeconds = 60.0;   ///< for /picture.png to wait for a picture
    StreamSettings stream;
};

/// Serves until `stop` returns true, which is asked several times a second. `ready` gets the address of the
/// page, with its token. Throws Error if the address cannot be used, or a certificate cannot be read.
void serve(studio::Session& session, const ServeSettings& settings, const std::function<bool()>& stop,
           const std::function<void(const std::string& url)>& ready);

}  // namespace limpid::serve
