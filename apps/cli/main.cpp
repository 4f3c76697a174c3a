// limpid: the command line. Exit codes: 0 done, 1 failed while running, 2 wrong usage, 3 an input could not
// be read.
#include <new>

#include "base/error.h"
#include "base/log.h"
#include "commands.h"

namespace limpid::cli {
namespace {

int fail(ExitCode code, const char* message) {
    log::error("{}", message);
    return static_cast<int>(code);
}

int run(int argc, char** argv) {
    CLI::App app("Limpid: a real-time path tracer and denoiser for every Vulkan device.", "limpid");
    app.set_version_flag("--version", LIMPID_VERSION);
    app.require_subcommand(1);
    addRenderCommand(app);
    addMergeCommand(app);
    addDenoiseCommand(app);
    addCompareCommand(app);
    addDatasetCommand(app);
    addBenchCommand(app);
    addViewCommand(app);
    addInfoCommand(app);
    try {
        app.parse(argc, argv);
        return static_cast<int>(ExitCode::Done);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? static_cast<int>(ExitCode::Done) : static_cast<int>(ExitCode::Usage);
    } catch (const Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::Failed, "out of memory");
    } catch (const std::exception& error) {
        return fail(ExitCode::Failed, error.what());
    }
}

}  // namespace
}  // namespace limpid::cli

int main(int argc, char** argv) {
    return limpid::cli::run(argc, argv);
}
