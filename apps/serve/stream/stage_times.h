// How long a picture takes from the renderer to the network, for measurements.
#pragma once

#include <functional>

namespace limpid::serve {

enum class Stage {
    Convert,  ///< to the colours of the video
    Encode,
    Send,  ///< from the end of encoding until the system has the bytes, for each client
};

/// Called with milliseconds, on any thread.
using StageTimed = std::function<void(Stage stage, double milliseconds)>;

}  // namespace limpid::serve
