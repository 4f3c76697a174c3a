# cmake -D INPUT=... -D OUTPUT=... -D NAME=... -P embed_bytes.cmake: writes OUTPUT.h and OUTPUT.cpp with the file as words.
file(READ "${INPUT}" BYTES HEX)
string(LENGTH "${BYTES}" LENGTH)
math(EXPR MISSING "(8 - ${LENGTH} % 8) % 8")
string(REPEAT "0" ${MISSING} PADDING)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1u," WORDS "${BYTES}${PADDING}")
string(REGEX REPLACE "(............................................................)" "\\1\n" WORDS "${WORDS}")
get_filename_component(FILE "${OUTPUT}" NAME)
file(WRITE "${OUTPUT}.h" "#pragma once
#include <cstdint>
#include <span>

namespace limpid::embedded {
extern const std::span<const uint32_t> ${NAME};
}
")
file(WRITE "${OUTPUT}.cpp" "#include \"${FILE}.h\"

namespace limpid::embedded {
namespace {
constexpr uint32_t ${NAME}_words[] = {
${WORDS}};
}
const std::span<const uint32_t> ${NAME}{${NAME}_words};
}
")
