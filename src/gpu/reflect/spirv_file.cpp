#include "gpu/reflect/spirv_file.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"

namespace limpid::gpu {

std::vector<uint32_t> readSpirv(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream.is_open() || stream.bad()) throw Error(file.string() + ": cannot be read");
    if (bytes.empty() || bytes.size() % sizeof(uint32_t) != 0)
        throw Error(file.string() + ": is no SPIR-V: " + std::to_string(bytes.size()) + " bytes");
    std::vector<uint32_t> words(bytes.size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.data(), bytes.size());
    return words;
}

}  // namespace limpid::gpu
