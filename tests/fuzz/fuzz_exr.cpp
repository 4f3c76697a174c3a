#include <string>
#include <vector>

#include "image/io/exr/exr_document.h"
#include "picture_target.h"
#include "scratch.h"

namespace limpid::fuzz {
namespace {

/// Replaces the first channel of each part that can be read by itself, and writes the file, like
/// `limpid denoise`.
void copyDocument(Bytes input) {
    image::ExrDocument document;
    const std::vector<std::byte> bytes(input.begin(), input.end());
    if (!accepts([&] { document = image::ExrDocument::decode(bytes, "a.exr"); })) return;
    for (size_t i = 0; i < document.parts().size(); ++i) {
        const auto& channels = document.parts()[i].channels;
        if (channels.empty()) continue;
        const std::string channel = channels.front().name;
        accepts([&] { document.replace(i, channel, document.values(i, channel)); });
    }
    // Compressing what a few bytes claim takes long.
    if (uint64_t{document.width()} * document.height() > uint64_t{1} << 20) return;
    const std::filesystem::path output = scratch().write("copy.exr", {});
    const bool written = accepts([&] { document.write(output); });
    if (written && !accepts([&] { image::ExrDocument::read(output); }))
        throw Error("the copy of the document cannot be read");
    scratch().remove("copy.exr");
}

}  // namespace

bool exr(Bytes input) {
    copyDocument(input);
    return readsAsRadiance(scratch().write("a.exr", input));
}

}  // namespace limpid::fuzz
