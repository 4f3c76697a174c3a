#include <optional>
#include <utility>

#include "base/error.h"
#include "renderer/layers/layers.h"
#include "renderer/long/sums/accumulation_file.h"
#include "scratch.h"

namespace limpid::fuzz {
namespace {

/// Makes the picture of the sums, like `limpid merge` and a resumed render.
void makePicture(const Accumulation& read) {
    const RenderedLayers means = read.sums.means();
    toLayeredImage(means, read.header.layers, image::Storage::Half);
}

/// Checks that a header that was read is written unchanged.
void writeHeader(const AccumulationHeader& header) {
    const std::string text = toJson(header);
    if (toJson(headerFromJson(text, "again.sums")) != text) throw Error("the header does not come back");
    if (firstDifference(header, header)) throw Error("the header differs from itself");
    renderHash(header);
}

}  // namespace

bool checkpoint(Bytes input) {
    std::optional<Accumulation> read;
    if (!accepts([&] { read = decodeAccumulation(input, "a.sums"); })) return false;
    try {
        writeHeader(read->header);
        FrameSums sum(read->header.extent, read->header.plan, read->header.layers);
        sum.merge(read->sums);
        if (read->sums.samples() > 0) makePicture({read->header, std::move(sum)});
    } catch (const InputError& error) {
        throw Error(std::string("refused after it was read: ") + error.what());
    }
    return true;
}

}  // namespace limpid::fuzz
