// The messages between rank 0, which hands out the work, and the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limpid::cluster {

enum class Kind : uint8_t {
    // To rank 0.
    Hello,     ///< identity of the work, machine, device; then like Ask
    Made,      ///< the piece; then like Ask
    Stopped,   ///< the piece was not made: time is up, or the user stops the run; then like Ask
    Result,    ///< answers Collect: what was made; then like Ask
    Farewell,  ///< answers End: a last result
    Beat,      ///< the process lives, and gets on with its piece
    Message,   ///< level and text, for the user
    Goodbye,   ///< answers Bye
    Fault,     ///< exit code, machine and text: the run cannot go on
    // From rank 0. A process asks for work, and gets one of the first three.
    Make,  ///< a number: the piece
    Collect,
    End,  ///< there is no work left
    Bye   ///< everything is written; a number: 1 if a process is lost, with which no orderly end is possible
};

/// A message's first byte is its kind.
Kind kindOf(std::span<const std::byte> message);

class Writer {
  public:
    // Named after what they carry; numbers are of 64 bits, texts have their length before them.
    explicit Writer(Kind kind) { bytes_.push_back(static_cast<std::byte>(kind)); }
    Writer& number(uint64_t value);
    Writer& text(std::string_view value);
    Writer& rest(std::span<const std::byte> value);
    std::span<const std::byte> bytes() const { return bytes_; }

  private:
    std::vector<std::byte> bytes_;
};

/// Reads in the same order. Throws Error if the message is too short.
class Reader {
  public:
    explicit Reader(std::span<const std::byte> message) : left_(message.subspan(1)) {}
    uint64_t number();
    std::string text();
    std::span<const std::byte> rest() const { return left_; }

  private:
    std::span<const std::byte> take(size_t count);
    std::span<const std::byte> left_;
};

}  // namespace limpid::cluster
