// Parameter tables: name, default, range, unit and one line of help, declared once per technique.
// The table drives `--set group.name=value`, `limpid info` and the viewer's sliders.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/slider_span.h"

namespace limpid {

using ParamValue = std::variant<bool, int, float>;

/// One parameter as a user sees it. A bool has the range 0..1.
struct ParamInfo {
    std::string name;
    ParamValue defaultValue;
    double minimum = 0.0;
    double maximum = 1.0;
    std::string unit;   ///< "" if it has none
    std::string help;   ///< one line: what it does, and the effect of a larger value
    SliderSpan slider;  ///< for the window
};

/// Converts text to the type of `like`. Throws UsageError naming `name` if the text is not a valid value.
ParamValue parseParam(std::string_view name, std::string_view text, const ParamValue& like);
std::string toString(const ParamValue& value);
/// Throws UsageError naming the parameter and its range if `value` is outside it. NaN and infinity always
/// are.
void checkRange(std::string_view group, const ParamInfo& info, const ParamValue& value);

/// The parameters of the technique whose settings are the struct `Settings`. The defaults are those of the
/// struct.
template <typename Settings>
class ParamTable {
  public:
    explicit ParamTable(std::string group) : group_(std::move(group)) {}

    template <typename T>
    ParamTable& add(std::string name, T Settings::*member, double minimum, double maximum, std::string unit,
                    std::string help) {
        const T initial = Settings{}.*member;
        infos_.push_back(
            {std::move(name), initial, minimum, maximum, std::move(unit), std::move(help),
             usefulSpan(minimum, maximum, static_cast<double>(initial), std::is_same_v<T, int>)});
        setters_.push_back([member](Settings& s, const ParamValue& v) { s.*member = std::get<T>(v); });
        getters_.push_back([member](const Settings& s) -> ParamValue { return s.*member; });
        return *this;
    }
    ParamTable& add(std::string name, bool Settings::*member, std::string help) {
        return add(std::move(name), member, 0.0, 1.0, "", std::move(help));
    }

    /// Sets the range of the window's slider for the parameter added last, where usefulSpan() does not suit
    /// it. `smallest` is for logarithmic sliders that start at 0.
    ParamTable& slider(double min, double max, SliderScale scale = SliderScale::Linear,
                       double smallest = 0.0) {
        infos_.back().slider = {min, max, scale, smallest};
        return *this;
    }

    const std::string& group() const { return group_; }
    const std::vector<ParamInfo>& infos() const { return infos_; }
    ParamValue get(const Settings& settings, size_t index) const { return getters_[index](settings); }

    /// Returns false if the table has no such name. Throws UsageError if the text is invalid or the value out
    /// of range.
    bool set(Settings& settings, std::string_view name, std::string_view text) const {
        for (size_t i = 0; i < infos_.size(); ++i) {
            if (infos_[i].name != name) continue;
            const ParamValue value = parseParam(group_ + "." + infos_[i].name, text, infos_[i].defaultValue);
            checkRange(group_, infos_[i], value);
            setters_[i](settings, value);
            return true;
        }
        return false;
    }

  private:
    std::string group_;
    std::vector<ParamInfo> infos_;
    std::vector<std::function<void(Settings&, const ParamValue&)>> setters_;
    std::vector<std::function<ParamValue(const Settings&)>> getters_;
};

/// The three parts of "group.name=value". Throws UsageError if the text does not have that form.
struct Assignment {
    std::string group, name, value;
};
Assignment parseAssignment(std::string_view text);

}  // namespace limpid
