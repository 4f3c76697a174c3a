#include "lab/quality/measure_together.h"

#include <optional>
#include <utility>

#include "base/hash.h"
#include "base/log.h"
#include "cli/cluster/cluster_progress.h"
#include "cli/cluster/session.h"
#include "lab/quality/quality_message.h"

namespace limpid::cli {
namespace {

uint64_t identityOf(const QualityRun& head) {
    Hash64 identity;
    identity.add(head.version + "\n" + head.command);
    return identity.value();
}

}  // namespace

void measureTogether(const QualityRun& head, const std::vector<QualitySequence>& sequences,
                     const QualityDestinations& destinations,
                     const std::function<QualityOutcome(size_t)>& measure) {
    std::optional<QualityOutput> output;
    if (isFirstProcess()) output.emplace(head, sequences.size(), destinations);
    QualityOutcomes made;  // by this process, and not shown or collected yet
    const auto show = [&](QualityOutcomes outcomes) {
        for (auto& [index, outcome] : outcomes) {
            if (auto* const measured = std::get_if<MeasuredSequence>(&outcome))
                measured->sequence = sequences.at(index);
            output->add(index, std::move(outcome));
        }
    };
    ClusterProgress progress("sequences", sequences.size());
    cluster::SharedWork work;
    work.identity = identityOf(head);
    work.device = head.device + ", " + head.driver + ", tracer " + head.tracer;
    for (uint64_t index = 0; index < sequences.size(); ++index) work.todo.push_back(index);
    work.collectsEarly = true;  // the page is updated with each sequence
    work.make = [&](uint64_t index) {
        made.emplace(index, measure(index));
        return true;
    };
    work.collect = [&] { return encodeOutcomes(std::exchange(made, {})); };
    work.add = [&](cluster::BytesView bytes) { show(decodeOutcomes(bytes)); };
    work.finished = [&](const std::vector<uint64_t>& pieces, uint64_t count) {
        for (const uint64_t piece : pieces) {
            if (auto own = made.extract(piece)) output->add(piece, std::move(own.mapped()));
        }
        progress.show(count);
    };
    const std::vector<uint64_t> madeByProcess = ranks()->share(work);
    if (!isFirstProcess()) return;
    output->finish();
    log::info("{}", describePieces(madeByProcess, "sequences"));
}

}  // namespace limpid::cli
