#include "cli/options/long_render_options.h"

#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "base/files/file.h"
#include "cli/cluster/session.h"
#include "cli/console/help_text.h"

namespace limpid::cli {
namespace {

/// Returns 0 if the text is not a positive number.
uint32_t positiveNumber(std::string_view text) {
    uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() ? value : 0;
}

}  // namespace

void addLongRenderOptions(CLI::App& command, LongRenderChoice& choice) {
    const OptionGroup group(command, "Long renders");
    command
        .add_option("--time-limit", choice.timeLimit,
                    "Seconds from the start of the program after which the picture so far is written")
        ->check(CLI::Range(1e-3, 1e9));
    command.add_option("--checkpoint", choice.checkpoint,
                       "File that keeps the state of the render (docs/long-renders.md)");
    command.add_flag("--resume", choice.resume,
                     "Continue from the checkpoint, or start from the beginning if it does not exist");
    command.add_option("--shard", choice.shard,
                       "I/N: render the I-th of N parts of a sequence's frames or a still's samples; a "
                       "still's OUTPUT is a .sums file for 'limpid merge'");
}

bool isLongRender(const LongRenderChoice& choice) {
    return choice.timeLimit > 0.0 || !choice.checkpoint.empty() || choice.resume || !choice.shard.empty();
}

Shard chosenShard(const std::string& choice) {
    if (choice.empty()) return {};
    const size_t slash = std::min(choice.find('/'), choice.size());
    const std::string_view text = choice;
    const Shard shard{.index = positiveNumber(text.substr(0, slash)),
                      .count = positiveNumber(text.substr(std::min(slash + 1, text.size())))};
    if (shard.index == 0 || shard.count == 0 || shard.index > shard.count) {
        throw UsageError("--shard: '" + choice + "' is not I/N, the I-th of N parts, I from 1 to N");
    }
    return shard;
}

void checkLongRender(const LongRenderChoice& choice) {
    if (choice.resume && choice.checkpoint.empty())
        throw UsageError("--resume needs --checkpoint FILE, the file to go on from");
    if (!isFirstProcess()) return;  // process 0 has the file, and may have begun to write it
    std::error_code status;
    if (!choice.checkpoint.empty() && !choice.resume && std::filesystem::exists(choice.checkpoint, status)) {
        throw UsageError("'" + choice.checkpoint +
                         "' exists: --resume goes on from it; remove it to begin anew");
    }
    if (choice.checkpoint.empty()) return;
    const std::optional<std::string> fault = irregularity(choice.checkpoint);
    if (fault && std::filesystem::exists(choice.checkpoint, status))
        throw InputError(choice.checkpoint, *fault);
    checkWritable(choice.checkpoint);
}

}  // namespace limpid::cli
