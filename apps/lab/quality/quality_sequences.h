// Which sequences `limpid bench quality` looks at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lab/quality/quality_reference.h"

namespace limpid::cli {

/// A scene, how the camera moves through it, and which frames are compared.
struct QualitySequence {
    std::string name;
    std::string scene;                 ///< as on the command line: builtin:..., or a file
    std::string cameraPath = "orbit";  ///< built in, a file, or "none"
    QualityFrames frames;
    uint64_t referenceSamples = 4096;  ///< per pixel
    std::string environment;           ///< a file, or empty
    bool optional = false;             ///< a scene that cannot be loaded is skipped with a warning
};

/// The fixed set of --lab. A new sequence is a line of this table. A reference's noise should stay well below
/// the changes that are measured with it: where 4,096 samples do not do, a sequence has more.
const std::vector<QualitySequence>& labSequences();

/// One for each .gltf and .glb file in the folders in `folder`, by name; like `common` but for name and
/// scene, and optional. Named after the folder, and after the file, too, where a folder has several. Where
/// `paths` has a file NAME.json, that is the camera path. Throws InputError if `folder` cannot be read.
std::vector<QualitySequence> sequencesInFolder(const std::filesystem::path& folder,
                                               const std::filesystem::path& paths,
                                               const QualitySequence& common);

/// --quick: small enough for a CPU.
namespace quick {
inline constexpr uint32_t width = 160, height = 90;
inline constexpr QualityFrames frames{6, 9};
inline constexpr uint64_t referenceSamples = 256;
inline constexpr uint64_t maxTriangles = 1000;
}  // namespace quick

}  // namespace limpid::cli
