#include "passes/deform/deform.h"

#include "passes/deform/deform_params.h"
#include "pose.comp.h"
#include "refit.comp.h"

namespace limpid {

void deform(gpu::FrameGraph& graph, scene::GpuScene& scene, const scene::SceneFrame& frame) {
    for (const scene::SceneFrame::Upload& upload : frame.uploads)
        graph.upload(scene.buffer(upload.buffer), upload.offset, upload.bytes);
    scene.setParams(frame.params);
    const auto bind = [&](std::initializer_list<std::string_view> names) {
        std::vector<gpu::Binding> bindings;
        for (const std::string_view name : names) bindings.push_back({name, &scene.buffer(name)});
        return bindings;
    };
    for (const layout::PoseParams& pose : frame.poses) {
        graph.dispatch({.pass = "deform/pose",
                        .shader = shaders::pose_comp,
                        .bindings = bind({"restVertices", "morphDeltas", "poseMatrices", "posedVertices",
                                          "vertices", "previousGeometry"}),
                        .params = gpu::paramsOf(pose),
                        .constants = {},
                        .extent = {pose.vertexCount, 1}});
    }
    if (frame.poses.empty()) return;
    for (const scene::RefitLevel& level : frame.refitLevels) {
        const RefitParams params{level.first, level.count, frame.firstRefitNode};
        graph.dispatch({.pass = "deform/refit",
                        .shader = shaders::refit_comp,
                        .bindings = bind({"refitNodes", "nodeBounds", "bvhNodes", "bvhTriangles", "triangles",
                                          "posedVertices"}),
                        .params = gpu::paramsOf(params),
                        .constants = {},
                        .extent = {level.count, 1}});
    }
}

}  // namespace limpid
