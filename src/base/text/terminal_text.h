// Text of unknown origin (names of files and of what is in them), made fit for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace limpid {

/// What happens to a line feed or a tab.
enum class LineBreaks { Escape, Keep };

/// `text` in which control characters (below 0x20, 0x7f, and U+0080 to U+009F) and bytes that are not UTF-8
/// stand as \x1b: a file's name can neither move the cursor nor pretend to be a message of ours.
std::string terminalText(std::string_view text, LineBreaks breaks = LineBreaks::Escape);

}  // namespace limpid
