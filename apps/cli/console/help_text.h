// How --help looks, and what is suggested for a mistyped word.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace limpid::cli {

/// Lines of at most 100 columns, the description beside or below an option's name; accepted values and ranges
/// in words.
std::shared_ptr<CLI::FormatterBase> helpFormat();

/// While it lives, options that are added to the command belong to this group of --help.
class OptionGroup {
  public:
    OptionGroup(CLI::App& command, const char* name)
        : command_(command), before_(command.option_defaults()->get_group()) {
        command_.option_defaults()->group(name);
    }
    ~OptionGroup() { command_.option_defaults()->group(before_); }
    OptionGroup(const OptionGroup&) = delete;
    OptionGroup& operator=(const OptionGroup&) = delete;

  private:
    CLI::App& command_;
    std::string before_;
};

/// Returns "Did you mean --width?" for the first argument of a command line that was not understood, or "".
std::string suggestionFor(const CLI::App& app);

/// The name of a subcommand that is most similar to a word; "" if none is.
std::string nearestCommand(const CLI::App& app, const std::string& word);

}  // namespace limpid::cli
