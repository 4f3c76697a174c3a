#include "studio/state/facts.h"

#include <fmt/format.h>

namespace limpid::studio {

std::string Facts::activityText() const {
    return activity.empty() || percent == 0 ? activity : fmt::format("{}, {} %", activity, percent);
}

}  // namespace limpid::studio
