// The fuzz targets: one function per reader. Each calls the reader through the program's own entry point, and
// continues with the steps up to the device. Called by libFuzzer (fuzz_main.cpp) and, with the corpus, by
// corpus_test.cpp.
#pragma once

#include <cstddef>
#include <span>

namespace limpid::fuzz {

using Bytes = std::span<const std::byte>;

/// Each returns true if the input was read and false if it was refused with InputError. Anything else is a
/// finding: another exception, a sanitizer's report, too much memory or time.
///
/// The input is a GLB, or JSON text. What follows the first zero byte of a text, if any, becomes both the
/// GLB's binary chunk and the file "scene.bin". "a.png" exists for images.
bool gltf(Bytes input);
/// The input is OBJ text. What follows the first zero byte, if any, becomes "scene.mtl". "a.png" exists for
/// maps.
bool obj(Bytes input);
/// Environment maps and pictures.
bool hdr(Bytes input);
bool exr(Bytes input);
/// PNG, JPEG, TGA and BMP.
bool png(Bytes input);
/// Files of sums: checkpoints and shards of stills.
bool checkpoint(Bytes input);
/// A text that a browser sends to `limpid serve`, here refused with UsageError; edits are made to a state.
bool serve(Bytes input);

}  // namespace limpid::fuzz
