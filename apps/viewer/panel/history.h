// Undo and redo of edits of the state.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace limpid::viewer {

/// Steps of changed fields (studio/state/state_json.h). All edits while a mouse button is held, or while a
/// text is typed, are one step.
class History {
  public:
    static constexpr size_t mostSteps = 200;

    /// The user has changed fields: `changes` has their new values, `before` all fields' old ones.
    void note(const nlohmann::json& changes, const nlohmann::json& before);
    /// The gesture is over: the next edit is another step.
    void endStep() { open_ = false; }
    void clear();

    bool canUndo() const { return !toUndo_.empty(); }
    bool canRedo() const { return !toRedo_.empty(); }
    /// The fields to set for it; nothing if there is no step.
    std::optional<nlohmann::json> undo();
    std::optional<nlohmann::json> redo();

  private:
    struct Step {
        nlohmann::json before, after;
    };
    std::vector<Step> toUndo_, toRedo_;
    bool open_ = false;
};

}  // namespace limpid::viewer
