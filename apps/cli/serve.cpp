// `limpid serve`: the window in a browser.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files/file.h"
#include "cli/console/interrupt.h"
#include "cli/options/studio_options.h"
#include "commands.h"
#ifdef LIMPID_HAVE_SERVE
#include "serve/serve.h"
#include "serve/web/access.h"
#include "studio/studio.h"
#endif

namespace limpid::cli {
namespace {

struct ServeOptions {
    StudioChoice studio;
    std::string bind = "127.0.0.1", certificate, key, files;
    std::vector<std::string> origins;
    uint16_t port = 8080;
    uint32_t uploads = 0;  ///< MB
};

/// TLS would wait for ever for what a pipe does not say.
void requireFile(const std::string& path) {
    if (path.empty()) return;
    if (const auto fault = irregularity(path)) throw InputError(path, *fault);
}

void run(const ServeOptions& o) {
    if (o.certificate.empty() != o.key.empty())
        throw UsageError("--certificate and --key belong together: give both or none");
    requireFile(o.certificate);
    requireFile(o.key);
#ifdef LIMPID_HAVE_SERVE
    std::vector<std::string> origins;
    for (const std::string& text : o.origins) origins.push_back(serve::parseOrigin(text));
    studio::StudioSettings settings;
    apply(o.studio, settings);
    settings.writesFiles = false;  // clients are elsewhere
    const InterruptGuard guard;
    studio::Studio studio(o.studio.device.device, tracerChoice(o.studio), sceneLoader(),
                          cameraStart(o.studio), settings);
    const auto stop = [&] { return interruptedQuietly() || studio.hasEnded(); };
    serve::serve(studio,
                 {.bind = o.bind,
                  .port = o.port,
                  .certificate = o.certificate,
                  .key = o.key,
                  .origins = std::move(origins),
                  .files = o.files,
                  .uploads = uint64_t{o.uploads} * 1000000},
                 stop, [](const std::string& url) {
                     fmt::print("{}\n", url);
                     std::fflush(stdout);
                 });
    studio.finish();
#else
    throw Error(
        "Limpid was built without libwebsockets-dev and libvpx-dev, which a window in a browser needs; "
        "'limpid "
        "view' opens one here, and 'limpid render' writes pictures");
#endif
}

}  // namespace

void addServeCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "serve", "Show a scene in a browser: the window of 'limpid view', also where there is no screen");
    auto o = std::make_shared<ServeOptions>();
    addStudioOptions(*command, o->studio);
    command->add_option("--port", o->port, "Port to listen on; 0: a free one (8080)");
    command->add_option(
        "--bind", o->bind,
        "Address to listen on; others than this machine's own can be reached from elsewhere, and need "
        "--certificate (127.0.0.1)");
    command->add_option("--certificate", o->certificate,
                        "PEM file with the certificate, for HTTPS; with --key");
    command->add_option("--key", o->key, "PEM file with the certificate's private key");
    command
        ->add_option("--origin", o->origins,
                     "Address at which a proxy offers the page, as https://limpid.example: it may connect, "
                     "too (repeatable)")
        ->allow_extra_args(false);
    command->add_option("--files", o->files,
                        "Folder whose scenes may be opened in the browser; default: none");
    command
        ->add_option(
            "--uploads", o->uploads,
            "Size in MB up to which scenes (one file) and environments may be uploaded; the newest four and "
            "what is shown are kept in a temporary folder until the server ends; default: none")
        ->check(CLI::Range(1, 4000));
    command->footer(
        "The address that is printed contains a secret: who has it can use everything here. From another "
        "machine:\n"
        "  ssh -L 8080:localhost:8080 MACHINE limpid serve SCENE\n"
        "and open the address in a browser.");
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
