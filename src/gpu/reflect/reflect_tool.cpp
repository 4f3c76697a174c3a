// limpid_reflect: converts a shader's SPIR-V to C++ (limpid_shaders(), cmake/LimpidTargets.cmake).
//
//     limpid_reflect NAME NAMED.spv EMBEDDED.spv OUT.inc    NAMED: output of glslc -g; it is reflected
//     limpid_reflect --words EMBEDDED.spv OUT.inc           the words only
//
// EMBEDDED is NAMED after optimising and stripping. Fails with exit code 1 and a message if a file cannot be
// read or written, or the shader uses features that Limpid does not support.
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "gpu/reflect/reflect.h"
#include "gpu/reflect/shader_hash.h"
#include "gpu/reflect/shader_table.h"
#include "gpu/reflect/spirv_file.h"

namespace limpid::gpu {
namespace {

std::ofstream opened(const std::string& path) {
    std::ofstream out(path);
    out << "// Written by limpid_reflect.\n";
    return out;
}

void closed(std::ofstream& out, const std::string& path) {
    out.close();
    if (!out) throw Error(path + ": cannot be written");
}

void embedWords(const std::string& embedded, const std::string& path) {
    const std::vector<uint32_t> words = readSpirv(embedded);
    std::ofstream out = opened(path);
    writeWords(out, words);
    closed(out, path);
}

void embed(const std::string& name, const std::string& named, const std::string& embedded,
           const std::string& path) {
    const std::shared_ptr<const ShaderCode> code = reflect(name, readSpirv(named));
    const std::vector<uint32_t> words = readSpirv(embedded);
    std::ofstream out = opened(path);
    writeWords(out, words);
    writeReflection(out, code->reflection);
    writeHash(out, hashOf(words, code->reflection));
    closed(out, path);
}

}  // namespace
}  // namespace limpid::gpu

int main(int count, char** values) {
    const std::vector<std::string> arguments(values + 1, values + count);
    try {
        if (arguments.size() == 3 && arguments[0] == "--words") {
            limpid::gpu::embedWords(arguments[1], arguments[2]);
        } else if (arguments.size() == 4) {
            limpid::gpu::embed(arguments[0], arguments[1], arguments[2], arguments[3]);
        } else {
            std::cerr << "limpid_reflect: see src/gpu/reflect/reflect_tool.cpp for its arguments\n";
            return 2;
        }
    } catch (const std::exception& fault) {
        std::cerr << "limpid_reflect: " << fault.what() << '\n';
        return 1;
    }
    return 0;
}
