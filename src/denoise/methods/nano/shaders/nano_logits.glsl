// The last layer at a level: for both signals, the logarithms of the weights of taps. `params` and `weights` are
// declared beforehand, `inputs`, the channels of the level, and PIXELS, how many pixels share loads of the weights.
#ifndef LIMPID_NANO_LOGITS_GLSL
#define LIMPID_NANO_LOGITS_GLSL

/// Eight logits of each pixel.
struct LogitsOfPixels {
    Eight values[PIXELS];
};

/// `pixels`: their indices; `group` counts the logits of the first signal, then those of the second.
LogitsOfPixels logitsOf(uint pixels[PIXELS], uint group) {
    const uint all = 2u * params.logitGroups;
    const Eight bias = unpackEight(LOAD_WEIGHTS(weights, params.weights + group));
    LogitsOfPixels sums;
    [[unroll]] for (int p = 0; p < PIXELS; ++p) sums.values[p] = bias;
    uint at = params.weights + all + 8u * group;
    for (uint g = 0u; g < params.groups; ++g, at += 8u * all) {
        Eight x[PIXELS];
        [[unroll]] for (int p = 0; p < PIXELS; ++p)
            x[p] = unpackEight(inputs.texels[pixels[p] * params.groups + g]);
        [[unroll]] for (int i = 0; i < 8; ++i) {
            const Eight w = unpackEight(LOAD_WEIGHTS(weights, at + uint(i)));
            [[unroll]] for (int p = 0; p < PIXELS; ++p) addProduct(sums.values[p], valueOf(x[p], i), w);
        }
    }
    return sums;
}

/// The logit of this number among those of a signal.
float logitOf(Eight logits, int number) {
    return valueOf(logits, number % 8);
}

#endif
