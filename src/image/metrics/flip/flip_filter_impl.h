// The filters of FlipRows. Included inside an anonymous namespace by files that are each compiled for one
// instruction set.

/// Eight neighbouring values, which the compiler maps to vector instructions; to several narrower ones if the
/// instruction set has none of this width.
typedef float Lanes __attribute__((vector_size(32), aligned(4), may_alias));
constexpr size_t lanes = sizeof(Lanes) / sizeof(float), blocks = flipGroup / lanes;

/// Filters one group of pixels. Sums stay in registers, and each neighbour is loaded once for all filters.
template <size_t evens, bool odd>
[[gnu::always_inline]] inline void filterGroup(const float* in, ptrdiff_t step, const FlipFilters& f,
                                               size_t x) {
    const auto at = [in, x](size_t block, ptrdiff_t offset) -> const Lanes& {
        return *reinterpret_cast<const Lanes*>(in + x + block * lanes + offset);
    };
    Lanes twice[blocks], even[evens][blocks], difference[blocks] = {};
    for (size_t b = 0; b < blocks; ++b) {
        twice[b] = 2.0f * at(b, 0);
        for (size_t e = 0; e < evens; ++e) even[e][b] = f.even[e].middle * at(b, 0);
    }
    for (size_t k = 0; k < f.reach; ++k) {
        const ptrdiff_t offset = static_cast<ptrdiff_t>(k + 1) * step;
        for (size_t b = 0; b < blocks; ++b) {
            const Lanes after = at(b, offset), before = at(b, -offset), bend = after + before - twice[b];
            for (size_t e = 0; e < evens; ++e) even[e][b] += f.even[e].weights[k] * bend;
            if constexpr (odd) difference[b] += f.odd.weights[k] * (after - before);
        }
    }
    for (size_t b = 0; b < blocks; ++b) {
        const size_t to = x + b * lanes;
        for (size_t e = 0; e < evens; ++e) *reinterpret_cast<Lanes*>(f.even[e].result + to) = even[e][b];
        if constexpr (odd) *reinterpret_cast<Lanes*>(f.odd.result + to) = difference[b];
    }
}

template <size_t evens, bool odd>
void filterAll(const float* in, ptrdiff_t step, const FlipFilters& f, size_t count) {
    for (size_t x = 0; x < count; x += flipGroup) filterGroup<evens, odd>(in, step, f, x);
}

void filter(const float* in, ptrdiff_t step, const FlipFilters& f, size_t count) {
    using Function = void (*)(const float*, ptrdiff_t, const FlipFilters&, size_t);
    constexpr Function functions[FlipFilters::maxEvens][2] = {{filterAll<1, false>, filterAll<1, true>},
                                                              {filterAll<2, false>, filterAll<2, true>},
                                                              {filterAll<3, false>, filterAll<3, true>}};
    functions[f.evens - 1][f.odd.weights ? 1 : 0](in, step, f, count);
}
