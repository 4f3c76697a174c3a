// The module limpid_mpi: messages by MPI.
//
// MPI's own waiting spins, which would take a core from a renderer that runs on it. So all calls here return
// at once, and waiting sleeps. One mutex admits one thread at a time, so MPI_THREAD_SERIALIZED is enough.
#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <list>
#include <mutex>
#include <optional>

#include "cluster/pause.h"
#include "cluster/transport.h"

namespace limpid::cluster {
namespace {

/// Messages up to this size are copied, so that a receiver that hangs does not stop the sender.
constexpr size_t smallBytes = 1024;
/// Longer ones are sent in parts: MPI counts bytes in an int, and others have the mutex between parts.
constexpr size_t partBytes = size_t{16} << 20;
/// How many long messages are received at a time. Others wait at their senders, which bounds the memory here.
constexpr size_t maxIncoming = 4;

constexpr int smallTag = 1;
constexpr int sizeTag = 2;  ///< the size of a long one, whose parts follow
constexpr int partTag = 3;

class MpiTransport final : public Transport {
  public:
    MpiTransport() {
        MPI_Comm_rank(MPI_COMM_WORLD, &place_.rank);
        MPI_Comm_size(MPI_COMM_WORLD, &place_.size);
        MPI_Comm machine{};
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, place_.rank, MPI_INFO_NULL, &machine);
        MPI_Comm_rank(machine, &place_.localRank);
        MPI_Comm_size(machine, &place_.localSize);
        MPI_Comm_free(&machine);
    }

    Place place() const override { return place_; }

    void send(int to, std::span<const std::byte> bytes) override {
        if (bytes.size() <= smallBytes) return sendLater(to, bytes, smallTag);
        const std::lock_guard whole(sending_);  // parts of two messages must not mix
        const uint64_t size = bytes.size();
        sendLater(to, std::as_bytes(std::span<const uint64_t, 1>(&size, 1)), sizeTag);
        for (size_t at = 0; at < bytes.size(); at += partBytes)
            sendPart(to, bytes.subspan(at, std::min(partBytes, bytes.size() - at)));
    }

    bool poll(int& from, std::vector<std::byte>& bytes) override {
        const std::lock_guard lock(mpi_);
        forgetSent();
        // If their senders go on after all, what follows must not count as a part of their next messages.
        forgotten_.remove_if(goOn);
        if (const auto small = probe(smallTag)) {
            from = small->MPI_SOURCE;
            bytes = receive(*small);
            return true;
        }
        acceptLong();
        for (auto message = incoming_.begin(); message != incoming_.end(); ++message) {
            if (!goOn(*message)) continue;
            from = message->from;
            bytes = std::move(message->bytes);
            incoming_.erase(message);
            return true;
        }
        return false;
    }

    void forget(int from) override {
        const std::lock_guard lock(mpi_);
        for (auto message = incoming_.begin(); message != incoming_.end();) {
            const auto next = std::next(message);
            // MPI may still write into it.
            if (message->from == from) forgotten_.splice(forgotten_.end(), incoming_, message);
            message = next;
        }
    }

    void end() override {
        const std::lock_guard lock(mpi_);
        for (Sent& sent : sent_) MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
        MPI_Finalize();
    }

    [[noreturn]] void abort(int code) override {
        MPI_Abort(MPI_COMM_WORLD, code);
        std::_Exit(code);
    }

  private:
    struct Sent {
        std::vector<std::byte> bytes;
        MPI_Request request{};
    };
    /// A long message of which parts have arrived.
    struct Incoming {
        int from = 0;
        std::vector<std::byte> bytes;
        size_t at = 0;  ///< where the part begins that is awaited
        MPI_Request request{};

        size_t partSize() const { return std::min(partBytes, bytes.size() - at); }
    };

    void sendLater(int to, std::span<const std::byte> bytes, int tag) {
        const std::lock_guard lock(mpi_);
        forgetSent();
        Sent& sent = sent_.emplace_back(Sent{{bytes.begin(), bytes.end()}, {}});
        MPI_Isend(sent.bytes.data(), static_cast<int>(sent.bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD,
                  &sent.request);
    }

    void forgetSent() {
        sent_.remove_if([](Sent& sent) {
            int done = 0;
            MPI_Test(&sent.request, &done, MPI_STATUS_IGNORE);
            return done != 0;
        });
    }

    void sendPart(int to, std::span<const std::byte> bytes) {
        MPI_Request request{};
        {
            const std::lock_guard lock(mpi_);
            MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, partTag, MPI_COMM_WORLD,
                      &request);
        }
        Pause pause;
        while (true) {
            int done = 0;
            {
                const std::lock_guard lock(mpi_);
                MPI_Test(&request, &done, MPI_STATUS_IGNORE);
            }
            if (done) return;
            pause();
        }
    }

    /// A message with this tag that has arrived.
    static std::optional<MPI_Status> probe(int tag) {
        MPI_Status status{};
        int found = 0;
        MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &found, &status);
        return found ? std::optional(status) : std::nullopt;
    }

    /// Small messages arrive whole, so receiving one does not wait.
    static std::vector<std::byte> receive(const MPI_Status& probed) {
        int count = 0;
        MPI_Get_count(&probed, MPI_BYTE, &count);
        std::vector<std::byte> bytes(static_cast<size_t>(count));
        MPI_Recv(bytes.data(), count, MPI_BYTE, probed.MPI_SOURCE, probed.MPI_TAG, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
        return bytes;
    }

    /// Begins to receive a long message. The next one of the same sender waits, as the parts of both have the
    /// same tag; its sender may have sent all parts of the one before although they are not received yet.
    void acceptLong() {
        if (incoming_.size() >= maxIncoming) return;
        const auto first = probe(sizeTag);
        const auto isOfSender = [&](const Incoming& message) { return message.from == first->MPI_SOURCE; };
        if (!first || std::ranges::any_of(incoming_, isOfSender) ||
            std::ranges::any_of(forgotten_, isOfSender))
            return;
        uint64_t size = 0;
        std::memcpy(&size, receive(*first).data(), sizeof size);
        incoming_.push_back({first->MPI_SOURCE, std::vector<std::byte>(size), 0, {}});
        receivePart(incoming_.back());
    }

    static void receivePart(Incoming& message) {
        MPI_Irecv(message.bytes.data() + message.at, static_cast<int>(message.partSize()), MPI_BYTE,
                  message.from, partTag, MPI_COMM_WORLD, &message.request);
    }

    /// Returns whether the last part has arrived.
    static bool goOn(Incoming& message) {
        int done = 0;
        MPI_Test(&message.request, &done, MPI_STATUS_IGNORE);
        if (!done) return false;
        message.at += message.partSize();
        if (message.at == message.bytes.size()) return true;
        receivePart(message);
        return false;
    }

    Place place_;
    std::mutex mpi_, sending_;
    std::list<Sent> sent_;
    std::list<Incoming> incoming_;   ///< at most one of each sender
    std::list<Incoming> forgotten_;  ///< of processes that hang; received to their ends, and discarded
};

}  // namespace
}  // namespace limpid::cluster

extern "C" __attribute__((visibility("default"))) limpid::cluster::Transport* limpid_transport(
    const char* version, const char** fault) {
    if (std::strcmp(version, LIMPID_VERSION) != 0) {
        *fault = "is of another version of Limpid";
        return nullptr;
    }
    int given = MPI_THREAD_SINGLE;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &given) != MPI_SUCCESS) {
        *fault = "MPI cannot be started";
        return nullptr;
    }
    if (given < MPI_THREAD_SERIALIZED) {
        *fault = "this MPI cannot be called from several threads (MPI_THREAD_SERIALIZED)";
        return nullptr;
    }
    static limpid::cluster::MpiTransport transport;
    return &transport;
}
