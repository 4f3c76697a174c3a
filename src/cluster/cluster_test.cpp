// Tests how work is shared out, with threads as processes.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <map>
#include <numeric>

#include "cluster/launcher.h"
#include "cluster/ranks.h"

namespace limpid::cluster {
namespace {

using std::chrono::milliseconds;
using Clock = PieceBoard::Clock;

std::deque<uint64_t> pieces(uint64_t count) {
    std::deque<uint64_t> all(count);
    std::iota(all.begin(), all.end(), uint64_t{0});
    return all;
}

/// What `rank` is told: a piece's number, or -1 collect, -2 wait, -3 end.
int told(PieceBoard& board, int rank, Clock::time_point now = {}) {
    const Answer answer = board.ask(rank, now);
    return answer.order == Order::Make ? static_cast<int>(answer.piece) : -static_cast<int>(answer.order);
}
constexpr int collect = -1, waits = -2, ends = -3;

TEST(PieceBoard, GivesEachPieceOnceToWhoeverAsks) {
    PieceBoard board(pieces(4), 3, false, false);
    EXPECT_EQ(told(board, 1), 0);
    EXPECT_EQ(told(board, 0), 1);
    EXPECT_EQ(board.made(0), 1u);
    EXPECT_EQ(told(board, 0), 2);
    EXPECT_EQ(told(board, 2), 3);
    EXPECT_EQ(board.made(0), 2u);
    EXPECT_EQ(told(board, 0), waits) << "pieces 0 and 3 may come back";
    EXPECT_EQ(board.made(1), 0u);
    EXPECT_EQ(board.made(2), 3u);
    for (const int rank : {0, 1, 2}) EXPECT_EQ(told(board, rank), ends);
    EXPECT_EQ(board.finished(), 4u);
    EXPECT_EQ(board.madeByRank(), (std::vector<uint64_t>{2, 1, 1}));
}

TEST(PieceBoard, CollectsBeforeTheEnd) {
    PieceBoard board(pieces(3), 2, true, false);
    EXPECT_EQ(told(board, 1), 0);
    EXPECT_EQ(board.made(1), std::nullopt) << "not finished before it is collected";
    EXPECT_EQ(told(board, 1), 1);
    board.made(1);
    EXPECT_EQ(told(board, 0), 2);
    EXPECT_EQ(board.made(0), 2u) << "rank 0's own are finished at once";
    EXPECT_EQ(told(board, 0), waits);
    EXPECT_EQ(told(board, 1), collect);
    EXPECT_EQ(board.collected(1, {}), (std::vector<uint64_t>{0, 1}));
    EXPECT_EQ(told(board, 1), ends);
    EXPECT_EQ(told(board, 0), ends);
}

TEST(PieceBoard, CollectsEarlyInATwentiethOfTheTime) {
    PieceBoard board(pieces(10), 2, true, true);
    const auto at = [](int seconds) { return Clock::time_point{} + std::chrono::seconds(seconds); };
    EXPECT_EQ(told(board, 1, at(1)), 0);
    board.made(1);
    EXPECT_EQ(told(board, 1, at(2)), collect);
    board.collected(1, at(5));
    EXPECT_EQ(told(board, 1, at(5)), 1) << "there is nothing to collect";
    board.made(1);
    EXPECT_EQ(told(board, 1, at(64)), 2) << "it took 3 s; 60 s have not gone by";
    board.made(1);
    EXPECT_EQ(told(board, 1, at(65)), collect);
}

TEST(PieceBoard, PiecesOfALostRankGoToOthers) {
    PieceBoard board(pieces(5), 3, true, false);
    for (const int piece : {0, 1}) {
        EXPECT_EQ(told(board, 1), piece);
        board.made(1);
    }
    EXPECT_EQ(told(board, 1), 2);
    board.lose(1);
    EXPECT_TRUE(board.isLost(1));
    EXPECT_EQ(board.made(1), std::nullopt) << "too late";
    EXPECT_EQ(told(board, 1), ends);
    std::vector<int> rest;
    for (int i = 0; i < 5; ++i) {
        rest.push_back(told(board, 0));
        board.made(0);
    }
    EXPECT_EQ(rest, (std::vector<int>{0, 1, 2, 3, 4}));
    EXPECT_EQ(told(board, 0), ends);
    EXPECT_EQ(board.madeByRank(), (std::vector<uint64_t>{5, 0, 0}));
}

TEST(PieceBoard, AfterAStopEverybodyEnds) {
    PieceBoard board(pieces(9), 3, true, false);
    told(board, 0);
    told(board, 1);
    told(board, 2);
    board.stop(1);
    board.made(2);
    EXPECT_EQ(told(board, 1), ends);
    EXPECT_EQ(told(board, 2), collect);
    board.made(0);
    EXPECT_EQ(told(board, 0), waits);
    board.collected(2, {});
    EXPECT_EQ(told(board, 0), ends);
    EXPECT_EQ(board.finished(), 2u);
}

TEST(Messages, SayWhatWasWrittenAndRefuseWhatIsTooShort) {
    Writer writer(Kind::Fault);
    writer.number(3).text("node7").text("");
    const auto bytes = writer.bytes();
    EXPECT_EQ(kindOf(bytes), Kind::Fault);
    Reader reader(bytes);
    EXPECT_EQ(reader.number(), 3u);
    EXPECT_EQ(reader.text(), "node7");
    EXPECT_EQ(reader.text(), "");
    EXPECT_THROW(reader.number(), Error);
    EXPECT_THROW(Reader(bytes.first(11)).text(), Error) << "a text of 3 letters, of which 2 are there";
    EXPECT_THROW(kindOf({}), Error);
    const std::byte unknown{200};
    EXPECT_THROW(kindOf(std::span(&unknown, 1)), Error);
}

/// What passes between the threads that stand for processes.
class Post {
  public:
    explicit Post(int size) : boxes_(static_cast<size_t>(size)) {}
    void send(int from, int to, std::span<const std::byte> bytes) {
        const std::lock_guard lock(mutex_);
        boxes_[static_cast<size_t>(to)].emplace_back(from, Bytes(bytes.begin(), bytes.end()));
    }
    bool poll(int rank, int& from, Bytes& bytes) {
        const std::lock_guard lock(mutex_);
        auto& box = boxes_[static_cast<size_t>(rank)];
        if (box.empty()) return false;
        from = box.front().first;
        bytes = std::move(box.front().second);
        box.pop_front();
        return true;
    }
    int size() const { return static_cast<int>(boxes_.size()); }

  private:
    std::mutex mutex_;
    std::vector<std::deque<std::pair<int, Bytes>>> boxes_;
};

class ThreadTransport : public Transport {
  public:
    ThreadTransport(Post& post, int rank) : post_(post), rank_(rank) {}
    Place place() const override { return {rank_, post_.size(), rank_, post_.size()}; }
    void send(int to, std::span<const std::byte> bytes) override { post_.send(rank_, to, bytes); }
    bool poll(int& from, Bytes& bytes) override { return post_.poll(rank_, from, bytes); }
    void forget(int) override {}
    void end() override {}
    [[noreturn]] void abort(int code) override { std::_Exit(code); }

  private:
    Post& post_;
    int rank_;
};

/// Sums what `of` gives for each piece, on several ranks. `beforePiece`: to be slow.
struct SharedSum {
    uint64_t sum = 0, finished = 0;
    bool orderly = true, thrown = false;  ///< by beforePiece, on rank 0
    std::vector<uint64_t> byRank;

    void run(int ranks, uint64_t count, bool early,
             const std::function<void(int rank, uint64_t piece)>& beforePiece,
             milliseconds patience = milliseconds(60'000)) {
        Post post(ranks);
        std::vector<std::thread> threads;
        for (int rank = 0; rank < ranks; ++rank)
            threads.emplace_back([&, rank] { runRank(post, rank, count, early, beforePiece, patience); });
        for (std::thread& thread : threads) thread.join();
    }

  private:
    void runRank(Post& post, int rank, uint64_t count, bool early, const auto& beforePiece,
                 milliseconds patience) {
        ThreadTransport transport(post, rank);
        Ranks self(transport, patience);
        uint64_t own = 0;
        std::vector<uint64_t> made;
        try {
            made = share(self, rank, own, count, early, beforePiece);
        } catch (const std::runtime_error&) {
            thrown = true;
            std::this_thread::sleep_for(milliseconds(100));  // the others' results still arrive
        }
        const bool good = self.end();
        if (rank != 0) return;
        sum = own;
        byRank = made;
        orderly = good;
    }
    std::vector<uint64_t> share(Ranks& self, int rank, uint64_t& own, uint64_t count, bool early,
                                const auto& beforePiece) {
        std::mutex mutex;
        SharedWork work;
        work.todo = pieces(count);
        work.collectsEarly = early;
        work.make = [&](uint64_t piece) {
            beforePiece(rank, piece);
            const std::lock_guard lock(mutex);
            own += (piece + 1) * (piece + 1);
            return true;
        };
        work.collect = [&] {
            const uint64_t value = std::exchange(own, 0);
            const auto bytes = std::as_bytes(std::span<const uint64_t, 1>(&value, 1));
            return Bytes(bytes.begin(), bytes.end());
        };
        work.add = [&](BytesView bytes) {
            uint64_t value = 0;
            std::memcpy(&value, bytes.data(), sizeof value);
            const std::lock_guard lock(mutex);
            own += value;
        };
        work.finished = [&](const std::vector<uint64_t>&, uint64_t done) { finished = done; };
        return self.share(work);
    }
};

constexpr uint64_t squaresUpTo(uint64_t n) {
    return n * (n + 1) * (2 * n + 1) / 6;
}

TEST(Ranks, MakeTheSameTogetherAsAlone) {
    for (const int ranks : {1, 2, 5}) {
        for (const bool early : {false, true}) {
            SharedSum work;
            work.run(ranks, 40, early, [](int, uint64_t) {});
            EXPECT_EQ(work.sum, squaresUpTo(40)) << ranks;
            EXPECT_EQ(work.finished, 40u);
            EXPECT_TRUE(work.orderly);
            EXPECT_EQ(std::accumulate(work.byRank.begin(), work.byRank.end(), uint64_t{0}), 40u);
        }
    }
}

/// A tenfold slower rank makes about a tenth of what the others make.
TEST(Ranks, ASlowOneMakesLess) {
    for (const int slow : {0, 1}) {
        SharedSum work;
        work.run(3, 42, false, [&](int rank, uint64_t) {
            std::this_thread::sleep_for(milliseconds(rank == slow ? 100 : 10));
        });
        EXPECT_EQ(work.sum, squaresUpTo(42));
        EXPECT_GE(work.byRank[static_cast<size_t>(slow)], 1u);
        EXPECT_LE(work.byRank[static_cast<size_t>(slow)], 5u) << "2 of 42, if threads run as they should";
    }
}

/// It comes back after the end, or while the others work: in both cases it is too late.
TEST(Ranks, WhatOneThatHangsHasMadeIsMadeByOthers) {
    for (const int pieceTime : {5, 40}) {
        std::atomic<int> calls = 0;
        SharedSum work;
        work.run(
            3, 30, false,
            [&](int rank, uint64_t) {
                std::this_thread::sleep_for(milliseconds(pieceTime));
                if (rank == 2 && ++calls == 3) std::this_thread::sleep_for(milliseconds(600));
            },
            milliseconds(300));
        EXPECT_EQ(work.sum, squaresUpTo(30));
        EXPECT_EQ(work.byRank[2], 0u) << "it was not collected";
        EXPECT_EQ(work.finished, 30u);
    }
}

/// Its work is gone while results of the others still arrive.
TEST(Ranks, AFaultOfTheFirstEndsTheWork) {
    SharedSum work;
    work.run(3, 1000, true, [&](int rank, uint64_t piece) {
        std::this_thread::sleep_for(milliseconds(2));
        if (rank == 0 && piece > 10) throw std::runtime_error("no scene");
    });
    EXPECT_TRUE(work.thrown);
    EXPECT_FALSE(work.orderly);
    EXPECT_LT(work.finished, 1000u);
}

TEST(Launcher, TheTimeOfSilenceIsANumberOfSeconds) {
    EXPECT_EQ(patienceOf(nullptr), std::chrono::minutes(10));
    EXPECT_EQ(patienceOf(""), std::chrono::minutes(10));
    EXPECT_EQ(patienceOf("2.5"), milliseconds(2500));
    EXPECT_EQ(patienceOf("1e9"), std::chrono::seconds(1'000'000'000));
    for (const char* wrong : {"soon", "60s", " 60", "nan", "inf", "-5", "0", "1", "1e10", "1e999"})
        EXPECT_THROW(patienceOf(wrong), UsageError) << wrong;
}

TEST(Launcher, IsKnownByItsVariables) {
    const auto find = [](const std::map<std::string, std::string>& variables) {
        return findLaunch([&](const char* name) {
            const auto entry = variables.find(name);
            return entry == variables.end() ? nullptr : entry->second.c_str();
        });
    };
    EXPECT_FALSE(find({}).launched);
    const Launch open = find({{"OMPI_COMM_WORLD_RANK", "3"}, {"OMPI_COMM_WORLD_SIZE", "8"}});
    EXPECT_TRUE(open.launched);
    EXPECT_EQ(open.rank, 3);
    EXPECT_EQ(open.size, 8);
    EXPECT_EQ(find({{"PMI_RANK", "1"}, {"PMI_SIZE", "2"}}).size, 2);
    EXPECT_EQ(find({{"PMIX_RANK", "1"}, {"SLURM_STEP_NUM_TASKS", "4"}}).size, 4);
    EXPECT_FALSE(find({{"SLURM_PROCID", "1"}, {"SLURM_STEP_NUM_TASKS", "4"}}).launched) << "srun --mpi=none";
    EXPECT_FALSE(find({{"OMPI_COMM_WORLD_RANK", "3"}, {"LIMPID_MPI", "0"}}).launched);
}

}  // namespace
}  // namespace limpid::cluster
