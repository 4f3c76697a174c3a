// Determines which passes must wait for which.
#include "gpu/graph/frame_graph_impl.h"

namespace limpid::gpu {
namespace {

/// The barrier before pass `lastBarrier` orders all passes before it, so only accesses since then matter.
void findHazards(const FrameGraph::Impl& graph, const Access& access, const ResourceUse& use,
                 std::vector<Hazard>& hazards) {
    const auto add = [&](Hazard::Kind kind, size_t earlier) {
        if (earlier == ResourceUse::none || earlier < graph.lastBarrier) return;
        hazards.push_back({kind, access.name, graph.frame.passes[earlier].name});
    };
    if (access.reads) add(Hazard::Kind::ReadAfterWrite, use.lastWriter);
    if (!access.writes) return;
    add(Hazard::Kind::WriteAfterWrite, use.lastWriter);
    for (const size_t reader : use.readers) add(Hazard::Kind::WriteAfterRead, reader);
}

}  // namespace

ResourceUse& FrameGraph::Impl::useOf(const Access& access) {
    return access.buffer ? bufferUses[access.buffer] : imageUses[access.image];
}

void FrameGraph::Impl::noteAccesses(RecordedPass& pass, std::span<const Access> accesses) {
    const size_t number = frame.passes.size();
    for (const Access& access : accesses) findHazards(*this, access, useOf(access), pass.hazards);
    if (!pass.hazards.empty()) lastBarrier = number;
    for (const Access& access : accesses) {
        ResourceUse& use = useOf(access);
        if (access.writes) {
            use.lastWriter = number;
            use.readers.clear();
            if (!access.buffer) frame.images[access.image].written = true;
            pass.writes.push_back(access.name);
        } else if (use.readers.empty() || use.readers.back() != number) {
            use.readers.push_back(number);
        }
        if (access.reads) pass.reads.push_back(access.name);
    }
}

}  // namespace limpid::gpu
