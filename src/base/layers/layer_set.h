// Holds one value for each layer of a frame, such as its image on the device or its pixels in memory.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>

#include "base/layers/layer_table.h"

namespace limpid {

/// One member for each of frameLayers, with the layer's name: `set.depth`. Integer layers are a Uint, all
/// others a Float.
template <typename Float, typename Uint = Float>
struct LayerSet {
#define LIMPID_LAYER_MEMBER(layer, ...) \
    std::conditional_t<LayerInfo{__VA_ARGS__}.stored == Stored::Uint, Uint, Float> layer{};
    LIMPID_LAYERS(LIMPID_LAYER_MEMBER)
#undef LIMPID_LAYER_MEMBER

    /// Calls visit(layer, member) for each layer, in the table's order.
    template <typename Visit>
    void forEach(Visit&& visit) {
        visitAll(*this, visit);
    }
    template <typename Visit>
    void forEach(Visit&& visit) const {
        visitAll(*this, visit);
    }

    /// Returns the layer's member. Throws std::out_of_range unless `layer` is one of frameLayers and its
    /// member a Float.
    Float& operator[](const LayerInfo& layer) {
        return find(*this, layer);
    }
    const Float& operator[](const LayerInfo& layer) const {
        return find(*this, layer);
    }

  private:
    template <typename Self, typename Visit>
    static void visitAll(Self& self, Visit&& visit) {
        auto next = frameLayers.begin();
#define LIMPID_LAYER_VISIT(layer, ...) visit(*next++, self.layer);
        LIMPID_LAYERS(LIMPID_LAYER_VISIT)
#undef LIMPID_LAYER_VISIT
    }

    template <typename Self>
    static auto& find(Self& self, const LayerInfo& wanted) {
        using Member = std::conditional_t<std::is_const_v<Self>, const Float, Float>;
        Member* found = nullptr;
        visitAll(self, [&](const LayerInfo& layer, auto& member) {
            if constexpr (std::is_same_v<decltype(member), Member&>) {
                if (layer.index == wanted.index) found = &member;
            }
        });
        if (!found) throw std::out_of_range("no member for the layer " + std::string(wanted.name));
        return *found;
    }
};

}  // namespace limpid
