#include "serve/serve.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "serve/web/access.h"
#include "serve/web/token.h"
#include "serve/web/web_server.h"

namespace limpid::serve {

void serve(studio::Session& session, const ServeSettings& settings, const std::function<bool()>& stop,
           const std::function<void(const std::string& url)>& ready) {
    const bool tls = !settings.certificate.empty();
    if (!isLoopback(settings.bind) && !tls)
        log::warn(
            "{} can be reached from other machines, and without TLS, anyone on the network path can read "
            "and change the traffic, including the token; use --certificate and --key, or the default "
            "address and 'ssh -L'",
            settings.bind);
    const SceneFiles files(settings.files);
    const std::string token = makeToken();
    WebServer server(session, settings, files, token);
    const std::string host =
        settings.bind.find(':') == std::string::npos ? settings.bind : "[" + settings.bind + "]";
    ready(fmt::format("{}://{}:{}/?token={}", tls ? "https" : "http", host, server.port(), token));
    server.run(stop);
}

}  // namespace limpid::serve
