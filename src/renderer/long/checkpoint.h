// The file from which a killed render continues.
#pragma once

#include <chrono>
#include <filesystem>

#include "renderer/long/sums/accumulation_file.h"

namespace limpid {

class Checkpoint {
  public:
    /// Throws OutputError if no such file can be written.
    explicit Checkpoint(std::filesystem::path path);

    const std::filesystem::path& path() const { return path_; }
    bool exists() const;

    /// Reads the file and checks it against `ours`. Throws InputError if it cannot be read, or belongs to
    /// another render (naming the difference) or another shard. Warns if it comes from another device.
    Accumulation load(const AccumulationHeader& ours) const;

    /// Writes the file at the end of a run. If it cannot be written, warns, keeps the file as it was, and
    /// returns false.
    bool saveLast(const AccumulationHeader& header, const FrameSums& sums);
    /// Whether writing now takes at most a twentieth of the time.
    bool isDue() const;
    /// Writes the file if that is due. If it cannot be written, warns, and keeps the file as it was.
    void saveIfDue(const AccumulationHeader& header, const FrameSums& sums);

  private:
    using Clock = std::chrono::steady_clock;

    /// Writes the file completely or not at all. Throws OutputError.
    void save(const AccumulationHeader& header, const FrameSums& sums);

    std::filesystem::path path_;
    Clock::time_point saved_ = Clock::now();
    Clock::duration cost_{};  ///< duration of the last save
};

}  // namespace limpid
