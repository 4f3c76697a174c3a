// Determines which passes must wait for which.
#include <span>
#include <vector>

#include "gpu/graph/frame_graph_impl.h"

namespace limpid::gpu {
namespace {

/// The barrier before pass `lastBarrier` orders all passes before it, so only accesses since then matter.
void addHazards(const FrameGraph::Impl& graph, const Access& access, const ResourceUse& use,
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
    if (access.buffer) return bufferUses[access.buffer];
    return imageUses[frame.images[access.image].sharesWith.value_or(access.image)];
}

void FrameGraph::Impl::findHazards(RecordedPass& pass, size_t number, std::span<const Access> accesses) {
    for (const Access& access : accesses) addHazards(*this, access, useOf(access), pass.hazards);
    if (!pass.hazards.empty()) lastBarrier = number;
    for (const Access& access : accesses) {
        ResourceUse& use = useOf(access);
        if (access.writes) {
            use.lastWriter = number;
            use.readers.clear();
        } else if (use.readers.empty() || use.readers.back() != number) {
            use.readers.push_back(number);
        }
    }
}

void FrameGraph::Impl::noteAccesses(RecordedPass& pass, std::span<const Access> accesses) {
    findHazards(pass, frame.passes.size(), accesses);
    for (const Access& access : accesses) {
        if (access.writes && !access.buffer) frame.images[access.image].written = true;
        if (access.writes) pass.writes.push_back(access.name);
        if (access.reads) pass.reads.push_back(access.name);
    }
    if (options.shareMemory) frame.accesses.emplace_back(accesses.begin(), accesses.end());
}

}  // namespace limpid::gpu
