#include "denoise/nano_host/network_host.h"

#ifdef LIMPID_HAVE_ONEDNN
#include <tbb/task_arena.h>

#include <algorithm>
#include <list>
#include <mutex>

#include "denoise/nano_host/host_filter.h"
#include "denoise/nano_host/host_layers.h"
#endif

namespace limpid::denoise {

#ifndef LIMPID_HAVE_ONEDNN

NanoHost* networkHost() {
    return nullptr;
}

#else

namespace {

/// A network for tiles of one size.
struct Prepared {
    Prepared(const NanoNetwork& n, gpu::Extent e) : network(&n), extent(e), layers(n, e), filter(n, e) {}

    const NanoNetwork* network;
    gpu::Extent extent;
    HostLayers layers;
    HostFilter filter;
};

class OneDnnHost : public NanoHost {
  public:
    void run(const NanoNetwork& network, const NanoTile& tile, std::span<const uint16_t> channels,
             std::span<const uint16_t> light, std::span<float> result) override {
        const std::lock_guard lock(mutex_);
        Prepared& prepared = prepare(network, tile.extent);
        // While a thread waits in here for TBB, it must not begin a task that comes for the mutex, too.
        tbb::this_task_arena::isolate([&] {
            prepared.layers.run(channels);
            prepared.filter.run(prepared.layers, tile, light, result);
        });
    }

  private:
    Prepared& prepare(const NanoNetwork& network, gpu::Extent extent) {
        const auto found = std::ranges::find_if(
            kept_, [&](const Prepared& p) { return p.network == &network && p.extent == extent; });
        if (found != kept_.end()) {
            kept_.splice(kept_.begin(), kept_, found);
        } else {
            while (!kept_.empty() && bytes() + bytesOf(network, extent) > mostBytes) kept_.pop_back();
            kept_.emplace_front(network, extent);
        }
        return kept_.front();
    }

    static uint64_t bytesOf(const NanoNetwork& network, gpu::Extent extent) {
        return uint64_t{extent.width} * extent.height * bytesOfPixel(network) + bandBytes;
    }
    uint64_t bytes() const {
        uint64_t sum = 0;
        for (const Prepared& prepared : kept_) sum += bytesOf(*prepared.network, prepared.extent);
        return sum;
    }

    static constexpr uint64_t bandBytes = uint64_t{32} << 20;  ///< HostFilter's
    std::mutex mutex_;
    std::list<Prepared> kept_;  ///< the last one used first
};

}  // namespace

NanoHost* networkHost() {
    static OneDnnHost host;
    return &host;
}

#endif

}  // namespace limpid::denoise
