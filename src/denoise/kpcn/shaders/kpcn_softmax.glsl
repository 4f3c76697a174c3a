// A mean weighted by a softmax whose logits arrive one at a time: M. Milakov, N. Gimelshein, "Online normalizer
// calculation for softmax", 2018.
struct WeightedMean {
    vec3 sum;       // weighted light
    float weights;  // sum of the weights
    float squares;  // sum of squared weight times variance
    float largest;  // largest logit so far; weights are exp(logit - largest)
};

const WeightedMean NO_MEAN = WeightedMean(vec3(0.0), 0.0, 0.0, -1e30);

/// Adds a pixel to the mean. `value`: its light, and in alpha the light's variance.
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

/// Returns the mean, and in alpha its standard deviation.
vec4 resultOf(WeightedMean mean) {
    return vec4(mean.sum, sqrt(mean.squares)) / mean.weights;
}

/// Sets `tap` to the pixel that channel `channel` of the kernel around `pixel` belongs to. Returns false if the kernel
/// has no such channel, or if the tap lies outside the picture.
bool kernelTap(KpcnLayerParams params, ivec2 pixel, uint channel, out ivec2 tap) {
    const uint width = params.kernelWidth;
    tap = pixel + ivec2(channel % width, channel / width) - int(width / 2u);
    return channel < width * width && inPicture(params.region, tap);
}

/// Returns whether the pixel `tap` belongs to the mean of `pixel`: both have similar normals, or none. `face` and
/// `other` are theirs, packed by kpcn_features.comp. A pixel always counts itself: packed normals are not exactly of
/// length 1, and a mean of nothing would be NaN.
bool counts(KpcnLayerParams params, ivec2 pixel, ivec2 tap, uint face, uint other) {
    return tap == pixel || dot(unpackSnorm4x8(face), unpackSnorm4x8(other)) >= params.facing;
}
