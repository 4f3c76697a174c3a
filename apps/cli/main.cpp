// limpid: the command line. Exit codes: 0 success, 1 failed while running, 2 wrong usage, 3 an input could
// not be read.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <sstream>

#include "base/error.h"
#include "base/log.h"
#include "base/text/terminal_text.h"
#include "cli/cluster/session.h"
#include "cli/console/help_text.h"
#include "commands.h"
#include "scene/load/load.h"

namespace limpid::cli {
namespace {

int fail(ExitCode code, const char* message) {
    return failInCluster(static_cast<int>(code), message);
}

/// Prints CLI11's message: help on stdout, errors (with the command that was typed) on stderr.
int answer(const CLI::App& app, const CLI::ParseError& error) {
    std::ostringstream out, faults;
    const int code = app.exit(error, out, faults);
    if (!isFirstProcess())
        return leaveCluster(static_cast<int>(code == 0 ? ExitCode::Done : ExitCode::Usage));
    fmt::print("{}", out.str());
    fmt::print(stderr, "{}", terminalText(faults.str(), LineBreaks::Keep));
    const std::string suggestion = code == 0 ? std::string() : suggestionFor(app);
    if (!suggestion.empty()) fmt::print(stderr, "{}\n", terminalText(suggestion, LineBreaks::Keep));
    std::fflush(stdout);
    return leaveCluster(static_cast<int>(code == 0 ? ExitCode::Done : ExitCode::Usage));
}

std::string nonFinite(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end == text.c_str() || std::isfinite(value) ? "" : "'" + text + "' is not a finite number";
}

/// CLI11 accepts "nan" and "inf" as numbers, and its range checks let NaN pass.
void refuseNonFinite(CLI::App& app) {
    for (CLI::Option* option : app.get_options()) {
        if (option->get_type_name().starts_with("FLOAT")) option->check(CLI::Validator(nonFinite, ""));
    }
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) refuseNonFinite(*command);
}

/// True for a file of a scene, or a built-in one.
bool isScene(const std::string& word) {
    return word.starts_with("builtin:") || scene::isSceneFile(word);
}

/// The words of the command line, in reverse as CLI11 takes them: `limpid SCENE` is `limpid view SCENE`.
std::vector<std::string> wordsOf(int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && isScene(words.front())) words.insert(words.begin(), "view");
    std::reverse(words.begin(), words.end());
    return words;
}

/// "render", or "bench quality". Empty without words.
std::string commandIn(const std::vector<std::string>& words) {
    if (words.empty()) return "";
    const bool two = words.back() == "bench" && words.size() > 1;
    return two ? words.back() + " " + words[words.size() - 2] : words.back();
}

bool asksForHelp(const std::vector<std::string>& words) {
    return std::ranges::any_of(words,
                               [](const std::string& word) { return word == "--help" || word == "-h"; });
}

int run(int argc, char** argv) {
    CLI::App app("Limpid: a real-time path tracer and denoiser for every Vulkan device.", "limpid");
    app.set_version_flag("--version", LIMPID_VERSION);
    app.require_subcommand(1);
    app.formatter(helpFormat());  // subcommands inherit it
    addRenderCommand(app);
    addMergeCommand(app);
    addDenoiseCommand(app);
    addCompareCommand(app);
    addDatasetCommand(app);
    addBenchCommand(app);
    addViewCommand(app);
    addServeCommand(app);
    addInfoCommand(app);
    addManualCommands(app);
    // After the commands, which would inherit it.
    app.footer(
        "'limpid SCENE' opens a scene in the window, like 'limpid view SCENE'.\n"
        "'limpid COMMAND --help' explains the options of a command.");
    refuseNonFinite(app);
    try {
        std::vector<std::string> words = wordsOf(argc, argv);
        joinCluster(commandIn(words), asksForHelp(words));
        app.parse(words);
        return leaveCluster(static_cast<int>(ExitCode::Done));
    } catch (const CLI::ParseError& error) {
        return answer(app, error);
    } catch (const Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::Failed, "out of memory");
    } catch (const std::exception& error) {
        return fail(ExitCode::Failed, error.what());
    }
}

/// By default, glibc returns freed pictures of 1920x1080 to the system only where they lie at the end of a
/// heap, and each thread has a heap: `limpid denoise` would take half as much memory again.
void returnFreedPictures() {
#if defined(__GLIBC__)
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

}  // namespace
}  // namespace limpid::cli

int main(int argc, char** argv) {
    limpid::cli::returnFreedPictures();
    return limpid::cli::run(argc, argv);
}
