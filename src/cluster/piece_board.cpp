#include "cluster/piece_board.h"

#include <algorithm>
#include <utility>

namespace limpid::cluster {

PieceBoard::PieceBoard(std::deque<uint64_t> todo, int ranks, bool collects, bool early)
    : todo_(std::move(todo)), ranks_(static_cast<size_t>(ranks)), collects_(collects), early_(early) {}

bool PieceBoard::othersHold(int rank) const {
    for (size_t i = 0; i < ranks_.size(); ++i) {
        const Rank& other = ranks_[i];
        if (i != static_cast<size_t>(rank) && !other.lost && (other.piece || !other.uncollected.empty()))
            return true;
    }
    return false;
}

Answer PieceBoard::ask(int rank, Clock::time_point now) {
    Rank& self = at(rank);
    if (self.lost) return {Order::End};
    const bool workLeft = !stopped_ && !todo_.empty();
    const bool due = !workLeft || (early_ && now - self.collectedLast >= 20 * self.cost);
    if (!self.uncollected.empty() && due) {
        self.ordered = now;
        return {Order::Collect};
    }
    if (workLeft) {
        self.piece = todo_.front();
        todo_.pop_front();
        return {Order::Make, *self.piece};
    }
    // Rank 0 adds what the others send, and a rank that is lost gives its pieces back.
    const bool mayComeBack = othersHold(rank) && (!stopped_ || rank == 0);
    return {mayComeBack ? Order::Wait : Order::End};
}

std::optional<uint64_t> PieceBoard::made(int rank) {
    Rank& self = at(rank);
    if (self.lost || !self.piece) return std::nullopt;
    const uint64_t piece = *std::exchange(self.piece, std::nullopt);
    ++self.count;
    if (collects_ && rank != 0) {
        self.uncollected.push_back(piece);
        return std::nullopt;
    }
    ++finished_;
    return piece;
}

void PieceBoard::stop(int rank) {
    stopped_ = true;
    at(rank).piece.reset();
}

std::vector<uint64_t> PieceBoard::collected(int rank, Clock::time_point now) {
    Rank& self = at(rank);
    self.collectedLast = now;
    self.cost = now - self.ordered;
    finished_ += self.uncollected.size();
    return std::exchange(self.uncollected, {});
}

void PieceBoard::lose(int rank) {
    Rank& self = at(rank);
    self.lost = true;
    self.count -= self.uncollected.size();
    if (self.piece) self.uncollected.push_back(*self.piece);
    todo_.insert(todo_.begin(), self.uncollected.begin(), self.uncollected.end());
    self.uncollected.clear();
    self.piece.reset();
}

bool PieceBoard::anyLost() const {
    return std::ranges::any_of(ranks_, &Rank::lost);
}

std::vector<uint64_t> PieceBoard::madeByRank() const {
    std::vector<uint64_t> counts;
    for (const Rank& rank : ranks_) counts.push_back(rank.count);
    return counts;
}

}  // namespace limpid::cluster
