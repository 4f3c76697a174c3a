// The state as a JSON object, for files, for undoing and for clients in another process; and the table of its
// fields, which user interfaces draw their controls from.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/slider_span.h"
#include "studio/state/facts.h"
#include "studio/state/state.h"

namespace limpid::studio {

/// One field of the state. Keys of parameters are as for `--set`: "svgf.levels".
struct Field {
    enum class Kind {
        Bool,
        Int,
        Float,
        Choice,  ///< a string, one of `choices`
        Index,  ///< a number, an index into a list of Facts named by `choices`.front(): "cameras" or "images"
        Vector,  ///< three numbers
        Text,
        Lights,      ///< an array with an object for each light
        Background,  ///< null, or three numbers: linear Rec. 709
        Extent,      ///< two numbers
        Settings,    ///< an array of strings: assignments such as "denoiser=svgf" and "svgf.levels=3"
    } kind = Kind::Bool;
    std::string key;
    std::string section;  ///< "scene", "camera", "light", "method", "look", "compare", "inspect", or a
                          ///< parameter group
    std::string label;    ///< a few words
    std::string help;     ///< a sentence
    std::string unit;     ///< empty: none
    double minimum = 0.0, maximum = 0.0;  ///< inclusive, of Int and Float
    SliderSpan slider;
    std::vector<std::string> choices;
    std::vector<std::string> choiceHelp;  ///< a sentence for each of `choices`; empty: they need none
    std::vector<std::string> denoisers;   ///< those that it changes something for; empty: it needs none
    nlohmann::json defaultValue;          ///< null: depends on the scene
};

const std::vector<Field>& fields();
/// Null if there is no such field.
const Field* findField(std::string_view key);

/// All fields, by key.
nlohmann::json toJson(const State& state);
/// Sets the fields that `changes` names. Throws UsageError naming the key if there is no such field or the
/// value does not fit; then `state` is as it was.
void apply(State& state, const nlohmann::json& changes);
/// The fields in which `now` differs from `before`, for apply(). Empty object: none.
nlohmann::json changesOf(const nlohmann::json& before, const nlohmann::json& now);

nlohmann::json toJson(const Facts& facts);

}  // namespace limpid::studio
