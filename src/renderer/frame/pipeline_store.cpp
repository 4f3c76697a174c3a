#include "renderer/frame/pipeline_store.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "base/log.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t maxBytes = uint64_t{256} << 20;
/// A driver's header alone (VkPipelineCacheHeaderVersionOne).
constexpr size_t emptyBytes = 32;

uint64_t checksum(std::span<const std::byte> data) {
    Hash64 hash;
    hash.add(data);
    return hash.value();
}

fs::path cacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && fs::path(cache).is_absolute())
        return fs::path(cache) / "limpid";
    if (const char* home = std::getenv("HOME"); home && fs::path(home).is_absolute())
        return fs::path(home) / ".cache" / "limpid";
    return {};
}

}  // namespace

fs::path pipelineFile(const gpu::Device& device) {
    const fs::path folder = cacheFolder();
    if (folder.empty()) return {};
    Hash64 hash;
    for (const std::string& part : {device.info().name, device.info().driver, device.info().apiVersion}) {
        hash.add(part);
        hash.add("\n");
    }
    return folder / fmt::format("pipelines-{:016x}.bin", hash.value());
}

void loadPipelines(gpu::Device& device, const fs::path& file) {
    std::error_code error;
    if (file.empty() || !fs::is_regular_file(file, error)) return;
    try {
        const std::vector<std::byte> bytes = readFile(file, maxBytes);
        uint64_t expected = 0;
        if (bytes.size() <= sizeof(expected)) return;
        std::memcpy(&expected, bytes.data(), sizeof(expected));
        const std::span<const std::byte> data = std::span(bytes).subspan(sizeof(expected));
        // Drivers look at their header only: what follows must be whole.
        if (checksum(data) == expected) device.loadPipelineCache(data);
    } catch (const Error& fault) {
        log::debug("{}", fault.what());
    }
}

void storePipelines(const gpu::Device& device, const fs::path& file) {
    if (file.empty() || device.pipelineCount() == 0) return;
    try {
        const std::vector<std::byte> data = device.pipelineCacheData();
        if (data.size() <= emptyBytes) return;
        fs::create_directories(file.parent_path());
        writeAtomically(file, [&](const fs::path& temporary) {
            std::ofstream out(temporary, std::ios::binary);
            const uint64_t sum = checksum(data);
            out.write(reinterpret_cast<const char*>(&sum), sizeof(sum));
            out.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
            if (!out.flush()) throw OutputError(temporary, "cannot be written");
        });
    } catch (const std::exception& fault) {
        log::debug("{}", fault.what());
    }
}

}  // namespace limpid
