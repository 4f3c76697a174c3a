// What `limpid bench quality` prints and writes, while it runs and at its end.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/quality/quality_run.h"

namespace limpid::cli {

struct QualityDestinations {
    std::string folder;  ///< of side-by-side pictures; empty: none
    std::string report;  ///< the HTML page; empty: none
    bool json = false;   ///< one JSON object at the end instead of tables
};

/// Takes sequences in any order and shows them in that of the command line, each as soon as all before it are
/// there. The page is updated then, so an interrupted run leaves what was shown.
class QualityOutput {
  public:
    /// `head`: a run without sequences. `count`: of those that will be added.
    QualityOutput(QualityRun head, size_t count, QualityDestinations destinations);

    /// Throws OutputError if a file cannot be written.
    void add(size_t index, QualityOutcome outcome);
    /// Once all are added: the ranking, or the JSON. Throws Error if no sequence was measured.
    void finish();

  private:
    void show(QualityOutcome outcome);

    QualityRun run_;
    QualityDestinations to_;
    std::vector<std::optional<QualityOutcome>> waiting_;
    size_t shown_ = 0;
};

}  // namespace limpid::cli
