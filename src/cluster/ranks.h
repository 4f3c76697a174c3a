// Shares out pieces of work among the processes of a run: rank 0 hands them out one at a time, to whoever
// asks, and also makes some itself. Fast processes ask more often, so all finish together.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "cluster/messages.h"
#include "cluster/piece_board.h"
#include "cluster/transport.h"

namespace limpid::cluster {

using Bytes = std::vector<std::byte>;
using BytesView = std::span<const std::byte>;

/// Work in pieces that are numbers. Two ways for results: with `collect`, processes keep what they make until
/// rank 0 asks for it, and a piece is finished when it has been added there (sums of a picture). Without, a
/// piece is finished when it has been made (a file that is written).
struct SharedWork {
    uint64_t identity = 0;  ///< of the work; must be equal on all ranks
    std::string device;     ///< what this rank computes on; rank 0 warns if others have another

    /// Makes a piece; false: it was not made, and no more shall be. Called by share(), on any rank. Should
    /// call Ranks::beat() now and then.
    std::function<bool(uint64_t piece)> make;
    /// What this rank has made since the last time. Not called on rank 0.
    std::function<Bytes()> collect;
    /// A last result of this rank, when there is no work left. May be empty. Not called on rank 0.
    std::function<Bytes()> farewell;

    // The rest is for rank 0. One of these is called at a time, but perhaps during make() and from another
    // thread.
    std::deque<uint64_t> todo;                   ///< in the order in which they are handed out
    bool collectsEarly = false;                  ///< also before all is made: for checkpoints
    std::function<void(BytesView)> add;          ///< what another rank has collected
    std::function<void(BytesView)> addFarewell;  ///< another rank's last result
    /// These pieces are finished; `count` pieces of all are.
    std::function<void(const std::vector<uint64_t>& pieces, uint64_t count)> finished;
};

class Ranks {
  public:
    /// `transport` must outlive this. A process that owes an answer and was not heard of for `patience` is
    /// lost: its piece is given to another, as is everything that has not been collected.
    Ranks(Transport& transport, std::chrono::milliseconds patience);
    ~Ranks();
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    const Place& place() const { return place_; }
    bool isFirst() const { return place_.rank == 0; }

    /// Makes the work, together with the other ranks, which must call this as well. Returns on rank 0 when
    /// everything is finished or stopped and all results are added; elsewhere when there is no work left.
    /// Once in a run. Returns how many pieces each rank has made, on rank 0. If ranks differ in `identity`,
    /// the run ends with exit code 3.
    std::vector<uint64_t> share(SharedWork& work);

    /// Tells rank 0, at most once a second, that this process lives.
    void beat();

    /// Shows a message of this process, on rank 0's stderr. Equal warnings of several ranks are shown once;
    /// information of other ranks is not shown.
    void show(MessageLevel level, const std::string& text);

    /// The orderly end: elsewhere than on rank 0, waits until rank 0 comes to it. Returns false if a process
    /// was lost: then all are to be ended by abort().
    bool end();
    /// Ends all processes with one message, of the first that fails, and its exit code.
    [[noreturn]] void fail(int code, const std::string& text);
    [[noreturn]] void abort(int code);

  private:
    using Clock = std::chrono::steady_clock;
    struct Peer {
        bool greeted = false, asks = false, gone = false;
        uint64_t identity = 0;
        std::string machine, device;
        Clock::time_point heard{};
    };

    // On rank 0.
    void serve();
    void handle(int from, BytesView message);
    void handleResult(int from, BytesView message);
    void handleMade(int from);
    void answer(int rank);
    void answerAll();
    void greet(int rank);
    void loseSilent();
    void failIfToldSo();
    std::vector<uint64_t> shareFirst(SharedWork& work);
    void makeOwn(uint64_t piece);
    void tellFinished(const std::vector<uint64_t>& pieces);
    bool allGone() const;
    bool endFirst();
    // Elsewhere.
    void shareOther(SharedWork& work);
    Bytes receive();
    bool endOther();

    void send(int to, const Writer& message) { transport_.send(to, message.bytes()); }
    void slowDown() const;

    Transport& transport_;
    Place place_;
    std::chrono::milliseconds patience_;
    std::string machine_;
    Clock::time_point beaten_{};
    Bytes bye_;  ///< on ranks other than 0: the last message

    std::mutex mutex_;   ///< of the members below
    std::mutex adding_;  ///< held while the work's callbacks run; before mutex_
    std::condition_variable changed_;
    std::vector<Peer> peers_;            ///< by rank
    std::unique_ptr<PieceBoard> board_;  ///< while there is work
    SharedWork* work_ = nullptr;         ///< cleared with adding_ and mutex_ held
    struct Fault {
        int code = 0;
        std::string text;
        Clock::time_point since;
    };
    std::vector<Fault> faults_;  ///< of other ranks
    bool warnedOfDevices_ = false;
    std::mutex showing_;
    std::set<std::string> shown_;
    std::atomic<bool> failing_ = false, ending_ = false;
    std::thread server_;
};

}  // namespace limpid::cluster
