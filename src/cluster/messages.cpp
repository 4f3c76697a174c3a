#include "cluster/messages.h"

#include <cstring>

#include "base/error.h"

namespace limpid::cluster {

Kind kindOf(std::span<const std::byte> message) {
    if (message.empty() || static_cast<uint8_t>(message[0]) > static_cast<uint8_t>(Kind::Bye))
        throw Error("a message between the processes is damaged");
    return static_cast<Kind>(message[0]);
}

Writer& Writer::number(uint64_t value) {
    return rest(std::as_bytes(std::span<const uint64_t, 1>(&value, 1)));
}

Writer& Writer::text(std::string_view value) {
    number(value.size());
    return rest(std::as_bytes(std::span(value)));
}

Writer& Writer::rest(std::span<const std::byte> value) {
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    return *this;
}

std::span<const std::byte> Reader::take(size_t count) {
    if (count > left_.size()) throw Error("a message between the processes is damaged");
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
}

uint64_t Reader::number() {
    uint64_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
}

std::string Reader::text() {
    const auto taken = take(number());
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
}

}  // namespace limpid::cluster
