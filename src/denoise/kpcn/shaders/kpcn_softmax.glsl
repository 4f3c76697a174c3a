// A mean weighted by a softmax, of weights that come one after the other: M. Milakov, N. Gimelshein, "Online normalizer
// calculation for softmax", 2018.
struct WeightedMean {
    vec3 sum;
    float weights;
    float squares;  // of weighted variances
    float largest;
};

const WeightedMean NO_MEAN = WeightedMean(vec3(0.0), 0.0, 0.0, -1e30);

/// `value`: light, and its variance.
void add(inout WeightedMean mean, float logit, vec4 value) {
    if (logit > mean.largest) {
        const float shrink = exp(mean.largest - logit);
        mean.sum *= shrink;
        mean.weights *= shrink;
        mean.squares *= shrink * shrink;
        mean.largest = logit;
    }
    const float weight = exp(logit - mean.largest);
    mean.sum += weight * value.rgb;
    mean.weights += weight;
    mean.squares += weight * weight * value.a;
}

/// And its deviation.
vec4 resultOf(WeightedMean mean) {
    return vec4(mean.sum, sqrt(mean.squares)) / mean.weights;
}

/// The `channel`-th tap of a kernel around `pixel`, if there is one and it lies in the picture.
bool kernelTap(KpcnLayerParams params, ivec2 pixel, uint channel, out ivec2 tap) {
    const uint width = params.kernelWidth;
    tap = pixel + ivec2(channel % width, channel / width) - int(width / 2u);
    return channel < width * width && inPicture(params.region, tap);
}

/// Whether they face the same way, or both nowhere: kpcn_features.comp packed them.
bool alike(KpcnLayerParams params, uint face, uint other) {
    return dot(unpackSnorm4x8(face), unpackSnorm4x8(other)) >= params.facing;
}
