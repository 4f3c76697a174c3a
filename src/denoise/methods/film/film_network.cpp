#include "denoise/methods/film/film_network.h"

#include "film.safetensors.h"

namespace limpid::denoise {
namespace {

constexpr NanoShares filmShares{.around = {{{.tiles = 3, .rows = 3},
                                            {.tiles = 3, .rows = 3},
                                            {.tiles = 4, .rows = 2},
                                            {.tiles = 4, .rows = 2},
                                            {.tiles = 2, .rows = 1}}},
                                .point = {{{.tiles = 3, .rows = 4, .small = true},
                                           {.tiles = 3, .rows = 4, .small = true},
                                           {.tiles = 2, .rows = 2, .small = true},
                                           {.tiles = 2, .rows = 1, .small = true},
                                           {}}},
                                .halve = {{{},
                                           {.tiles = 3, .rows = 4, .small = true},
                                           {.tiles = 2, .rows = 2, .small = true},
                                           {.tiles = 1, .rows = 1, .small = true},
                                           {.tiles = 1, .rows = 1, .small = true}}}};

}  // namespace

const NanoNetwork& filmNetwork() {
    static const NanoNetwork network =
        makeNanoNetwork("film", {.widths = {6, 12, 16, 16, 16}, .depths = {1, 2, 2, 2, 2}}, filmShares,
                        embedded::film_safetensors);
    return network;
}

}  // namespace limpid::denoise
