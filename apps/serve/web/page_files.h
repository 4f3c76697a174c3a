// The files of the page, as they were when the program was built.
#pragma once

#include <span>
#include <string_view>

namespace limpid::serve {

struct PageFile {
    std::string_view name;  ///< "index.html"
    std::string_view type;  ///< for Content-Type
    std::string_view text;
};

std::span<const PageFile> pageFiles();

}  // namespace limpid::serve
