// The file that a killed render goes on from.
#pragma once

#include <chrono>
#include <filesystem>

#include "renderer/long/accumulation_file.h"

namespace limpid {

class Checkpoint {
  public:
    /// Throws OutputError if no such file can be written.
    explicit Checkpoint(std::filesystem::path path);

    const std::filesystem::path& path() const { return path_; }
    bool exists() const;

    /// What the file holds, checked against `ours`. Throws InputError if it cannot be read, is of another
    /// render (naming what differs) or of another shard; warns if it comes from another device.
    Accumulation load(const AccumulationHeader& ours) const;

    /// Writes the file, whole or not at all.
    void save(const AccumulationHeader& header, const FrameSums& sums);
    /// Writes it unless that would take more than a twentieth of the time.
    void saveIfDue(const AccumulationHeader& header, const FrameSums& sums);

  private:
    using Clock = std::chrono::steady_clock;
    std::filesystem::path path_;
    Clock::time_point saved_ = Clock::now();
    Clock::duration cost_{};  ///< of the last time
};

}  // namespace limpid
