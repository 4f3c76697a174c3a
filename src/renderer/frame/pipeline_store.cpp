#include "renderer/frame/pipeline_store.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "base/log.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t maxBytes = uint64_t{256} << 20;
/// The size of a checksum and a driver's header (VkPipelineCacheHeaderVersionOne) without any pipelines.
constexpr size_t emptyBytes = 40;

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
        device.loadPipelineCache(readFile(file, maxBytes));
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
            out.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
            if (!out.flush()) throw OutputError(temporary, "cannot be written");
        });
    } catch (const std::exception& fault) {
        log::debug("{}", fault.what());
    }
}

}  // namespace limpid
