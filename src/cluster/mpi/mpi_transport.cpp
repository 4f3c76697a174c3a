// The module limpid_mpi: messages by MPI.
//
// MPI's own waiting spins, which would take a core from a renderer that runs on it. So all calls here return
// at once, and waiting sleeps. One mutex admits one thread at a time, so MPI_THREAD_SERIALIZED is enough.
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <list>
#include <mutex>
#include <thread>

#include "cluster/transport.h"

namespace limpid::cluster {
namespace {

/// MPI counts bytes in an int. Smaller parts also let others have the mutex meanwhile.
constexpr size_t partBytes = size_t{16} << 20;

constexpr int wholeTag = 1;  ///< a message of at most partBytes
constexpr int sizeTag = 2;   ///< the size of a longer one, whose parts follow
constexpr int partTag = 3;

/// Sleeps longer the longer it has waited: messages of a busy run are answered within some 50 microseconds,
/// and an idle wait costs next to nothing.
class Pause {
  public:
    void operator()() {
        std::this_thread::sleep_for(time_);
        time_ = std::min(time_ * 2, std::chrono::microseconds(1000));
    }

  private:
    std::chrono::microseconds time_{20};
};

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
        if (bytes.size() <= smallBytes) return sendLater(to, bytes);
        const std::lock_guard whole(sending_);  // parts of two messages must not mix
        if (bytes.size() <= partBytes) return sendPart(to, bytes, wholeTag);
        const uint64_t size = bytes.size();
        sendPart(to, std::as_bytes(std::span<const uint64_t, 1>(&size, 1)), sizeTag);
        for (size_t at = 0; at < bytes.size(); at += partBytes)
            sendPart(to, bytes.subspan(at, std::min(partBytes, bytes.size() - at)), partTag);
    }

    bool poll(int& from, std::vector<std::byte>& bytes) override {
        MPI_Status status{};
        int count = 0;
        {
            const std::lock_guard lock(mpi_);
            forgetSent();
            int found = 0;
            MPI_Iprobe(MPI_ANY_SOURCE, wholeTag, MPI_COMM_WORLD, &found, &status);
            if (!found) MPI_Iprobe(MPI_ANY_SOURCE, sizeTag, MPI_COMM_WORLD, &found, &status);
            if (!found) return false;
            MPI_Get_count(&status, MPI_BYTE, &count);
        }
        from = status.MPI_SOURCE;
        bytes.resize(static_cast<size_t>(count));
        receivePart(from, bytes, status.MPI_TAG);
        if (status.MPI_TAG == wholeTag) return true;
        uint64_t size = 0;
        std::memcpy(&size, bytes.data(), sizeof size);
        bytes.resize(size);
        for (size_t at = 0; at < size; at += partBytes)
            receivePart(from, std::span(bytes).subspan(at, std::min(partBytes, bytes.size() - at)), partTag);
        return true;
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
    /// Small messages are copied, so that a receiver that hangs does not stop the sender.
    static constexpr size_t smallBytes = 1024;
    struct Sent {
        std::vector<std::byte> bytes;
        MPI_Request request{};
    };

    void sendLater(int to, std::span<const std::byte> bytes) {
        const std::lock_guard lock(mpi_);
        forgetSent();
        Sent& sent = sent_.emplace_back(Sent{{bytes.begin(), bytes.end()}, {}});
        MPI_Isend(sent.bytes.data(), static_cast<int>(sent.bytes.size()), MPI_BYTE, to, wholeTag,
                  MPI_COMM_WORLD, &sent.request);
    }

    void forgetSent() {
        sent_.remove_if([](Sent& sent) {
            int done = 0;
            MPI_Test(&sent.request, &done, MPI_STATUS_IGNORE);
            return done != 0;
        });
    }

    void sendPart(int to, std::span<const std::byte> bytes, int tag) {
        MPI_Request request{};
        {
            const std::lock_guard lock(mpi_);
            MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD,
                      &request);
        }
        wait(request);
    }

    void receivePart(int from, std::span<std::byte> bytes, int tag) {
        MPI_Request request{};
        {
            const std::lock_guard lock(mpi_);
            MPI_Irecv(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, from, tag, MPI_COMM_WORLD,
                      &request);
        }
        wait(request);
    }

    void wait(MPI_Request& request) {
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

    Place place_;
    std::mutex mpi_, sending_;
    std::list<Sent> sent_;
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
