// Which piece of the work is where. Only bookkeeping: who asks, and when, is the business of cluster/ranks.h.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace limpid::cluster {

enum class Order {
    Make,     ///< a piece
    Collect,  ///< send what was made since the last time
    Wait,     ///< nothing to do now; a piece of another process may come back
    End
};

struct Answer {
    Order order = Order::End;
    uint64_t piece = 0;
};

/// A piece is to be made, or at a process, or made and not collected yet, or finished. Rank 0's own are
/// finished when they are made, and so are all where nothing is collected.
class PieceBoard {
  public:
    using Clock = std::chrono::steady_clock;

    /// `todo`: in the order in which they are handed out. `collects`: other ranks keep what they make until
    /// it is collected. `early`: it is collected while there is work left, too, but only so often that it
    /// takes at most a twentieth of a rank's time; else when there is none left.
    PieceBoard(std::deque<uint64_t> todo, int ranks, bool collects, bool early);

    Answer ask(int rank, Clock::time_point now);
    /// The rank has made the piece that it was given. Returns it if it is finished.
    std::optional<uint64_t> made(int rank);
    /// The rank's pieces since the last time are at rank 0; returns them.
    std::vector<uint64_t> collected(int rank, Clock::time_point now);
    /// The rank's pieces, but those collected, go to others. What it sends from now on does not count.
    void lose(int rank);
    /// The rank has not made its piece, and no other is handed out any more.
    void stop(int rank);

    bool isLost(int rank) const { return at(rank).lost; }
    bool anyLost() const;
    uint64_t finished() const { return finished_; }
    /// Of each rank, how many pieces it has made, without those that were lost.
    std::vector<uint64_t> madeByRank() const;

  private:
    struct Rank {
        std::optional<uint64_t> piece;  ///< that it makes
        std::vector<uint64_t> uncollected;
        uint64_t count = 0;  ///< of pieces that it has made
        bool lost = false;
        Clock::time_point ordered{};  ///< when it was told to send
        Clock::time_point collectedLast{};
        Clock::duration cost{};  ///< how long the last collection took
    };
    Rank& at(int rank) { return ranks_[static_cast<size_t>(rank)]; }
    const Rank& at(int rank) const { return ranks_[static_cast<size_t>(rank)]; }
    bool othersHold(int rank) const;

    std::deque<uint64_t> todo_;
    std::vector<Rank> ranks_;
    bool collects_, early_;
    bool stopped_ = false;
    uint64_t finished_ = 0;
};

}  // namespace limpid::cluster
