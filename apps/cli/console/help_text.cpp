#include "cli/console/help_text.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "base/text/nearest_name.h"

namespace limpid::cli {
namespace {

constexpr size_t lineWidth = 100, nameWidth = 28;

/// Breaks a text at spaces into lines of at most `width` letters; a longer word has a line of its own.
std::vector<std::string> linesOf(const std::string& text, size_t width) {
    std::vector<std::string> lines(1);
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
        lines.back() += (lines.back().empty() ? "" : " ") + word;
    }
    return lines;
}

/// What CLI11 says of an option's type, "FLOAT:FLOAT in [0.01 - 179]", in words.
struct TypeText {
    std::string value;  ///< "NUMBER", "pcg|tea"
    std::string range;  ///< "0.01 to 179"; empty: none, or one that says nothing
};
TypeText typeTextOf(const CLI::Option& option) {
    std::string type = option.get_type_name();
    TypeText text{.value = type.substr(0, type.find(':')), .range = {}};
    if (text.value == "FLOAT") text.value = "NUMBER";
    if (text.value == "INT" || text.value == "UINT") text.value = "N";
    const size_t open = type.find('{'), close = type.find('}', open);
    const size_t colon = type.find(':');
    if (close != std::string::npos) {
        text.value = type.substr(open + 1, close - open - 1);
        std::replace(text.value.begin(), text.value.end(), ',', '|');
    } else if (const size_t in = type.find(" in ["); in != std::string::npos) {
        text.range = type.substr(in + 5, type.find(']', in) - in - 5);
        if (const size_t dash = text.range.find(" - "); dash != std::string::npos)
            text.range.replace(dash, 3, " to ");
        if (text.range.find("e+") != std::string::npos || text.range.size() > 24) text.range.clear();
    } else if (colon != std::string::npos && type.find('|', colon) != std::string::npos) {
        text.value = type.substr(colon + 1);
    }
    if (text.value == "SIZE" || type.find("SIZE [") != std::string::npos) text.value = "SIZE";
    return text;
}

class HelpFormat : public CLI::Formatter {
  public:
    std::string make_option(const CLI::Option* option, bool isPositional) const override {
        std::string name = make_option_name(option, isPositional);
        std::string description = option->get_description();
        const bool takesValue = option->get_items_expected_max() > 0;
        if (takesValue && !isPositional) {
            const TypeText type = typeTextOf(*option);
            name += " " + type.value;
            if (!type.range.empty()) description += " [" + type.range + "]";
        }
        if (option->get_required() && !isPositional) description += " [required]";
        return entry(name, description);
    }

    /// One empty line between groups: CLI11 writes one before and one after each.
    std::string make_group(std::string group, bool isPositional,
                           std::vector<const CLI::Option*> options) const override {
        const bool first = isPositional || group == "Options";
        std::string text = CLI::Formatter::make_group(std::move(group), isPositional, std::move(options));
        return first || text.empty() ? text : text.substr(1);
    }

    std::string make_subcommand(const CLI::App* command) const override {
        return entry(command->get_display_name(true), command->get_description());
    }

    std::string make_description(const CLI::App* app) const override {
        return wrapped(app->get_description());
    }

    std::string make_footer(const CLI::App* app) const override {
        const std::string footer = app->get_footer();
        return footer.empty() ? footer : "\n" + wrapped(footer);
    }

  private:
    /// Keeps line breaks.
    static std::string wrapped(const std::string& text) {
        std::string result;
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);)
            for (const std::string& part : linesOf(line, lineWidth)) result += part + "\n";
        return result;
    }

    /// A name on the left and its description on the right.
    static std::string entry(const std::string& name, const std::string& description) {
        std::string text = "  " + name;
        const std::vector<std::string> lines = linesOf(description, lineWidth - nameWidth);
        for (size_t i = 0; i < lines.size() && !lines[i].empty(); ++i) {
            if (i > 0 || text.size() >= nameWidth) text += "\n" + std::string(nameWidth, ' ');
            if (i == 0 && text.size() < nameWidth) text.resize(nameWidth, ' ');
            text += lines[i];
        }
        return text + "\n";
    }
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> helpFormat() {
    return std::make_shared<HelpFormat>();
}

std::string nearestCommand(const CLI::App& app, const std::string& word) {
    std::vector<std::string> names;
    for (const CLI::App* command :
         app.get_subcommands([](const CLI::App* candidate) { return !candidate->get_group().empty(); }))
        names.push_back(command->get_name());
    return nearestName(word, names);
}

std::string suggestionFor(const CLI::App& app) {
    const CLI::App* command = &app;
    while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
    for (const std::string& word : command->remaining()) {
        if (!word.starts_with('-')) {
            const std::string meant = nearestCommand(*command, word);
            return meant.empty() ? "" : "Did you mean '" + meant + "'?";
        }
        std::vector<std::string> names;
        for (const CLI::Option* option : command->get_options())
            if (!option->get_group().empty())
                for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        const std::string meant = nearestName(word.substr(0, word.find('=')), names);
        return meant.empty() ? "" : "Did you mean " + meant + "?";
    }
    return {};
}

}  // namespace limpid::cli
