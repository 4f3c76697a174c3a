// How pictures are encoded, and how long that takes.
#pragma once

#include <cstdint>
#include <functional>

namespace limpid::serve {

/// What a picture passes on its way from the renderer to the network.
enum class Stage {
    Convert,  ///< to the colours of the video
    Encode,
    Send,  ///< from the end of encoding until the system has the bytes, for each client
};

struct StreamSettings {
    uint32_t encoderThreads = 0;  ///< for video; 0: three quarters of the cores, at most 16
    /// Called with the milliseconds of each picture's stages, on any thread; may be empty.
    std::function<void(Stage stage, double milliseconds)> timed;
};

}  // namespace limpid::serve
