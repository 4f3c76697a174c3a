#include "renderer/long/render_identity.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/hash.h"

namespace limpid {
namespace {

void addRig(Hash64& hash, const scene::Rig& rig) {
    for (const scene::Node& node : rig.nodes) {
        hash.addValue(node.parent);
        hash.addValue(node.local());
        hash.addValues(node.weights);
    }
    for (const scene::Skin& skin : rig.skins) {
        hash.addValues(skin.joints);
        hash.addValues(skin.inverseBind);
    }
}

void addClip(Hash64& hash, const scene::Clip& clip) {
    for (const scene::Channel& channel : clip.channels) {
        hash.addValue(channel.node);
        hash.addValue(channel.value);
        hash.addValue(channel.interpolation);
        hash.addValues(channel.times);
        hash.addValues(channel.values);
    }
}

/// Member by member, because there is padding between them.
void addKey(Hash64& hash, const scene::CameraKey& key) {
    hash.addValue(key.time);
    for (const vec3& v : {key.eye, key.target, key.up}) hash.addValue(v);
    for (const float v : {key.verticalFov, key.lensDiameter, key.focusDistance}) hash.addValue(v);
    hash.addValue(uint32_t{key.cut});
}

}  // namespace

std::string validUtf8(const std::string& text) {
    using nlohmann::json;
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

uint64_t sceneHash(const scene::Scene& scene, const scene::SceneData& data) {
    Hash64 hash;
    const auto add = [&](const auto&... records) { (hash.addValues(records), ...); };
    add(data.bvhNodes, data.bvhInstances, data.triangles, data.vertices, data.instances,
        data.previousGeometry, data.materials, data.textureRefs, data.lights, data.lightTree,
        data.motion.restVertices);
    add(data.bvhTriangles, data.environment, data.environmentPyramid, data.lightPyramid, data.ggxTable,
        data.dielectricTable, data.motion.morphDeltas);
    hash.addValues(data.lightDensity);
    for (const auto& texels : data.texels) hash.addValues(texels);
    static_assert(std::has_unique_object_representations_v<scene::SceneFeatures>, "no padding");
    hash.addValue(data.features);
    hash.addValue(data.params);
    hash.addValue(data.stackSize);
    hash.addValue(data.byteCount());  // detects a change of buffers that are not hashed above, at least by
                                      // size
    if (scene.clip != scene::none) {
        addRig(hash, scene.rig);
        addClip(hash, scene.rig.clips[static_cast<size_t>(scene.clip)]);
    }
    return hash.value();
}

uint64_t cameraHash(const Sequence& sequence, uint64_t frames, gpu::Extent extent) {
    constexpr uint64_t maxFrames = 1000;
    Hash64 hash;
    const uint64_t count = std::min(frames, maxFrames);
    for (uint64_t i = 0; i < count; ++i) {
        const uint64_t frame = frames <= maxFrames ? i : i * (frames - 1) / (maxFrames - 1);
        hash.addValue(sequence.camera(frame, extent));
    }
    if (sequence.path() && (sequence.isBlurred() || frames > maxFrames))
        for (const scene::CameraKey& key : sequence.path()->keys()) addKey(hash, key);
    return hash.value();
}

std::vector<std::pair<std::string, std::string>> identityOf(const RenderIdentity& identity,
                                                            const RenderSettings& settings,
                                                            const SequenceTiming& timing) {
    std::vector<std::pair<std::string, std::string>> entries{
        {sceneEntry, validUtf8(identity.sceneName)},
        {"the scene's content", hashText(identity.scene)},
        {"the camera", hashText(identity.cameras)},
        {cameraEntry, identity.camera},
        {"frames per second", fmt::format("{}", timing.framesPerSecond)},
        {"the first frame's time", fmt::format("{}", timing.start)},
        {"the shutter", toString(timing.shutter)},
        {seedEntry, fmt::format("{}", settings.seed)},
        {jitterEntry, toString(settings.jitter)},
    };
    const PathtraceSettings traced = settings.pathsTraced();
    const ParamTable<PathtraceSettings>& table = pathtraceParams();
    for (size_t i = 0; i < table.infos().size(); ++i)
        entries.emplace_back(table.group() + "." + table.infos()[i].name, toString(table.get(traced, i)));
    entries.emplace_back(versionEntry, validUtf8(identity.version));
    return entries;
}

}  // namespace limpid
