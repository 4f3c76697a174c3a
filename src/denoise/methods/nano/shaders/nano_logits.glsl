// The last layer at a level: for both signals, the logarithms of the weights of taps. `params` and `weights` are
// declared beforehand, and `inputs`, the channels of the level.
#ifndef LIMPID_NANO_LOGITS_GLSL
#define LIMPID_NANO_LOGITS_GLSL

/// Eight logits of the pixel with this index; `group` counts those of the first signal, then those of the second.
Eight logitsOf(uint pixel, uint group) {
    const uint all = 2u * params.logitGroups;
    Eight sum = unpackEight(weights.texels[params.weights + group]);
    uint at = params.weights + all + 8u * group;
    for (uint g = 0u; g < params.groups; ++g, at += 8u * all) {
        const Eight x = unpackEight(inputs.texels[pixel * params.groups + g]);
        [[unroll]] for (int i = 0; i < 8; ++i)
            addProduct(sum, valueOf(x, i), unpackEight(weights.texels[at + uint(i)]));
    }
    return sum;
}

/// The logit of this number among those of a signal.
float logitOf(Eight logits, int number) {
    return valueOf(logits, number % 8);
}

#endif
