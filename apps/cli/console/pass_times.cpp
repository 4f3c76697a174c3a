#include "cli/console/pass_times.h"

#include <algorithm>

namespace limpid::cli {

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

std::map<std::string, double> sumByName(const std::vector<gpu::PassTime>& passes) {
    std::map<std::string, double> sums;
    for (const gpu::PassTime& pass : passes) sums[pass.name] += pass.milliseconds;
    return sums;
}

void PassTimes::add(const std::map<std::string, double>& frame) {
    for (const auto& [name, milliseconds] : frame) times_[name].push_back(milliseconds);
}

std::map<std::string, double> PassTimes::medians() const {
    std::map<std::string, double> result;
    for (const auto& [name, values] : times_) result[name] = median(values);
    return result;
}

}  // namespace limpid::cli
