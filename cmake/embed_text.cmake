# cmake -D INPUT=... -D OUTPUT=... -D NAME=... -P embed_text.cmake: writes a header with the file as a string.
file(READ "${INPUT}" TEXT)
string(FIND "${TEXT}" ")embedded\"" CLASH)
string(LENGTH "${TEXT}" LENGTH)
# C++ compilers must accept literals of 65536 characters, and warn about longer ones.
if(NOT CLASH EQUAL -1 OR LENGTH GREATER 65000)
  message(FATAL_ERROR "${INPUT} is too long for a string literal, or contains what would end it")
endif()
file(WRITE "${OUTPUT}" "#pragma once
#include <string_view>

namespace limpid::embedded {
inline constexpr std::string_view ${NAME} = R\"embedded(${TEXT})embedded\";
}
")
