# cmake -DFOLDER=page -DOUTPUT=page_files.cpp -P embed_page.cmake: the files of a folder as C++ (page_files.h).
file(GLOB FILES RELATIVE ${FOLDER} ${FOLDER}/*.html ${FOLDER}/*.css ${FOLDER}/*.js)
set(TYPE_html "text/html; charset=utf-8")
set(TYPE_css "text/css; charset=utf-8")
set(TYPE_js "text/javascript; charset=utf-8")
set(TEXTS "")
set(ROWS "")
set(NUMBER 0)
foreach(FILE ${FILES})
  file(READ ${FOLDER}/${FILE} HEX HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," BYTES "${HEX}")
  string(REGEX REPLACE "[^.]*\\." "" EXTENSION ${FILE})
  string(APPEND TEXTS "constexpr unsigned char file${NUMBER}[] = {${BYTES}0};\n")
  string(APPEND ROWS "    {\"${FILE}\", \"${TYPE_${EXTENSION}}\", textOf(file${NUMBER}, sizeof(file${NUMBER}) - 1)},\n")
  math(EXPR NUMBER "${NUMBER} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"serve/web/page_files.h\"

#include <array>

namespace limpid::serve {
namespace {

${TEXTS}
std::string_view textOf(const unsigned char* bytes, size_t size) {
    return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace

std::span<const PageFile> pageFiles() {
    static const std::array<PageFile, ${NUMBER}> files{{
${ROWS}    }};
    return files;
}

}  // namespace limpid::serve
")
