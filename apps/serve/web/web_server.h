// HTTP and WebSockets. The only user of libwebsockets.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "serve/serve.h"
#include "serve/web/scene_files.h"

namespace limpid::serve {

class WebServer {
  public:
    /// Accepts connections from now on. The session and the files outlive this. Throws Error if it cannot.
    WebServer(studio::Session& session, const ServeSettings& settings, const SceneFiles& files,
              std::string token);
    ~WebServer();
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;

    int port() const;
    /// Answers until `stop` returns true.
    void run(const std::function<bool()>& stop);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::serve
