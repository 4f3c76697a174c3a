// The filters of FlipRows. Included inside an anonymous namespace by files that are each compiled for one
// instruction set.

/// Eight neighbouring values, which the compiler maps to vector instructions; to several narrower ones if the
/// instruction set has none of this width.
typedef float Lanes __attribute__((vector_size(32)));
constexpr size_t lanes = sizeof(Lanes) / sizeof(float), blocks = flipGroup / lanes;

/// The values are aligned like floats. (Vectors as arguments or results would depend on the instruction set.)
[[gnu::always_inline]] inline void load(const float* from, Lanes& to) {
    std::memcpy(&to, from, sizeof to);
}
[[gnu::always_inline]] inline void store(const Lanes& from, float* to) {
    std::memcpy(to, &from, sizeof from);
}

/// Filters one group of pixels. Sums stay in registers, and each neighbour is loaded once for all filters.
template <size_t evens, bool odd>
[[gnu::always_inline]] inline void filterGroup(const float* in, ptrdiff_t step, const FlipFilters& f,
                                               size_t x) {
    Lanes twice[blocks], even[evens][blocks], difference[blocks] = {};
    for (size_t b = 0; b < blocks; ++b) {
        Lanes middle;
        load(in + x + b * lanes, middle);
        twice[b] = 2.0f * middle;
        for (size_t e = 0; e < evens; ++e) even[e][b] = f.even[e].middle * middle;
    }
    for (size_t k = 0; k < f.reach; ++k) {
        const ptrdiff_t offset = static_cast<ptrdiff_t>(k + 1) * step;
        for (size_t b = 0; b < blocks; ++b) {
            const float* const middle = in + x + b * lanes;
            Lanes after, before;
            load(middle + offset, after);
            load(middle - offset, before);
            const Lanes bend = after + before - twice[b];
            for (size_t e = 0; e < evens; ++e) even[e][b] += f.even[e].weights[k] * bend;
            if constexpr (odd) difference[b] += f.odd.weights[k] * (after - before);
        }
    }
    for (size_t b = 0; b < blocks; ++b) {
        const size_t to = x + b * lanes;
        for (size_t e = 0; e < evens; ++e) store(even[e][b], f.even[e].result + to);
        if constexpr (odd) store(difference[b], f.odd.result + to);
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
