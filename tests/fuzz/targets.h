// What is fuzzed: a reader per function, through the entry that the program uses, and the work that follows
// the reader up to the device. Called by libFuzzer (fuzz_main.cpp) and, with the corpus, by corpus_test.cpp.
#pragma once

#include <cstddef>
#include <span>

namespace limpid::fuzz {

using Bytes = std::span<const std::byte>;

/// Each returns whether the input was read (true) or refused with InputError (false). Whatever else happens
/// is a finding: another exception, a sanitizer's report, too much memory or time.
///
/// A GLB as it is; else the JSON text, and after the first zero byte, if there is one, what becomes both the
/// GLB's binary chunk and the file "scene.bin" beside it. "a.png" is there for images.
bool gltf(Bytes input);
/// The OBJ text, and after the first zero byte, if there is one, the text of "scene.mtl". "a.png" is there
/// for maps.
bool obj(Bytes input);
/// Environment maps and pictures.
bool hdr(Bytes input);
bool exr(Bytes input);
/// PNG, JPEG, TGA and BMP.
bool png(Bytes input);
/// Files of sums: checkpoints and shards of stills.
bool checkpoint(Bytes input);

}  // namespace limpid::fuzz
