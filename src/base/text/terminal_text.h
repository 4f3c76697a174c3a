// Makes text of unknown origin (file names, names in files) safe to print on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace limpid {

/// How line feeds and tabs are treated.
enum class LineBreaks { Escape, Keep };

/// Returns `text` with control characters (below 0x20, 0x7f, and U+0080 to U+009F) and bytes that are not
/// UTF-8 written like \x1b. So a file's name can neither move the cursor nor imitate our messages.
std::string terminalText(std::string_view text, LineBreaks breaks = LineBreaks::Escape);

}  // namespace limpid
