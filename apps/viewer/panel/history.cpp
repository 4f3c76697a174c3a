#include "viewer/panel/history.h"

#include <utility>

namespace limpid::viewer {

void History::note(const nlohmann::json& changes, const nlohmann::json& before) {
    if (changes.empty()) return;
    toRedo_.clear();
    if (!open_ || toUndo_.empty()) toUndo_.push_back({nlohmann::json::object(), nlohmann::json::object()});
    open_ = true;
    Step& step = toUndo_.back();
    for (const auto& [key, value] : changes.items()) {
        if (!step.before.contains(key)) step.before[key] = before.at(key);
        step.after[key] = value;
    }
    if (toUndo_.size() > mostSteps) toUndo_.erase(toUndo_.begin());
}

void History::clear() {
    toUndo_.clear();
    toRedo_.clear();
    open_ = false;
}

std::optional<nlohmann::json> History::undo() {
    if (toUndo_.empty()) return std::nullopt;
    open_ = false;
    toRedo_.push_back(std::move(toUndo_.back()));
    toUndo_.pop_back();
    return toRedo_.back().before;
}

std::optional<nlohmann::json> History::redo() {
    if (toRedo_.empty()) return std::nullopt;
    open_ = false;
    toUndo_.push_back(std::move(toRedo_.back()));
    toRedo_.pop_back();
    return toUndo_.back().after;
}

}  // namespace limpid::viewer
