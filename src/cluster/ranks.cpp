#include "cluster/ranks.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "base/log_receiver.h"
#include "cluster/pause.h"

namespace limpid::cluster {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds beatEvery{1000};
/// How long rank 0 may take to find a fault by itself that another rank has told: then its message needs no
/// name of a machine.
constexpr milliseconds sameFault{1000};

std::string nameOfMachine() {
    std::array<char, 256> name{};
    ::gethostname(name.data(), name.size() - 1);
    return name.data();
}

}  // namespace

Ranks::Ranks(Transport& transport, milliseconds patience)
    : transport_(transport),
      place_(transport.place()),
      patience_(patience),
      machine_(nameOfMachine()),
      peers_(static_cast<size_t>(place_.size)) {
    if (isFirst() && place_.size > 1) server_ = std::thread([this] { serve(); });
}

Ranks::~Ranks() {
    ending_ = true;
    if (server_.joinable()) server_.join();
}

std::vector<uint64_t> Ranks::share(SharedWork& work) {
    if (isFirst()) return shareFirst(work);
    shareOther(work);
    return {};
}

void Ranks::beat() {
    const Clock::time_point now = Clock::now();
    if (isFirst() || now - beaten_ < beatEvery) return;
    beaten_ = now;
    send(0, Writer(Kind::Beat));
}

void Ranks::show(MessageLevel level, const std::string& text) {
    if (!isFirst()) {
        if (level >= MessageLevel::Warning)
            send(0, Writer(Kind::Message).number(static_cast<uint64_t>(level)).text(text));
        return;
    }
    const std::lock_guard lock(showing_);
    if (level < MessageLevel::Warning || shown_.insert(text).second) log::print(level, text);
}

/// For tests: LIMPID_TEST_SLOW_RANK=RANK:MILLISECONDS delays each piece of one rank, or of all (-1).
void Ranks::slowDown() const {
    const char* const text = std::getenv("LIMPID_TEST_SLOW_RANK");
    int rank = 0, time = 0;
    if (text && std::sscanf(text, "%d:%d", &rank, &time) == 2 && (rank == place_.rank || rank == -1))
        std::this_thread::sleep_for(milliseconds(time));
}

// ---- Ranks other than 0.

Bytes Ranks::receive() {
    Bytes message;
    int from = 0;
    for (Pause pause; !transport_.poll(from, message);) pause();
    return message;
}

void Ranks::shareOther(SharedWork& work) {
    send(0, Writer(Kind::Hello).number(work.identity).text(machine_).text(work.device));
    while (true) {
        const Bytes order = receive();
        switch (kindOf(order)) {
            case Kind::Make: {
                slowDown();
                send(0, Writer(work.make(Reader(order).number()) ? Kind::Made : Kind::Stopped));
                break;
            }
            case Kind::Collect:
                send(0, Writer(Kind::Result).rest(work.collect()));
                break;
            case Kind::End:
                send(0, Writer(Kind::Farewell).rest(work.farewell ? work.farewell() : Bytes()));
                return;
            case Kind::Bye:  // it was given up as lost, and is late
                bye_ = order;
                return;
            default:
                throw Error("a message between the processes is not one that was due");
        }
    }
}

// ---- Rank 0.

void Ranks::tellFinished(const std::vector<uint64_t>& pieces) {
    if (pieces.empty() || !work_ || !work_->finished) return;
    uint64_t count = 0;
    {
        const std::lock_guard lock(mutex_);
        count = board_->finished();
    }
    work_->finished(pieces, count);
}

void Ranks::makeOwn(uint64_t piece) {
    slowDown();
    const bool made = work_->make(piece);
    const std::lock_guard adding(adding_);
    std::vector<uint64_t> finished;
    {
        const std::lock_guard lock(mutex_);
        if (!made)
            board_->stop(0);
        else if (const auto done = board_->made(0))
            finished.push_back(*done);
    }
    tellFinished(finished);
}

bool Ranks::allGone() const {
    for (int rank = 1; rank < place_.size; ++rank)
        if (!peers_[static_cast<size_t>(rank)].gone && !board_->isLost(rank)) return false;
    return true;
}

std::vector<uint64_t> Ranks::shareFirst(SharedWork& work) {
    // Also if make() throws: the server goes on until the process ends, and `work` is gone before.
    const struct Leaving {
        Ranks& ranks;
        ~Leaving() {
            const std::lock_guard adding(ranks.adding_);
            const std::lock_guard lock(ranks.mutex_);
            ranks.work_ = nullptr;
        }
    } leaving{*this};
    std::unique_lock lock(mutex_);
    work_ = &work;
    board_ =
        std::make_unique<PieceBoard>(work.todo, place_.size, work.collect != nullptr, work.collectsEarly);
    for (int rank = 1; rank < place_.size; ++rank) {
        Peer& peer = peers_[static_cast<size_t>(rank)];
        peer.heard = Clock::now();
        if (peer.greeted) greet(rank);
    }
    while (true) {
        const Answer next = board_->ask(0, Clock::now());
        if (next.order == Order::End) break;
        if (next.order == Order::Make) {
            lock.unlock();
            makeOwn(next.piece);
            lock.lock();
        } else {
            changed_.wait_for(lock, milliseconds(100));
        }
    }
    changed_.wait(lock, [&] { return allGone(); });
    if (!faults_.empty()) {
        lock.unlock();
        fail(faults_.front().code, faults_.front().text);
    }
    return board_->madeByRank();
}

void Ranks::greet(int rank) {
    const Peer& peer = peers_[static_cast<size_t>(rank)];
    if (peer.identity != work_->identity) {
        constexpr Clock::time_point now{};  // rank 0 has none to tell instead
        faults_.push_back(
            {static_cast<int>(ExitCode::BadInput),
             fmt::format("process {} on {} has other work than process 0: the options, the input files and "
                         "the version of Limpid must be the same everywhere",
                         rank, peer.machine),
             now});
    }
    if (peer.device == work_->device || warnedOfDevices_) return;
    warnedOfDevices_ = true;
    show(MessageLevel::Warning,
         fmt::format("process {} on {} computes on {}, process 0 on {}: results are as good, but "
                     "their last bits depend on who makes which piece",
                     rank, peer.machine, peer.device, work_->device));
}

void Ranks::answer(int rank) {
    Peer& peer = peers_[static_cast<size_t>(rank)];
    if (!board_ || !peer.asks) return;
    const Answer next = board_->ask(rank, Clock::now());
    if (next.order == Order::Wait) return;
    peer.asks = false;
    peer.heard = Clock::now();  // time counts from the order on
    switch (next.order) {
        case Order::Make:
            return send(rank, Writer(Kind::Make).number(next.piece));
        case Order::Collect:
            return send(rank, Writer(Kind::Collect));
        default:
            return send(rank, Writer(Kind::End));
    }
}

void Ranks::answerAll() {
    const std::lock_guard lock(mutex_);
    for (int rank = 1; rank < place_.size; ++rank) answer(rank);
}

void Ranks::handleMade(int from) {
    const std::lock_guard adding(adding_);
    std::vector<uint64_t> finished;
    {
        const std::lock_guard lock(mutex_);
        if (const auto piece = board_->made(from)) finished.push_back(*piece);
    }
    tellFinished(finished);
}

void Ranks::handleResult(int from, BytesView message) {
    const std::lock_guard adding(adding_);
    {
        const std::lock_guard lock(mutex_);
        if (board_->isLost(from)) return;  // its pieces are others' now
    }
    if (!work_) return;  // the run ends by a fault of this process
    work_->add(Reader(message).rest());
    std::vector<uint64_t> pieces;
    {
        const std::lock_guard lock(mutex_);
        pieces = board_->collected(from, Clock::now());
    }
    tellFinished(pieces);
}

void Ranks::handle(int from, BytesView message) {
    Peer& peer = peers_[static_cast<size_t>(from)];
    const Kind kind = kindOf(message);
    Reader reader(message);
    if (kind == Kind::Message) {
        const auto level = static_cast<MessageLevel>(reader.number());
        return show(level, reader.text());
    }
    if (kind == Kind::Made) handleMade(from);
    if (kind == Kind::Result) handleResult(from, message);
    if (kind == Kind::Farewell) {
        const std::lock_guard adding(adding_);
        // One that was given up may come late.
        if (work_ && work_->addFarewell) work_->addFarewell(reader.rest());
    }
    const std::lock_guard lock(mutex_);
    peer.heard = Clock::now();
    if (kind == Kind::Hello) {
        peer.identity = reader.number();
        peer.machine = reader.text();
        peer.device = reader.text();
        peer.greeted = true;
        if (work_) greet(from);
    } else if (kind == Kind::Stopped) {
        board_->stop(from);
    } else if (kind == Kind::Farewell) {
        peer.gone = true;
    } else if (kind == Kind::Fault) {
        const auto code = static_cast<int>(reader.number());
        const std::string machine = reader.text();
        faults_.push_back(
            {code, fmt::format("{} (process {} on {})", reader.text(), from, machine), Clock::now()});
    }
    peer.asks = kind == Kind::Hello || kind == Kind::Made || kind == Kind::Result || kind == Kind::Stopped ||
                (kind == Kind::Beat && peer.asks);
    changed_.notify_all();
}

void Ranks::loseSilent() {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    for (int rank = 1; board_ && rank < place_.size; ++rank) {
        const Peer& peer = peers_[static_cast<size_t>(rank)];
        if (board_->isLost(rank) || peer.asks || peer.gone || now - peer.heard < patience_) continue;
        board_->lose(rank);
        transport_.forget(rank);
        show(MessageLevel::Warning,
             fmt::format("no message from process {} on {} for {:.0f} s; it is treated as lost and its work "
                         "is redistributed",
                         rank, peer.machine, std::chrono::duration<double>(now - peer.heard).count()));
        changed_.notify_all();
    }
}

void Ranks::failIfToldSo() {
    Fault fault;
    {
        const std::lock_guard lock(mutex_);
        if (faults_.empty() || Clock::now() - faults_.front().since < sameFault) return;
        fault = faults_.front();
    }
    fail(fault.code, fault.text);
}

void Ranks::serve() {
    try {
        Bytes message;
        int from = 0;
        Pause pause;
        Clock::time_point checked = Clock::now();
        while (!ending_) {
            while (!ending_ && transport_.poll(from, message)) {
                handle(from, message);
                answerAll();
                pause.reset();
            }
            if (Clock::now() - checked > milliseconds(50)) {
                checked = Clock::now();
                loseSilent();
                failIfToldSo();
                answerAll();
            }
            pause();
        }
    } catch (const Error& error) {
        fail(static_cast<int>(error.code()), error.what());
    } catch (const std::exception& error) {
        fail(static_cast<int>(ExitCode::Failed), error.what());
    }
}

// ---- The end.

bool Ranks::end() {
    const bool orderly = isFirst() ? endFirst() : endOther();
    if (orderly) transport_.end();
    return orderly;
}

bool Ranks::endOther() {
    while (bye_.empty() || kindOf(bye_) != Kind::Bye) bye_ = receive();
    send(0, Writer(Kind::Goodbye));
    return Reader(bye_).number() == 0;
}

bool Ranks::endFirst() {
    ending_ = true;
    if (server_.joinable()) server_.join();
    bool orderly = true;  // also where nothing was shared out: then all come to the end by themselves
    for (int rank = 1; rank < place_.size && board_; ++rank)
        orderly = orderly && peers_[static_cast<size_t>(rank)].gone;
    for (int rank = 1; rank < place_.size; ++rank) send(rank, Writer(Kind::Bye).number(orderly ? 0 : 1));
    // MPI's end waits for all without a limit of time.
    const Clock::time_point start = Clock::now();
    Bytes message;
    int from = 0, left = place_.size - 1;
    for (Pause pause; orderly && left > 0; pause()) {
        while (transport_.poll(from, message)) left -= kindOf(message) == Kind::Goodbye ? 1 : 0;
        orderly = Clock::now() - start < patience_;
    }
    return orderly;
}

void Ranks::fail(int code, const std::string& text) {
    if (!isFirst()) {
        send(0, Writer(Kind::Fault).number(static_cast<uint64_t>(code)).text(machine_).text(text));
        // Rank 0 ends this process.
        std::this_thread::sleep_for(std::chrono::seconds(30));
        transport_.abort(code);
    }
    if (failing_.exchange(true))
        std::this_thread::sleep_for(std::chrono::hours(1));  // the other thread ends all
    log::print(MessageLevel::Error, text);
    abort(code);
}

void Ranks::abort(int code) {
    std::fflush(nullptr);
    // What was written reaches the launcher before it ends the processes.
    std::this_thread::sleep_for(milliseconds(100));
    transport_.abort(code);
    std::_Exit(code);  // virtual functions are not believed
}

}  // namespace limpid::cluster
