// How far long work has come, and the wish to give it up: shared by the thread that works and those that
// watch it.
#pragma once

#include <atomic>
#include <memory>

#include "base/error.h"

namespace limpid {

/// Thrown by Progress::at() once the work was given up.
class Cancelled : public Error {
  public:
    Cancelled() : Error("was given up") {}
};

/// A part of some work. Copies refer to the same work. Any thread may call any member.
class Progress {
  public:
    /// Work that nobody watches: at() does nothing.
    Progress() = default;
    static Progress watched() {
        Progress progress;
        progress.work_ = std::make_shared<Work>();
        return progress;
    }

    /// The piece of this part from one share of it to another, both 0 to 1.
    Progress part(double from, double to) const {
        Progress piece = *this;
        piece.from_ = from_ + from * (to_ - from_);
        piece.to_ = from_ + to * (to_ - from_);
        return piece;
    }

    /// Reports that this share of the part, 0 to 1, is done. Throws Cancelled if the work was given up.
    void at(double share) const {
        if (!work_) return;
        if (work_->cancelled) throw Cancelled();
        const double reached = from_ + share * (to_ - from_);
        double before = work_->done;
        while (before < reached && !work_->done.compare_exchange_weak(before, reached)) {
        }
    }
    /// The same after `count` of `all` equal steps; `all` may be 0.
    void at(size_t count, size_t all) const {
        at(all == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(all));
    }

    /// The largest share of the whole work that was reported; 0 if nobody watches.
    double done() const { return work_ ? work_->done.load() : 0.0; }
    void cancel() const {
        if (work_) work_->cancelled = true;
    }

  private:
    struct Work {
        std::atomic<double> done = 0.0;
        std::atomic<bool> cancelled = false;
    };
    std::shared_ptr<Work> work_;
    double from_ = 0.0, to_ = 1.0;
};

}  // namespace limpid
