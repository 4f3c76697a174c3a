#include "lab/quality/measure_together.h"

#include <mutex>
#include <optional>
#include <utility>

#include "base/hash.h"
#include "base/log.h"
#include "cli/cluster/cluster_progress.h"
#include "cli/cluster/session.h"
#include "lab/quality/quality_message.h"

namespace limpid::cli {
namespace {

/// Not of the files' contents: a process would have to load all scenes for that.
uint64_t identityOf(const QualityRun& head, const std::vector<QualitySequence>& sequences) {
    Hash64 identity;
    identity.add(head.version + "\n" + head.command);
    for (const QualitySequence& sequence : sequences) {
        for (const std::string& text :
             {sequence.name, sequence.scene, sequence.cameraPath, sequence.environment})
            identity.add("\n" + text);
        identity.addValue(sequence.frames);
        identity.addValue(sequence.referenceSamples);
    }
    return identity.value();
}

}  // namespace

void measureTogether(const QualityRun& head, const std::vector<QualitySequence>& sequences,
                     const QualityDestinations& destinations,
                     const std::function<QualityOutcome(size_t)>& measure) {
    std::optional<QualityOutput> output;
    if (isFirstProcess()) output.emplace(head, sequences.size(), destinations);
    std::mutex mutex;      // of `made`: process 0 also answers the others while it measures
    QualityOutcomes made;  // by this process, and not shown or collected yet
    const auto takeOwn = [&](size_t index) {
        const std::lock_guard lock(mutex);
        return made.extract(index);
    };
    const auto show = [&](QualityOutcomes outcomes) {
        for (auto& [index, outcome] : outcomes) {
            if (auto* const measured = std::get_if<MeasuredSequence>(&outcome))
                measured->sequence = sequences.at(index);
            output->add(index, std::move(outcome));
        }
    };
    ClusterProgress progress("sequences", sequences.size());
    cluster::SharedWork work;
    work.identity = identityOf(head, sequences);
    work.device = head.device + ", " + head.driver + ", tracer " + head.tracer;
    for (uint64_t index = 0; index < sequences.size(); ++index) work.todo.push_back(index);
    work.collectsEarly = true;  // results are shown while the run goes on
    work.make = [&](uint64_t index) {
        QualityOutcome outcome = measure(index);
        const std::lock_guard lock(mutex);
        made.emplace(index, std::move(outcome));
        return true;
    };
    work.collect = [&] { return encodeOutcomes(std::exchange(made, {})); };
    work.add = [&](cluster::BytesView bytes) { show(decodeOutcomes(bytes)); };
    work.finished = [&](const std::vector<uint64_t>& pieces, uint64_t count) {
        for (const uint64_t piece : pieces) {
            auto own = takeOwn(piece);
            if (own) output->add(piece, std::move(own.mapped()));
        }
        progress.show(count);
    };
    const std::vector<uint64_t> madeByProcess = ranks()->share(work);
    if (!isFirstProcess()) return;
    output->finish();
    log::info("{}", describePieces(madeByProcess, "sequences"));
}

}  // namespace limpid::cli
