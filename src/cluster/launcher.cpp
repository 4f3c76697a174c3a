#include "cluster/launcher.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "base/error.h"

namespace limpid::cluster {
namespace {

namespace fs = std::filesystem;

constexpr const char* moduleName = "limpid_mpi.so";

/// Beside the program, or where it is installed.
void* openModule(std::string& fault) {
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const fs::path& file : {folder / moduleName, folder / LIMPID_MODULES_FROM_PROGRAM / moduleName}) {
        if (!fs::exists(file, error)) continue;
        // MPI loads parts of itself that use its symbols.
        if (void* const module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL)) return module;
        fault = ::dlerror();
    }
    return nullptr;
}

}  // namespace

Launch findLaunch(const std::function<const char*(const char*)>& variable) {
    const auto number = [&](const char* name, int& value) {
        const char* const text = variable(name);
        if (text) value = std::atoi(text);
        return text != nullptr;
    };
    Launch launch;
    if (const char* const off = variable("LIMPID_MPI"); off && std::string(off) == "0") return launch;
    if (number("OMPI_COMM_WORLD_RANK", launch.rank)) {
        launch.launched = true;
        number("OMPI_COMM_WORLD_SIZE", launch.size);
    } else if (number("PMI_RANK", launch.rank)) {
        launch.launched = true;
        number("PMI_SIZE", launch.size);
    } else if (number("PMIX_RANK", launch.rank)) {
        launch.launched = true;
        number("SLURM_STEP_NUM_TASKS", launch.size);
    }
    return launch;
}

std::chrono::milliseconds patienceOf(const char* timeout) {
    const std::string_view text = timeout ? timeout : "";
    if (text.empty()) return std::chrono::minutes(10);
    double seconds = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    const bool isNumber = error == std::errc{} && end == text.data() + text.size();
    if (!isNumber || !(seconds >= 2.0 && seconds <= 1e9))
        throw UsageError(
            fmt::format("LIMPID_CLUSTER_TIMEOUT: '{}' is no number of seconds from 2 to 1e9", text));
    return std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000.0));
}

Transport& startTransport(const Launch& launch) {
    std::string fault;
    void* const module = openModule(fault);
    if (!module && !fault.empty()) throw Error("limpid_mpi.so cannot be loaded: " + fault);
    if (!module) {
        throw Error(
            "a launcher such as mpirun started this program, but its part for that is absent, and each "
            "process would "
            "do all of the work: install the Debian package 'limpid-mpi', or build with libopenmpi-dev; or "
            "set "
            "LIMPID_MPI=0 if each process is to work for itself");
    }
    const auto start = reinterpret_cast<StartTransport>(::dlsym(module, "limpid_transport"));
    const char* reason = "is no module of Limpid";
    Transport* const transport = start ? start(LIMPID_VERSION, &reason) : nullptr;
    if (!transport) throw Error(fmt::format("limpid_mpi.so: {}", reason));
    if (launch.size > 0 && transport->place().size != launch.size) {
        throw Error(
            fmt::format("the launcher started {} processes, but MPI finds {}: it is another MPI than "
                        "limpid_mpi.so was built with",
                        launch.size, transport->place().size));
    }
    return *transport;
}

}  // namespace limpid::cluster
