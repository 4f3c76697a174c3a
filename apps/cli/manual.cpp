// Generates the man page and the shell completions from the same option tables that --help shows.
#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "commands.h"

namespace limpid::cli {
namespace {

/// One option or positional argument, for man page and completion.
struct Entry {
    std::vector<std::string> names;   ///< "-o", "--output"; empty: a positional
    std::string placeholder;          ///< its argument, such as "FILE"; empty: a flag
    std::string help;                 ///< the first line of its description
    std::vector<std::string> values;  ///< all accepted values, if there are few enough to list
};

/// A command and its full name, such as "limpid bench quality".
struct Command {
    std::string path;
    const CLI::App* app;
};

/// Returns the words of the first "{a,b,c}" in a type's text; for "a->1" the part before the arrow.
std::vector<std::string> listedValues(const std::string& type) {
    const size_t open = type.find('{'), close = type.find('}', open);
    if (open == std::string::npos || close == std::string::npos) return {};
    std::vector<std::string> values = CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
    for (std::string& value : values) value = value.substr(0, value.find("->"));
    return values;
}

std::string firstLine(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

std::vector<Entry> entriesOf(const CLI::App& app) {
    std::vector<Entry> entries;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) continue;
        Entry entry{{}, "", firstLine(option->get_description()), listedValues(option->get_type_name())};
        for (const std::string& name : option->get_snames()) entry.names.push_back("-" + name);
        for (const std::string& name : option->get_lnames()) entry.names.push_back("--" + name);
        if (entry.names.empty()) {
            entry.placeholder = option->get_name(true);
        } else if (option->get_items_expected_max() > 0) {
            entry.placeholder = option->get_type_name();
        }
        entries.push_back(entry);
    }
    return entries;
}

std::vector<const CLI::App*> shownCommands(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// Returns the program and all of its subcommands.
std::vector<Command> allCommands(const CLI::App& program) {
    std::vector<Command> all;
    const std::function<void(const std::string&, const CLI::App&)> visit = [&](const std::string& path,
                                                                               const CLI::App& app) {
        all.push_back({path, &app});
        for (const CLI::App* command : shownCommands(app)) visit(path + " " + command->get_name(), *command);
    };
    visit(program.get_name(), program);
    return all;
}

// ---------------------------------------------------------------- man page

/// Escapes plain text for roff.
std::string roff(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool lineBegins = result.empty() || result.back() == '\n';
        if (lineBegins && (c == '.' || c == '\'')) result += "\\&";
        if (c == '\\') {
            result += "\\e";
        } else {
            if (c == '-') result += '\\';
            result += c;
        }
    }
    return result;
}

std::string manEntry(const Entry& entry) {
    const std::string names = fmt::format("{}", fmt::join(entry.names, ", "));
    const std::string gap = names.empty() || entry.placeholder.empty() ? "" : " ";
    return fmt::format(".TP\n\\fB{}\\fR{}\\fI{}\\fR\n{}\n", roff(names), gap, roff(entry.placeholder),
                       roff(entry.help));
}

std::string upper(std::string text) {
    for (char& c : text)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return text;
}

std::string manPage(const CLI::App& program) {
    std::string page =
        fmt::format(".TH LIMPID 1 \"\" \"Limpid {}\"\n.SH NAME\nlimpid \\- {}\n", LIMPID_VERSION,
                    "real\\-time path tracer and denoiser for any Vulkan device");
    page += ".SH SYNOPSIS\n.B limpid\n\\fICOMMAND\\fR [\\fIOPTION\\fR ...]\n";
    for (const auto& [path, app] : allCommands(program)) {
        const bool isProgram = app == &program;
        page += isProgram ? ".SH DESCRIPTION\n" : fmt::format(".SH {}\n", roff(upper(path)));
        page += roff(app->get_description()) + "\n";
        for (const Entry& entry : entriesOf(*app)) page += manEntry(entry);
        if (!app->get_footer().empty()) page += ".PP\n" + roff(app->get_footer()) + "\n";
    }
    return page +
           ".SH EXIT STATUS\n0: done; 1: failed while running; 2: wrong usage; 3: an input could not be "
           "read.\n";
}

// -------------------------------------------------------------- completion

std::string singleQuoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
    return result + "'";
}

/// Returns the lines of a `case` in bash and zsh that finds the typed command.
std::string pathCases(const CLI::App& program, const std::string& indent) {
    std::string cases;
    for (const auto& [path, app] : allCommands(program))
        if (app != &program) cases += fmt::format("{}\"{}\") at=\"{}\" ;;\n", indent, path, path);
    return cases;
}

/// Returns the lines of a `case` that list an option's values, given the command and the option before the
/// cursor.
std::string valueCases(const CLI::App& program, const std::string& indent) {
    std::string cases;
    for (const auto& [path, app] : allCommands(program))
        for (const Entry& entry : entriesOf(*app))
            for (const std::string& name : entry.names)
                if (!entry.values.empty())
                    cases += fmt::format("{}\"{} {}\") values={} ;;\n", indent, path, name,
                                         singleQuoted(fmt::format("{}", fmt::join(entry.values, " "))));
    return cases;
}

std::string bashCompletion(const CLI::App& program) {
    std::string wordCases;
    for (const auto& [path, app] : allCommands(program)) {
        std::vector<std::string> words;
        for (const CLI::App* command : shownCommands(*app)) words.push_back(command->get_name());
        for (const Entry& entry : entriesOf(*app))
            words.insert(words.end(), entry.names.begin(), entry.names.end());
        wordCases += fmt::format("        \"{}\") words={} ;;\n", path,
                                 singleQuoted(fmt::format("{}", fmt::join(words, " "))));
    }
    return "_limpid() {\n"
           "    local at=limpid word words= values= current=${COMP_WORDS[COMP_CWORD]}\n"
           "    for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
           "        case \"$at $word\" in\n" +
           pathCases(program, "            ") +
           "        esac\n    done\n"
           "    case \"$at ${COMP_WORDS[COMP_CWORD-1]}\" in\n" +
           valueCases(program, "        ") + "    esac\n    case \"$at\" in\n" + wordCases +
           "    esac\n"
           "    COMPREPLY=($(compgen -W \"${values:-$words}\" -- \"$current\"))\n"
           "}\n"
           "complete -o default -F _limpid limpid\n";
}

std::string zshCompletion(const CLI::App& program) {
    const auto described = [](const std::string& word, const std::string& help) {
        return singleQuoted(word + ":" + help);
    };
    std::string wordCases;
    for (const auto& [path, app] : allCommands(program)) {
        std::vector<std::string> items;
        for (const CLI::App* command : shownCommands(*app))
            items.push_back(described(command->get_name(), firstLine(command->get_description())));
        for (const Entry& entry : entriesOf(*app))
            for (const std::string& name : entry.names) items.push_back(described(name, entry.help));
        wordCases += fmt::format("    \"{}\") items=({}) ;;\n", path, fmt::join(items, " "));
    }
    return "#compdef limpid\n"
           "local at=limpid word values=\nlocal -a items\n"
           "for word in ${words[2,CURRENT-1]}; do\n    case \"$at $word\" in\n" +
           pathCases(program, "        ") + "    esac\ndone\ncase \"$at ${words[CURRENT-1]}\" in\n" +
           valueCases(program, "    ") + "esac\ncase \"$at\" in\n" + wordCases +
           "esac\n"
           "if [[ -n $values ]]; then\n    compadd -- ${=values}\n"
           "else\n    _describe limpid items\n    _files\nfi\n";
}

std::string fishCompletion(const CLI::App& program) {
    std::string paths, lines;
    for (const auto& [path, app] : allCommands(program)) {
        if (app != &program) paths += fmt::format(" \"{}\"", path);
        const std::string here = fmt::format("complete -c limpid -n '__limpid_at \"{}\"'", path);
        for (const CLI::App* command : shownCommands(*app))
            lines += fmt::format("{} -f -a {} -d {}\n", here, command->get_name(),
                                 singleQuoted(firstLine(command->get_description())));
        for (const Entry& entry : entriesOf(*app)) {
            if (entry.names.empty()) continue;
            lines += here;
            for (const std::string& name : entry.names)
                lines += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
            if (!entry.placeholder.empty()) lines += " -r";
            if (!entry.values.empty())
                lines += " -f -a " + singleQuoted(fmt::format("{}", fmt::join(entry.values, " ")));
            lines += " -d " + singleQuoted(entry.help) + "\n";
        }
    }
    return "function __limpid_at\n    set -l at limpid\n    for word in (commandline -opc)[2..]\n"
           "        if contains -- \"$at $word\"" +
           paths +
           "\n            set at \"$at $word\"\n        end\n    end\n    test \"$at\" = \"$argv\"\nend\n" +
           lines;
}

}  // namespace

void addManualCommands(CLI::App& program) {
    CLI::App* const help = program.add_subcommand("help", "The manual")->group("");
    help->add_flag("--man")->required()->description("As a man page");
    help->callback([&program] { fmt::print("{}", manPage(program)); });

    CLI::App* const completion = program.add_subcommand("completion", "Completion for a shell")->group("");
    completion->require_subcommand(1);
    const auto add = [&](const char* shell, std::string (*script)(const CLI::App&)) {
        completion->add_subcommand(shell)->callback(
            [&program, script] { fmt::print("{}", script(program)); });
    };
    add("bash", bashCompletion);
    add("zsh", zshCompletion);
    add("fish", fishCompletion);
}

}  // namespace limpid::cli
