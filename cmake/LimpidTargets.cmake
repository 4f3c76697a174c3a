# Helpers that every folder's CMakeLists.txt uses, so that a folder lists only what it has.

# How Limpid's own files are compiled; whoever links its libraries sees none of it.
add_library(limpid_options INTERFACE)
target_include_directories(limpid_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
# Everything can go into the shared library, which exports nothing by accident.
target_compile_options(limpid_options INTERFACE -fPIC -fvisibility=hidden -fvisibility-inlines-hidden)
target_compile_options(limpid_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 sees overlaps inside std::string that are not there (its bug 105651).
  target_compile_options(limpid_options INTERFACE -Wno-restrict)
endif()
if(LIMPID_WERROR)
  target_compile_options(limpid_options INTERFACE -Werror)
endif()
if(LIMPID_PCH AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # With precompiled headers GCC 12's optimizer sees more faults in the standard library that are not there.
  foreach(WARNING array-bounds dangling-pointer free-nonheap-object maybe-uninitialized restrict stringop-overflow
          stringop-overread use-after-free)
    target_compile_options(limpid_options INTERFACE -Wno-${WARNING})
  endforeach()
endif()
if(LIMPID_UNITY)
  # A local name may then be that of another file's constant, and types of anonymous namespaces seem to come from a header.
  target_compile_options(limpid_options INTERFACE -Wno-shadow -Wno-subobject-linkage)
endif()
if(LIMPID_SANITIZE)
  target_compile_options(limpid_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                                                  -fno-omit-frame-pointer)
  target_link_options(limpid_options INTERFACE -fsanitize=address,undefined)
endif()
if(LIMPID_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    message(FATAL_ERROR "LIMPID_FUZZ needs clang, which has libFuzzer: use the preset 'fuzz'")
  endif()
  target_compile_options(limpid_options INTERFACE -fsanitize=fuzzer-no-link,address,undefined
                                                  -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(limpid_options INTERFACE -fsanitize=address,undefined)
endif()

# limpid_optional(NAME PACKAGE DEBIAN LOSS): sets LIMPID_HAVE_NAME to whether CMake finds PACKAGE; if not, says what is
# lost without it and which Debian package brings it.
function(limpid_optional NAME PACKAGE DEBIAN LOSS)
  find_package(${PACKAGE} QUIET GLOBAL)
  if(NOT ${PACKAGE}_FOUND)
    message(STATUS "Without ${DEBIAN}: ${LOSS}.")
  endif()
  set(LIMPID_HAVE_${NAME} ${${PACKAGE}_FOUND} PARENT_SCOPE)
endfunction()

# limpid_find_neural(): sets LIMPID_HAVE_ONEDNN, and LIMPID_HAVE_NEURAL to whether liblimpid-neural is built: if
# LIMPID_NEURAL is on and all that it needs is there. (The programs have the network without oneDNN, too: in shaders.)
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

# With LIMPID_PCH these headers are parsed once: a clean build takes two thirds of the time. Off by default, so that a file
# must include what it uses.
set(LIMPID_PCH_HEADERS
  <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <optional> <random> <set>
  <span> <sstream> <string> <string_view> <vector> <fmt/format.h> <glm/glm.hpp> <nlohmann/json.hpp>)

# limpid_precompile(): makes the two sets of precompiled headers, once their packages are found.
function(limpid_precompile)
  if(NOT LIMPID_PCH OR LIMPID_FUZZ)
    return()
  endif()
  file(WRITE ${PROJECT_BINARY_DIR}/pch/pch.cpp "// Compiled only to have its headers parsed.\n")
  add_library(limpid_pch OBJECT ${PROJECT_BINARY_DIR}/pch/pch.cpp)
  target_link_libraries(limpid_pch PRIVATE limpid_options PUBLIC fmt::fmt glm::glm nlohmann_json::nlohmann_json)
  target_precompile_headers(limpid_pch PRIVATE ${LIMPID_PCH_HEADERS})
  if(LIMPID_TESTS)
    add_library(limpid_test_pch OBJECT ${PROJECT_BINARY_DIR}/pch/pch.cpp)
    target_link_libraries(limpid_test_pch
      PRIVATE limpid_options PUBLIC fmt::fmt glm::glm nlohmann_json::nlohmann_json GTest::gmock GTest::gtest)
    target_precompile_headers(limpid_test_pch PRIVATE ${LIMPID_PCH_HEADERS} <gmock/gmock.h> <gtest/gtest.h>)
  endif()
endfunction()

# limpid_use_pch(TARGET FROM): TARGET uses the precompiled headers of FROM, where there are any, and the definitions that
# they were parsed with.
function(limpid_use_pch NAME FROM)
  if(TARGET ${FROM})
    target_precompile_headers(${NAME} REUSE_FROM ${FROM})
    target_compile_definitions(${NAME} PRIVATE $<TARGET_PROPERTY:${FROM},INTERFACE_COMPILE_DEFINITIONS>)
  endif()
endfunction()

# With LIMPID_UNITY several files of a target are compiled as one. A clean build takes half the time, but a change of one file
# compiles its neighbours, too; for CI.
function(limpid_unity NAME)
  if(LIMPID_UNITY)
    set_target_properties(${NAME} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# limpid_alone(a.cpp ...): these are compiled by themselves even then: their private names are those of other files, too.
macro(limpid_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endmacro()

# limpid_library(NAME SOURCES a.cpp ... DEPS limpid::base ...): the static library limpid_NAME, alias limpid::NAME.
function(limpid_library NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  add_library(limpid_${NAME} STATIC ${ARG_SOURCES})
  add_library(limpid::${NAME} ALIAS limpid_${NAME})
  target_link_libraries(limpid_${NAME} PUBLIC ${ARG_DEPS} PRIVATE limpid_options ${ARG_PRIVATE_DEPS})
  limpid_use_pch(limpid_${NAME} limpid_pch)
  limpid_unity(limpid_${NAME})
endfunction()

# limpid_shared_library(NAME FILE EXPORTS SOURCES a.cpp ... DEPS ...): libFILE.so.0, limpid::NAME for programs that
# include include/limpid. What it needs is in it; it exports what the version script EXPORTS lists.
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
    target_link_options(${TARGET} PRIVATE -Wl,--no-undefined)  # the sanitizers' own come from the program
  endif()
  set_target_properties(${TARGET} PROPERTIES
    OUTPUT_NAME ${FILE} EXPORT_NAME ${NAME} VERSION ${PROJECT_VERSION} SOVERSION 0
    POSITION_INDEPENDENT_CODE OFF LINK_DEPENDS ${SCRIPT})
endfunction()

# limpid_program(NAME SOURCES a.cpp ... DEPS limpid::base ...): an executable.
function(limpid_program NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_executable(${NAME} ${ARG_SOURCES})
  target_link_libraries(${NAME} PRIVATE limpid_options ${ARG_DEPS})
  target_include_directories(${NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  limpid_use_pch(${NAME} limpid_pch)
  limpid_unity(${NAME})
endfunction()

# What embedded shaders go through. Not -O: it inlines every call and unrolls loops, which makes them larger (atrous_level
# 25 times) and leaves drivers, which do both where it helps their device, nothing to decide. Nothing here changes what is
# computed with floats.
set(LIMPID_SPIRV_PASSES
  --eliminate-dead-functions --eliminate-local-single-block --eliminate-local-single-store
  --eliminate-dead-code-aggressive --scalar-replacement=100 --convert-local-access-chains --ssa-rewrite
  --eliminate-dead-code-aggressive --redundancy-elimination --eliminate-dead-code-aggressive --merge-blocks)

# limpid_shaders(TARGET a/b.comp ... [WORDS_ONLY c.vert ...] [UNOPTIMISED a/b.comp ...]): compiles shaders below the current
# folder and embeds each in TARGET as `limpid::shaders::b_comp` (gpu/graph/shader.h: ShaderCode), declared in the generated
# header "b.comp.h". Of those after WORDS_ONLY, which the frame graph cannot use, only the SPIR-V is embedded
# (std::span<const uint32_t>); of those after UNOPTIMISED, names of others, the SPIR-V is stripped, and not optimised.
#
# glslc -g without -O writes shaders/b.comp.spv, which has the names that the frame graph binds by; limpid_reflect reads
# these, and what spirv-opt makes of the file is embedded.
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

# limpid_shader_variants(TARGET SUFFIX MACRO a/b.comp ...): compiles shaders once more, with MACRO defined, and embeds each as
# `limpid::shaders::b_SUFFIX_comp`. Its name is "a/b.comp -DMACRO".
function(limpid_shader_variants TARGET SUFFIX MACRO)
  foreach(SOURCE ${ARGN})
    limpid_shader(${TARGET} ${SOURCE} ${CMAKE_CURRENT_BINARY_DIR}/shaders shader "${LIMPID_SPIRV_PASSES}" ${SUFFIX} ${MACRO})
  endforeach()
endfunction()

# limpid_shader(TARGET SOURCE GENERATED KIND PASSES [SUFFIX MACRO]): one of them. KIND names the templates (cmake/KIND.h.in).
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

# limpid_shader_list(TARGET LIBRARY ...): adds to TARGET a list of all shaders of the libraries with the SPIR-V that they were
# made of: `limpid::shaders::listed()`, in the generated header "shader_list.h". For tests.
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

if(LIMPID_TESTS)
  add_custom_target(limpid_fast_tests)
endif()

# limpid_test(NAME SOURCES a_test.cpp ... DEPS ... [LABELS slow]): a GoogleTest program; every suite is a ctest test.
# The target limpid_fast_tests builds all that are not slow.
function(limpid_test NAME)
  cmake_parse_arguments(ARG "" "LABELS" "SOURCES;DEPS" ${ARGN})
  if(NOT LIMPID_TESTS)
    return()
  endif()
  if(NOT ARG_LABELS)
    set(ARG_LABELS fast)
  endif()
  add_executable(${NAME} ${ARG_SOURCES})
  target_link_libraries(${NAME} PRIVATE limpid_options ${ARG_DEPS} GTest::gmock_main GTest::gtest)
  target_include_directories(${NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${NAME} PRIVATE LIMPID_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  limpid_use_pch(${NAME} limpid_test_pch)
  limpid_unity(${NAME})
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
