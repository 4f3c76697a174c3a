#include "passes/deform/deform.h"

#include <algorithm>

#include "expand.comp.h"
#include "passes/deform/deform_params.h"
#include "pose.comp.h"
#include "refit.comp.h"

namespace limpid {
namespace {

std::vector<gpu::Binding> bind(const scene::GpuScene& scene, std::initializer_list<std::string_view> names) {
    std::vector<gpu::Binding> bindings;
    for (const std::string_view name : names) bindings.push_back({name, &scene.buffer(name)});
    return bindings;
}

void upload(gpu::FrameGraph& graph, const scene::GpuScene& scene, const scene::SceneFrame& frame) {
    for (const scene::SceneFrame::Upload& upload : frame.uploads)
        graph.upload(scene.buffer(upload.buffer), upload.offset, upload.bytes);
    if (!scene.structures()) return;
    for (const auto& [number, placement] : frame.placements)
        graph.place(*scene.structures(), number, placement);
}

void pose(gpu::FrameGraph& graph, const scene::GpuScene& scene, const scene::SceneFrame& frame) {
    for (const layout::PoseParams& pose : frame.poses) {
        graph.dispatch({.pass = "deform/pose",
                        .shader = shaders::pose_comp,
                        .bindings = bind(scene, {"restVertices", "morphDeltas", "poseMatrices",
                                                 "posedVertices", "vertices", "previousGeometry"}),
                        .params = gpu::paramsOf(pose),
                        .constants = {},
                        .extent = {pose.vertexCount, 1}});
    }
}

/// Moves the triangles, which both tracers read, and refits our own trees.
void refit(gpu::FrameGraph& graph, const scene::GpuScene& scene, const scene::SceneFrame& frame) {
    for (const scene::RefitLevel& level : frame.refitLevels) {
        const RefitParams params{level.first, level.count, frame.firstRefitNode};
        graph.dispatch({.pass = "deform/refit",
                        .shader = shaders::refit_comp,
                        .bindings = bind(scene, {"refitNodes", "nodeBounds", "quantisedNodes", "bvhTriangles",
                                                 "triangles", "posedVertices"}),
                        .params = gpu::paramsOf(params),
                        .constants = {},
                        .extent = {level.count, 1}});
    }
}

void expand(gpu::FrameGraph& graph, const scene::GpuScene& scene, const scene::SceneFrame& frame) {
    for (const scene::NodeRange& range : frame.changedNodes) {
        const ExpandParams params{range.first, range.count};
        graph.dispatch({.pass = "deform/expand",
                        .shader = shaders::expand_comp,
                        .bindings = bind(scene, {"quantisedNodes", "bvhNodes"}),
                        .params = gpu::paramsOf(params),
                        .constants = {},
                        .extent = {range.count, 1}});
    }
}

/// True if anything is new that shadow rays meet, or a light.
bool changesLight(const scene::SceneFrame& frame) {
    if (!frame.placements.empty() || !frame.poses.empty()) return true;
    return std::ranges::any_of(frame.uploads, [](const scene::SceneFrame::Upload& upload) {
        return upload.buffer == "lights" || upload.buffer.starts_with("bvh") ||
               upload.buffer == "quantisedNodes";
    });
}

}  // namespace

void deform(gpu::FrameGraph& graph, scene::GpuScene& scene, const scene::SceneFrame& frame) {
    upload(graph, scene, frame);
    scene.setParams(frame.params);
    if (changesLight(frame)) scene.setLightDistancesStale(true);
    pose(graph, scene, frame);
    if (!frame.poses.empty()) refit(graph, scene, frame);
    if (scene.expandsNodes()) expand(graph, scene, frame);
    const bool moved = !frame.placements.empty() || !frame.poses.empty();
    if (scene.structures() && moved) graph.rebuild("deform/structures", *scene.structures());
}

}  // namespace limpid
