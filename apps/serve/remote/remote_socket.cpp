#include "serve/remote/remote_socket.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "base/error.h"

namespace limpid::serve {
namespace {

constexpr uint8_t textFrame = 1, binaryFrame = 2, closeFrame = 8, pingFrame = 9, pongFrame = 10,
                  finalBit = 0x80;
constexpr double answerSeconds = 20.0;

uint64_t bigEndian(std::string_view bytes) {
    uint64_t value = 0;
    for (const char byte : bytes) value = value << 8 | static_cast<uint8_t>(byte);
    return value;
}

}  // namespace

RemoteSocket::RemoteSocket(int port) : file_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (file_ < 0) throw Error(std::string("no socket: ") + std::strerror(errno));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int on = 1;
    ::setsockopt(file_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    if (::connect(file_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
        const int fault = errno;
        ::close(file_);
        throw Error(fmt::format("cannot connect to port {}: {}", port, std::strerror(fault)));
    }
}

RemoteSocket::~RemoteSocket() {
    if (file_ >= 0) ::close(file_);
}

RemoteSocket::RemoteSocket(RemoteSocket&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

bool RemoteSocket::send(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        bytes.remove_prefix(static_cast<size_t>(sent));
    }
    return true;
}

std::optional<std::string> RemoteSocket::receive(double seconds) {
    pollfd waiting{file_, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(seconds * 1000.0)) <= 0) return std::nullopt;
    std::string bytes(65536, '\0');
    const ssize_t count = ::recv(file_, bytes.data(), bytes.size(), 0);
    bytes.resize(count > 0 ? static_cast<size_t>(count) : 0);
    return bytes;
}

std::string RemoteSocket::receiveAll(double seconds) {
    std::string all;
    for (;;) {
        const std::optional<std::string> part = receive(seconds);
        if (!part || part->empty()) return all;
        all += *part;
    }
}

std::string sessionRequest(const std::string& host, const std::string& token, const std::string& origin) {
    return fmt::format(
        "GET /session?token={} HTTP/1.1\r\nHost: {}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: bGltcGlkIGxpbXBpZCBsaQ==\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Protocol: limpid\r\n{}\r\n",
        token, host, origin.empty() ? "" : "Origin: " + origin + "\r\n");
}

RemoteSession::RemoteSession(int port, const std::string& token) : socket_(port) {
    socket_.send(sessionRequest(fmt::format("127.0.0.1:{}", port), token));
    size_t end = std::string::npos;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
        const std::optional<std::string> part = socket_.receive(answerSeconds);
        if (!part || part->empty()) throw Error("the server does not accept a session: " + buffer_);
        buffer_ += *part;
    }
    if (!buffer_.starts_with("HTTP/1.1 101"))
        throw Error("the server does not accept a session: " + buffer_.substr(0, end));
    buffer_.erase(0, end + 4);
}

bool RemoteSession::sendText(std::string_view text) {
    return sendFrame(finalBit | textFrame, text);
}

bool RemoteSession::sendFrame(uint8_t first, std::string_view payload) {
    std::string bytes{static_cast<char>(first)};
    const size_t size = payload.size();
    const int lengthBytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
    bytes += static_cast<char>(finalBit | (lengthBytes == 0 ? size : lengthBytes == 2 ? 126 : 127));
    for (int i = lengthBytes - 1; i >= 0; --i) bytes += static_cast<char>(size >> 8 * i & 0xff);
    bytes.append(4,
                 '\0');  // the mask changes nothing: this is no browser, which must hide bytes from proxies
    return socket_.send(bytes.append(payload));
}

/// The message that the buffer's first frame ends; null: there is none. Removes frames that are complete.
std::optional<RemoteMessage> RemoteSession::takeFrame() {
    for (;;) {
        if (buffer_.size() < 2) return std::nullopt;
        const auto first = static_cast<uint8_t>(buffer_[0]), second = static_cast<uint8_t>(buffer_[1]);
        const size_t lengthBytes = second < 126 ? 0 : second == 126 ? 2 : 8, head = 2 + lengthBytes;
        if (buffer_.size() < head) return std::nullopt;
        const uint64_t size =
            lengthBytes == 0 ? second : bigEndian(std::string_view(buffer_).substr(2, lengthBytes));
        if (buffer_.size() - head < size) return std::nullopt;
        std::string payload = buffer_.substr(head, size);
        buffer_.erase(0, head + size);
        const uint8_t kind = first & 0x0f;
        if (kind == closeFrame)
            return RemoteMessage{
                RemoteMessage::Kind::Closed, {}, static_cast<int>(bigEndian(payload.substr(0, 2)))};
        if (kind == pingFrame) sendFrame(finalBit | pongFrame, payload);
        if (kind >= closeFrame) continue;
        if (kind != 0) partialKind_ = kind;
        partial_ += payload;
        if (!(first & finalBit)) continue;
        return RemoteMessage{
            partialKind_ == binaryFrame ? RemoteMessage::Kind::Picture : RemoteMessage::Kind::Text,
            std::exchange(partial_, {}), 0};
    }
}

std::optional<RemoteMessage> RemoteSession::receive(double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    for (;;) {
        if (std::optional<RemoteMessage> message = takeFrame()) return message;
        const double left = std::chrono::duration<double>(end - Clock::now()).count();
        const std::optional<std::string> part = socket_.receive(std::max(left, 0.0));
        if (!part) return std::nullopt;
        if (part->empty()) return RemoteMessage{RemoteMessage::Kind::Closed, {}, 0};
        buffer_ += *part;
    }
}

}  // namespace limpid::serve
