#include "cli/console/command_text.h"

#include <vector>

namespace limpid::cli {
namespace {

std::string quoted(const std::string& word) {
    constexpr const char* plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=:,./@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

}  // namespace

std::string commandText(const CLI::App& command) {
    std::string text = command.get_name();
    for (const CLI::Option* option : command.get_options()) {
        const bool flag = option->get_expected_max() == 0;
        const std::vector<std::string> values = option->results();
        for (const std::string& value : values) {
            text += " " + option->get_name();
            if (flag) break;
            text += " " + quoted(value);
        }
    }
    return text;
}

}  // namespace limpid::cli
