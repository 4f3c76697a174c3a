// As nano_logits.glsl, for the finest level. Declared beforehand: `finest`, `inputs`, and INPUT_GROUPS, the groups of
// channels.

/// Eight logits of each pixel.
struct LogitsOfPixels {
    Eight values[PIXELS];
};

/// Of eight logits the biases (row 0), or the weights of channel `row` - 1. Where all loops are unrolled, these are
/// operands of instructions, and need no loads.
Eight rowOfLogits(uint row, uint group) {
    const uint at = row * uint(NANO_FINEST_LOGITS) + 8u * group;
    return Eight(vec4(finest.logits[at], finest.logits[at + 1u], finest.logits[at + 2u], finest.logits[at + 3u]),
                 vec4(finest.logits[at + 4u], finest.logits[at + 5u], finest.logits[at + 6u], finest.logits[at + 7u]));
}

/// `pixels`: their indices; `group` counts the logits of the first signal, then those of the second.
LogitsOfPixels logitsOf(uint pixels[PIXELS], uint group) {
    const Eight biases = rowOfLogits(0u, group);
    LogitsOfPixels sums;
    [[unroll]] for (int p = 0; p < PIXELS; ++p) sums.values[p] = biases;
    [[unroll]] for (uint g = 0u; g < INPUT_GROUPS; ++g) {
        Eight x[PIXELS];
        [[unroll]] for (int p = 0; p < PIXELS; ++p) x[p] = unpackEight(inputs.texels[pixels[p] * INPUT_GROUPS + g]);
        [[unroll]] for (uint i = 0u; i < 8u; ++i) {
            const Eight w = rowOfLogits(1u + 8u * g + i, group);
            [[unroll]] for (int p = 0; p < PIXELS; ++p) addProduct(sums.values[p], valueOf(x[p], int(i)), w);
        }
    }
    return sums;
}

/// The logit of this number among those of a signal.
float logitOf(Eight logits, int number) {
    return valueOf(logits, number % 8);
}
