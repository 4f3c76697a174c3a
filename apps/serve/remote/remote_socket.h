// A connection to a server on this machine: plain TCP, and a WebSocket over it. For measurements and tests,
// which also send what no library would.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace limpid::serve {

/// A TCP connection to 127.0.0.1.
class RemoteSocket {
  public:
    /// Throws Error if nobody listens there.
    explicit RemoteSocket(int port);
    ~RemoteSocket();
    RemoteSocket(RemoteSocket&& other) noexcept;
    RemoteSocket& operator=(RemoteSocket&&) = delete;

    /// False: the server has closed the connection.
    bool send(std::string_view bytes);
    /// What has arrived; waits at most that long for the first byte. Empty: the server has closed the
    /// connection; null: nothing came.
    std::optional<std::string> receive(double seconds);
    /// All until the server closes the connection, or nothing comes for that long.
    std::string receiveAll(double seconds);

  private:
    int file_ = -1;
};

struct RemoteMessage {
    enum class Kind { Text, Picture, Closed } kind = Kind::Text;
    std::string bytes;  ///< of a closed connection: empty
    int closeCode = 0;  ///< of Closed: what the server gave; 0: nothing
};

/// The session of docs/serve-protocol.md, without compression.
class RemoteSession {
  public:
    /// Throws Error with the server's answer if it does not accept.
    RemoteSession(int port, const std::string& token);

    bool sendText(std::string_view text);
    /// One frame with these first two header bits and opcode, masked, as RFC 6455 has it.
    bool sendFrame(uint8_t first, std::string_view payload);
    /// The next message; null: none came in time. Pings are answered.
    std::optional<RemoteMessage> receive(double seconds);

  private:
    std::optional<RemoteMessage> takeFrame();

    RemoteSocket socket_;
    std::string buffer_;   ///< received, and not read yet
    std::string partial_;  ///< of a message of several frames
    uint8_t partialKind_ = 0;
};

/// The head of the request that opens a session; `origin`: empty for none.
std::string sessionRequest(const std::string& host, const std::string& token, const std::string& origin = {});

}  // namespace limpid::serve
