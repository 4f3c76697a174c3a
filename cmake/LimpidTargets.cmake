# Functions that the CMakeLists.txt of every folder uses to define its targets.

# Compiler options for Limpid's own files. Programs that link its libraries do not inherit them.
add_library(limpid_options INTERFACE)
target_include_directories(limpid_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
# All code must be usable in the shared libraries, which export only what is listed explicitly.
target_compile_options(limpid_options INTERFACE -fPIC -fvisibility=hidden -fvisibility-inlines-hidden)
target_compile_options(limpid_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 warns wrongly about overlaps inside std::string (its bug 105651).
  target_compile_options(limpid_options INTERFACE -Wno-restrict)
endif()
if(LIMPID_WERROR)
  target_compile_options(limpid_options INTERFACE -Werror)
endif()
# For targets with precompiled headers.
add_library(limpid_pch_options INTERFACE)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # With precompiled headers, GCC 12 has more wrong warnings about the standard library.
  foreach(WARNING array-bounds dangling-pointer free-nonheap-object maybe-uninitialized restrict stringop-overflow
          stringop-overread use-after-free)
    target_compile_options(limpid_pch_options INTERFACE -Wno-${WARNING})
  endforeach()
endif()
# For targets that compile several files as one: local names may shadow constants of other files, and types in anonymous
# namespaces seem to come from a header.
add_library(limpid_unity_options INTERFACE)
target_compile_options(limpid_unity_options INTERFACE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
if(LIMPID_SANITIZE)
  target_compile_options(limpid_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                                                  -fno-omit-frame-pointer)
  target_link_options(limpid_options INTERFACE -fsanitize=address,undefined)
endif()
# The files of test programs: compiling them takes longer than running them, so the compiler optimises them little. What
# they call (Limpid itself, the reference versions) is compiled as everything else.
add_library(limpid_test_options INTERFACE)
if(LIMPID_SANITIZE)
  target_compile_options(limpid_test_options INTERFACE -O0)
else()
  target_compile_options(limpid_test_options INTERFACE $<$<CONFIG:Release,RelWithDebInfo>:-O1>)
endif()
# The files of folders that set LIMPID_LIGHT: commands, windows, reports. They wait for others to compute, and at -O3 they
# are two fifths of a clean build's time.
add_library(limpid_light_options INTERFACE)
target_compile_options(limpid_light_options INTERFACE $<$<CONFIG:Release,RelWithDebInfo>:-O1>)
if(LIMPID_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    message(FATAL_ERROR "LIMPID_FUZZ needs clang, which has libFuzzer: use the preset 'fuzz'")
  endif()
  target_compile_options(limpid_options INTERFACE -fsanitize=fuzzer-no-link,address,undefined
                                                  -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(limpid_options INTERFACE -fsanitize=address,undefined)
endif()

# limpid_optional(NAME PACKAGE DEBIAN LOSS): sets LIMPID_HAVE_NAME to whether CMake finds PACKAGE. If not, prints which
# Debian package has it and what is missing without it.
function(limpid_optional NAME PACKAGE DEBIAN LOSS)
  find_package(${PACKAGE} QUIET GLOBAL)
  if(NOT ${PACKAGE}_FOUND)
    message(STATUS "Without ${DEBIAN}: ${LOSS}.")
  endif()
  set(LIMPID_HAVE_${NAME} ${${PACKAGE}_FOUND} PARENT_SCOPE)
endfunction()

# limpid_find_neural(): sets LIMPID_HAVE_ONEDNN and LIMPID_HAVE_NEURAL. The latter tells whether liblimpid-neural is
# built: if LIMPID_NEURAL is on and all its dependencies are found. (The programs have the network without oneDNN, too:
# it then runs in shaders.)
macro(limpid_find_neural)
  set(LIMPID_HAVE_NEURAL ${LIMPID_NEURAL})
  if(LIMPID_NEURAL AND NOT LIMPID_APPS)
    set(LOSS "there is no liblimpid-neural")
    limpid_optional(TBB TBB libtbb-dev ${LOSS})
    limpid_optional(GLM glm libglm-dev ${LOSS})
    limpid_optional(NLOHMANN nlohmann_json nlohmann-json3-dev ${LOSS})
    limpid_optional(ZLIB ZLIB zlib1g-dev ${LOSS})
    if(NOT (LIMPID_HAVE_TBB AND LIMPID_HAVE_GLM AND LIMPID_HAVE_NLOHMANN AND LIMPID_HAVE_ZLIB))
      set(LIMPID_HAVE_NEURAL OFF)
    endif()
  endif()
  if(LIMPID_APPS OR LIMPID_NEURAL)
    limpid_optional(ONEDNN oneDNN libdnnl-dev "networks are slower on CPUs, and there is no liblimpid-neural")
    if(NOT LIMPID_HAVE_ONEDNN)
      set(LIMPID_HAVE_NEURAL OFF)
    endif()
  endif()
endmacro()

# With LIMPID_PCH these headers are precompiled, which reduces the time of a clean build to two thirds. It is off by
# default, so that missing includes are noticed (scripts/check_includes.py finds most of them, too).
set(LIMPID_PCH_HEADERS
  <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <optional> <random> <set>
  <span> <sstream> <string> <string_view> <vector> <fmt/format.h> <glm/glm.hpp> <nlohmann/json.hpp>)

# limpid_add_pch(NAME [DEPS TARGET ...] [HEADERS <header> ...]): adds the object library NAME, which precompiles the
# headers above and these.
function(limpid_add_pch NAME)
  cmake_parse_arguments(ARG "" "" "DEPS;HEADERS" ${ARGN})
  add_library(${NAME} OBJECT ${PROJECT_BINARY_DIR}/pch/pch.cpp)
  target_link_libraries(${NAME}
    PRIVATE limpid_options limpid_pch_options PUBLIC fmt::fmt glm::glm nlohmann_json::nlohmann_json ${ARG_DEPS})
  target_precompile_headers(${NAME} PRIVATE ${LIMPID_PCH_HEADERS} ${ARG_HEADERS})
endfunction()

# limpid_precompile(): creates the sets of precompiled headers. Call it after their packages are found. GCC compiles what
# uses a set at the optimisation of the set, so each level has its own.
function(limpid_precompile)
  if(NOT LIMPID_PCH OR LIMPID_FUZZ)
    return()
  endif()
  file(WRITE ${PROJECT_BINARY_DIR}/pch/pch.cpp "// Compiled only to have its headers parsed.\n")
  limpid_add_pch(limpid_pch)
  limpid_add_pch(limpid_light_pch)
  target_link_libraries(limpid_light_pch PRIVATE limpid_light_options)
  if(LIMPID_TESTS)
    limpid_add_pch(limpid_test_pch DEPS GTest::gmock GTest::gtest HEADERS <gmock/gmock.h> <gtest/gtest.h>)
    target_link_libraries(limpid_test_pch PRIVATE limpid_test_options)
  endif()
endfunction()

# limpid_use_pch(TARGET FROM): lets TARGET use the precompiled headers of FROM, if that exists, with the definitions
# that they were compiled with.
function(limpid_use_pch NAME FROM)
  if(TARGET ${FROM})
    target_precompile_headers(${NAME} REUSE_FROM ${FROM})
    target_compile_definitions(${NAME} PRIVATE $<TARGET_PROPERTY:${FROM},INTERFACE_COMPILE_DEFINITIONS>)
    target_link_libraries(${NAME} PRIVATE limpid_pch_options)
  endif()
endfunction()

# limpid_unity(TARGET FILES): compiles up to FILES files of the target as one. A clean build takes half the time, but a
# change of one file recompiles others, too. Meant for CI.
function(limpid_unity NAME FILES)
  set_target_properties(${NAME} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${FILES})
  target_link_libraries(${NAME} PRIVATE limpid_unity_options)
endfunction()

# limpid_quick(TARGET): applies LIMPID_PCH, LIMPID_UNITY and the folder's LIMPID_LIGHT to a target that is not a test.
function(limpid_quick NAME)
  if(LIMPID_LIGHT)
    limpid_use_pch(${NAME} limpid_light_pch)
    target_link_libraries(${NAME} PRIVATE limpid_light_options)
  else()
    limpid_use_pch(${NAME} limpid_pch)
  endif()
  if(LIMPID_UNITY)
    limpid_unity(${NAME} 16)
  endif()
endfunction()

# limpid_alone(a.cpp ...): excludes files from unity builds, because other files have the same private names.
macro(limpid_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endmacro()

# limpid_library(NAME SOURCES a.cpp ... DEPS limpid::base ... [PRIVATE_DEPS ...]): adds the static library limpid_NAME,
# with the alias limpid::NAME.
function(limpid_library NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  add_library(limpid_${NAME} STATIC ${ARG_SOURCES})
  add_library(limpid::${NAME} ALIAS limpid_${NAME})
  target_link_libraries(limpid_${NAME} PUBLIC ${ARG_DEPS} PRIVATE limpid_options ${ARG_PRIVATE_DEPS})
  limpid_quick(limpid_${NAME})
endfunction()

# limpid_shared_library(NAME FILE EXPORTS SOURCES a.cpp ... DEPS ...): adds the shared library libFILE.so.0, target
# limpid::NAME, for programs that include include/limpid. It contains the static libraries it needs, and exports what
# the version script EXPORTS lists.
function(limpid_shared_library NAME FILE EXPORTS)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  set(TARGET limpid_${NAME})
  set(SCRIPT ${CMAKE_CURRENT_SOURCE_DIR}/${EXPORTS})
  add_library(${TARGET} SHARED ${ARG_SOURCES} ${EXPORTS})
  add_library(limpid::${NAME} ALIAS ${TARGET})
  target_link_libraries(${TARGET} PRIVATE limpid_options ${ARG_DEPS})
  target_include_directories(${TARGET} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_options(${TARGET} PRIVATE -Wl,--version-script=${SCRIPT})
  if(NOT LIMPID_SANITIZE)
    target_link_options(${TARGET} PRIVATE -Wl,--no-undefined)  # with sanitizers, the program defines their symbols
  endif()
  set_target_properties(${TARGET} PROPERTIES
    OUTPUT_NAME ${FILE} EXPORT_NAME ${NAME} VERSION ${PROJECT_VERSION} SOVERSION 0
    POSITION_INDEPENDENT_CODE OFF LINK_DEPENDS ${SCRIPT})
endfunction()

# limpid_program(NAME SOURCES a.cpp ... DEPS limpid::base ...): adds an executable.
function(limpid_program NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_executable(${NAME} ${ARG_SOURCES})
  target_link_libraries(${NAME} PRIVATE limpid_options ${ARG_DEPS})
  target_include_directories(${NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  limpid_quick(${NAME})
endfunction()

# The optimisation passes for embedded shaders. Not -O, which inlines every call and unrolls loops: shaders become
# larger (atrous_level 25 times), and drivers can no longer choose where inlining and unrolling help their device. None
# of these passes changes floating-point results.
set(LIMPID_SPIRV_PASSES
  --eliminate-dead-functions --eliminate-local-single-block --eliminate-local-single-store
  --eliminate-dead-code-aggressive --scalar-replacement=100 --convert-local-access-chains --ssa-rewrite
  --eliminate-dead-code-aggressive --redundancy-elimination --eliminate-dead-code-aggressive --merge-blocks)

# limpid_shaders(TARGET a/b.comp ... [WORDS_ONLY c.vert ...] [UNOPTIMISED a/b.comp ...]): compiles shaders below the
# current folder and embeds each in TARGET as `limpid::shaders::b_comp` (a ShaderCode of gpu/graph/shader_code.h),
# declared in the generated header "b.comp.h". WORDS_ONLY: shaders that the frame graph cannot use; only their SPIR-V is
# embedded (std::span<const uint32_t>). UNOPTIMISED: those of the given shaders that are not optimised, only stripped.
#
# First, glslc -g (without -O) writes shaders/b.comp.spv, which still has the names by which the frame graph binds
# resources; limpid_reflect reads these. Then spirv-opt optimises and strips the file, and the result is embedded.
function(limpid_shaders TARGET)
  cmake_parse_arguments(ARG "" "" "WORDS_ONLY;UNOPTIMISED" ${ARGN})
  set(GENERATED ${CMAKE_CURRENT_BINARY_DIR}/shaders)
  file(MAKE_DIRECTORY ${GENERATED})
  foreach(SOURCE ${ARG_UNOPTIMISED})
    if(NOT SOURCE IN_LIST ARG_UNPARSED_ARGUMENTS AND NOT SOURCE IN_LIST ARG_WORDS_ONLY)
      message(FATAL_ERROR "limpid_shaders: ${SOURCE} is not one of the shaders of ${TARGET}")
    endif()
  endforeach()
  foreach(SOURCE ${ARG_UNPARSED_ARGUMENTS} ${ARG_WORDS_ONLY})
    set(PASSES ${LIMPID_SPIRV_PASSES})
    if(SOURCE IN_LIST ARG_UNOPTIMISED)
      set(PASSES "")
    endif()
    if(SOURCE IN_LIST ARG_WORDS_ONLY)
      limpid_shader(${TARGET} ${SOURCE} ${GENERATED} shader_words "${PASSES}")
    else()
      limpid_shader(${TARGET} ${SOURCE} ${GENERATED} shader "${PASSES}")
    endif()
  endforeach()
  target_include_directories(${TARGET} PUBLIC ${GENERATED})
endfunction()

# limpid_shader_variants(TARGET SUFFIX MACRO a/b.comp ...): compiles shaders again with MACRO defined, and embeds each
# as `limpid::shaders::b_SUFFIX_comp`. Its name is "a/b.comp -DMACRO".
function(limpid_shader_variants TARGET SUFFIX MACRO)
  foreach(SOURCE ${ARGN})
    limpid_shader(${TARGET} ${SOURCE} ${CMAKE_CURRENT_BINARY_DIR}/shaders shader "${LIMPID_SPIRV_PASSES}" ${SUFFIX} ${MACRO})
  endforeach()
endfunction()

# limpid_shader(TARGET SOURCE GENERATED KIND PASSES [SUFFIX MACRO]): compiles and embeds one shader. KIND: the
# templates to use (cmake/KIND.h.in and cmake/KIND.cpp.in).
function(limpid_shader TARGET SOURCE GENERATED KIND PASSES)
  get_filename_component(FILE ${SOURCE} NAME)
  set(VARIANT "")
  if(ARGC GREATER 5)
    string(REPLACE "." "_${ARGV5}." FILE ${FILE})
    set(VARIANT "-D${ARGV6}")
  endif()
  string(MAKE_C_IDENTIFIER ${FILE} SYMBOL)
  file(RELATIVE_PATH FOLDER ${PROJECT_SOURCE_DIR}/src ${CMAKE_CURRENT_SOURCE_DIR})
  set(SHADER_SYMBOL ${SYMBOL})
  set(SHADER_FILE ${FILE})
  string(STRIP "${FOLDER}/${SOURCE} ${VARIANT}" SHADER_NAME)
  set(SHADER_TABLE ${GENERATED}/${FILE}.inc)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${KIND}.h.in ${GENERATED}/${FILE}.h @ONLY)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${KIND}.cpp.in ${GENERATED}/${FILE}.cpp @ONLY)
  set(NAMED ${GENERATED}/${FILE}.spv)
  set(EMBEDDED ${GENERATED}/${FILE}.embedded.spv)
  set(REFLECT limpid_reflect "${SHADER_NAME}" ${NAMED} ${EMBEDDED} ${SHADER_TABLE})
  if(KIND STREQUAL shader_words)
    set(REFLECT limpid_reflect --words ${EMBEDDED} ${SHADER_TABLE})
  endif()
  add_custom_command(
    OUTPUT ${NAMED}
    COMMAND ${GLSLC} --target-env=vulkan1.3 -g -Werror ${VARIANT} -MD -MF ${NAMED}.d -I ${PROJECT_SOURCE_DIR}/src
            -o ${NAMED} ${CMAKE_CURRENT_SOURCE_DIR}/${SOURCE}
    DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${SOURCE}
    DEPFILE ${NAMED}.d
    VERBATIM)
  add_custom_command(
    OUTPUT ${SHADER_TABLE}
    BYPRODUCTS ${EMBEDDED}
    COMMAND ${SPIRV_OPT} --target-env=vulkan1.3 --scalar-block-layout ${PASSES} --strip-debug ${NAMED} -o ${EMBEDDED}
    COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${EMBEDDED}
    COMMAND ${REFLECT}
    DEPENDS ${NAMED} limpid_reflect
    VERBATIM)
  set_source_files_properties(${GENERATED}/${FILE}.cpp PROPERTIES
    OBJECT_DEPENDS ${SHADER_TABLE} SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${TARGET} PRIVATE ${GENERATED}/${FILE}.cpp)
  if(KIND STREQUAL shader)
    set_property(TARGET ${TARGET} APPEND PROPERTY LIMPID_SHADERS "${FILE}")
  endif()
  set_property(TARGET ${TARGET} PROPERTY LIMPID_SHADER_FOLDER ${GENERATED})
endfunction()

# limpid_shader_list(TARGET LIBRARY ...): for tests. Adds to TARGET the list of all shaders of the libraries, with the
# SPIR-V files they were made from: `limpid::shaders::listed()` in the generated header "shader_list.h".
function(limpid_shader_list TARGET)
  set(SHADER_INCLUDES "")
  set(SHADER_ROWS "")
  foreach(LIBRARY ${ARGN})
    get_target_property(FOLDER ${LIBRARY} LIMPID_SHADER_FOLDER)
    get_target_property(FILES ${LIBRARY} LIMPID_SHADERS)
    foreach(FILE ${FILES})
      string(MAKE_C_IDENTIFIER ${FILE} SYMBOL)
      string(APPEND SHADER_INCLUDES "#include \"${FILE}.h\"\n")
      string(APPEND SHADER_ROWS "    {&${SYMBOL}, \"${FOLDER}/${FILE}.spv\"},\n")
    endforeach()
  endforeach()
  set(GENERATED ${CMAKE_CURRENT_BINARY_DIR}/${TARGET}_shaders)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/shader_list.h.in ${GENERATED}/shader_list.h @ONLY)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/shader_list.cpp.in ${GENERATED}/shader_list.cpp @ONLY)
  target_sources(${TARGET} PRIVATE ${GENERATED}/shader_list.cpp)
  target_include_directories(${TARGET} PRIVATE ${GENERATED})
endfunction()

# limpid_text(TARGET a.html ...): embeds files of the current folder in TARGET as `limpid::embedded::a_html`
# (std::string_view), in the generated header "a.html.h".
function(limpid_text TARGET)
  set(GENERATED ${CMAKE_CURRENT_BINARY_DIR}/embedded)
  foreach(SOURCE ${ARGN})
    get_filename_component(FILE ${SOURCE} NAME)
    string(MAKE_C_IDENTIFIER ${FILE} SYMBOL)
    add_custom_command(
      OUTPUT ${GENERATED}/${FILE}.h
      COMMAND ${CMAKE_COMMAND} -D INPUT=${CMAKE_CURRENT_SOURCE_DIR}/${SOURCE} -D OUTPUT=${GENERATED}/${FILE}.h
              -D NAME=${SYMBOL} -P ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake
      DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${SOURCE} ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake
      VERBATIM)
    target_sources(${TARGET} PRIVATE ${GENERATED}/${FILE}.h)
  endforeach()
  target_include_directories(${TARGET} PRIVATE ${GENERATED})
endfunction()

# limpid_bytes(TARGET a.bin ...): embeds files in TARGET as `limpid::embedded::a_bin` (std::span<const uint32_t>, padded
# with zeros), declared in the generated header "a.bin.h".
function(limpid_bytes TARGET)
  set(GENERATED ${CMAKE_CURRENT_BINARY_DIR}/embedded)
  foreach(SOURCE ${ARGN})
    get_filename_component(FILE ${SOURCE} NAME)
    string(MAKE_C_IDENTIFIER ${FILE} SYMBOL)
    add_custom_command(
      OUTPUT ${GENERATED}/${FILE}.h ${GENERATED}/${FILE}.cpp
      COMMAND ${CMAKE_COMMAND} -D INPUT=${SOURCE} -D OUTPUT=${GENERATED}/${FILE} -D NAME=${SYMBOL}
              -P ${PROJECT_SOURCE_DIR}/cmake/embed_bytes.cmake
      DEPENDS ${SOURCE} ${PROJECT_SOURCE_DIR}/cmake/embed_bytes.cmake
      VERBATIM)
    target_sources(${TARGET} PRIVATE ${GENERATED}/${FILE}.h ${GENERATED}/${FILE}.cpp)
  endforeach()
  target_include_directories(${TARGET} PRIVATE ${GENERATED})
endfunction()

if(LIMPID_TESTS)
  add_custom_target(limpid_fast_tests)
endif()

# limpid_test(NAME SOURCES a_test.cpp ... DEPS ... [LABELS slow]): adds a GoogleTest program, each of whose suites is a
# test for ctest. The target limpid_fast_tests builds all test programs that are not slow.
function(limpid_test NAME)
  cmake_parse_arguments(ARG "" "LABELS" "SOURCES;DEPS" ${ARGN})
  if(NOT LIMPID_TESTS)
    return()
  endif()
  if(NOT ARG_LABELS)
    set(ARG_LABELS fast)
  endif()
  add_executable(${NAME} ${ARG_SOURCES})
  target_link_libraries(${NAME} PRIVATE limpid_options limpid_test_options ${ARG_DEPS} GTest::gmock_main GTest::gtest)
  target_include_directories(${NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${NAME} PRIVATE LIMPID_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  limpid_use_pch(${NAME} limpid_test_pch)
  if(LIMPID_UNITY)
    limpid_unity(${NAME} 8)
  endif()
  if(ARG_LABELS STREQUAL fast)
    add_dependencies(limpid_fast_tests ${NAME})
  endif()
  set(REGISTER ${CMAKE_CURRENT_BINARY_DIR}/${NAME}_suites.cmake)
  file(GENERATE OUTPUT ${REGISTER} CONTENT "set(PROGRAM \"$<TARGET_FILE:${NAME}>\")
set(LABELS \"${ARG_LABELS}\")
include(\"${PROJECT_SOURCE_DIR}/cmake/discover_suites.cmake\")
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${REGISTER})
endfunction()
