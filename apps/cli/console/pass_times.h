// Milliseconds of passes, over frames.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu/graph/frame_graph.h"

namespace limpid::cli {

/// The upper one of two in the middle. `values` must not be empty.
double median(std::vector<double> values);

/// Milliseconds by pass; a pass may be dispatched several times.
std::map<std::string, double> sumByName(const std::vector<gpu::PassTime>& passes);

/// The times of every pass, frame after frame.
class PassTimes {
  public:
    void add(const std::map<std::string, double>& frame);
    std::map<std::string, double> medians() const;

  private:
    std::map<std::string, std::vector<double>> times_;
};

}  // namespace limpid::cli
