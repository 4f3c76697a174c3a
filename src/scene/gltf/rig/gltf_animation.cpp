#include "scene/gltf/rig/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/gltf/document/gltf_access.h"

namespace limpid::scene::gltf {
namespace {

/// The numbers (times and values) that the clips of a document may have: at least as many as its buffer views
/// could hold at their highest compression, with one byte for each number, up to a bound on the memory.
uint64_t maxNumbers(const Document& document) {
    constexpr uint64_t floor = uint64_t{1} << 24, most = uint64_t{1} << 28;
    return std::min(floor + Document::decodedPerByte * document.byteCount(), most);
}

/// Returns the accessor of a sampler's input or output.
int accessorOf(const Document& document, const Object& sampler, const char* key) {
    const int accessor = sampler.index(key, document.lists().accessors.size());
    if (accessor == none) sampler.fail(fmt::format("has no {}", key));
    return accessor;
}

std::vector<float> readTimes(const Document& document, const Object& sampler) {
    std::vector<float> times = readScalars(document, accessorOf(document, sampler, "input"));
    if (times.empty()) sampler.fail("input", "has no times");
    for (size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(times[i]) || times[i] < 0.0f)
            sampler.fail("input", fmt::format("its time {} is negative or not finite", i));
        if (i > 0 && times[i] <= times[i - 1])
            sampler.fail("input", fmt::format("its time {} is not later than the one before", i));
    }
    return times;
}

Interpolation readInterpolation(const Object& sampler) {
    const std::string text = sampler.text("interpolation", "LINEAR");
    if (text == "LINEAR") return Interpolation::Linear;
    if (text == "STEP") return Interpolation::Step;
    if (text == "CUBICSPLINE") return Interpolation::CubicSpline;
    sampler.fail("interpolation", "is '" + text.substr(0, 20) + "', not STEP, LINEAR or CUBICSPLINE");
}

/// Returns the number of morph targets of the node's mesh.
size_t targetCount(const Document& document, const Object& node) {
    const int mesh = node.index("mesh", document.lists().meshes.size());
    if (mesh == none) return 0;
    const Object& source = document.lists().meshes[static_cast<size_t>(mesh)];
    return source.listSize("primitives") == 0 ? 0 : source.objectAt("primitives", 0).listSize("targets");
}

void readValues(const Document& document, const Object& sampler, Channel& channel) {
    const int accessor = accessorOf(document, sampler, "output");
    const size_t width = channel.value == AnimatedValue::Weights ? 1 : channel.components;
    channel.values = readNumbers(document, accessor, width);
    const size_t keys = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
    const size_t needed = channel.times.size() * keys * channel.components;
    if (channel.values.size() != needed) {
        sampler.fail("output", fmt::format("has {} numbers, but {} times need {}", channel.values.size(),
                                           channel.times.size(), needed));
    }
    // Larger values would overflow in matrices.
    if (!std::all_of(channel.values.begin(), channel.values.end(),
                     [](float v) { return std::abs(v) < 1e18f; }))
        sampler.fail("output", "has a value that is too large or not finite");
}

/// Returns false if the channel is ignored.
bool readTarget(Document& document, const Object& source, const std::vector<Node>& nodes, Channel& channel) {
    const auto target = source.object("target");
    if (!target) source.fail("has no target");
    channel.node = target->index("node", nodes.size());
    const std::string path = target->text("path");
    if (channel.node == none) {
        document.warn(source.place() + " has no target node and is ignored");
        return false;
    }
    if (path == "translation" || path == "scale") {
        channel.value = path == "scale" ? AnimatedValue::Scale : AnimatedValue::Translation;
        channel.components = 3;
    } else if (path == "rotation") {
        channel.value = AnimatedValue::Rotation;
        channel.components = 4;
    } else if (path == "weights") {
        channel.value = AnimatedValue::Weights;
        channel.components = static_cast<uint32_t>(
            targetCount(document, document.lists().nodes[static_cast<size_t>(channel.node)]));
        if (channel.components == 0) source.fail("animates the weights of a node without morph targets");
    } else {
        document.warn(source.place() + " animates '" + path.substr(0, 20) + "', which is ignored");
        return false;
    }
    if (channel.value != AnimatedValue::Weights && nodes[static_cast<size_t>(channel.node)].matrix) {
        document.warn(source.place() + " animates a node that a matrix places and is ignored");
        return false;
    }
    return true;
}

/// Takes the numbers of a channel from `left`, before they are read.
void spend(const Document& document, const Object& sampler, uint64_t& left) {
    const int input = accessorOf(document, sampler, "input");
    const int output = accessorOf(document, sampler, "output");
    const uint64_t numbers = accessorCount(document, input) +
                             accessorCount(document, output) * accessorComponents(document, output);
    if (numbers > left) sampler.fail("with it the animations have too many times and values");
    left -= numbers;
}

/// `numbersLeft`: that this clip and those after it may have.
Clip readClip(Document& document, const Object& source, const std::vector<Node>& nodes,
              uint64_t& numbersLeft) {
    Clip clip;
    clip.name = source.text("name", source.place());
    const std::vector<Object> samplers = source.objects("samplers");
    for (const Object& entry : source.objects("channels")) {
        Channel channel;
        const int sampler = entry.index("sampler", samplers.size());
        if (sampler == none) entry.fail("has no sampler");
        if (!readTarget(document, entry, nodes, channel)) continue;
        const Object& keys = samplers[static_cast<size_t>(sampler)];
        spend(document, keys, numbersLeft);
        channel.interpolation = readInterpolation(keys);
        channel.times = readTimes(document, keys);
        readValues(document, keys, channel);
        clip.channels.push_back(std::move(channel));
    }
    return clip;
}

}  // namespace

std::vector<Clip> readAnimations(Document& document, const std::vector<Node>& nodes) {
    std::vector<Clip> clips;
    uint64_t numbersLeft = maxNumbers(document);
    for (const Object& source : document.lists().animations)
        clips.push_back(readClip(document, source, nodes, numbersLeft));
    return clips;
}

}  // namespace limpid::scene::gltf
