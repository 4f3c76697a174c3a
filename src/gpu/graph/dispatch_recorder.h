// Records one dispatch and checks it against the shader's reflection.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu/graph/frame_graph_impl.h"

namespace limpid::gpu {

class DispatchRecorder {
  public:
    DispatchRecorder(FrameGraph::Impl& graph, const Dispatch& dispatch);
    /// Adds the pass to the frame. If it throws, the frame is unchanged.
    void record();

  private:
    /// A binding that passed its checks.
    struct Bound {
        const ShaderBinding* variable = nullptr;
        BoundResource resource;
        std::string name;  ///< of the resource
    };

    [[noreturn]] void fail(const std::string& fault) const;
    [[noreturn]] void fail(std::string_view variable, const std::string& fault) const;
    Bound bind(const Binding& binding) const;
    void bindImage(Bound& bound, ImageHandle handle) const;
    void bindSampled(const Bound& bound, RecordedImage& image) const;
    void bindBuffer(Bound& bound, const Buffer* buffer) const;
    void bindStructures(Bound& bound, const AccelerationStructures* structures) const;
    void checkComplete() const;
    void checkAliases() const;
    void countImageBytes();
    void checkParams();
    void readConstants();
    void computeGroups();

    FrameGraph::Impl& graph_;
    const Dispatch& dispatch_;
    std::shared_ptr<const Shader> shader_;
    std::vector<Bound> bound_;
    RecordedDispatch result_;
    RecordedPass pass_;
};

}  // namespace limpid::gpu
