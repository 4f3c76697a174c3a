// The functions of FlipRows. Included inside an anonymous namespace by files that are each compiled for one
// instruction set. Every function here must have internal linkage: otherwise the linker might use the AVX2
// version on a processor without AVX2. Names such as qc are those of the paper cited in
// image/metrics/metrics.h.

constexpr float colorExponent = 0.7f;    // qc
constexpr float colorKnee = 0.4f;        // pc: this fraction of the largest colour difference ...
constexpr float colorKneeValue = 0.95f;  // pt: ... maps to this error
/// The reference white of all colour spaces: linear RGB (1,1,1).
constexpr float whiteX = 23359437.0f / 24577794.0f, whiteZ = 80288407.0f / 73733382.0f;

void toneMap(const float* radiance, double scale, size_t count, float* __restrict mapped) {
    for (size_t i = 0; i < count; ++i) {
        const double exposed = scale * static_cast<double>(radiance[i]);
        // The curve is 1 long before the bound, which keeps the product a float.
        mapped[i] = filmicCurve(static_cast<float>(exposed < 1e30 ? exposed : 1e30));
    }
}

void toYcxcz(const float* rgb, size_t count, float* y, float* cx, float* cz) {
    for (size_t i = 0; i < count; ++i) {
        const float r = rgb[3 * i], g = rgb[3 * i + 1], b = rgb[3 * i + 2];
        const float nx = (10135552.0f * r + 8788810.0f * g + 4435075.0f * b) / 24577794.0f / whiteX;
        const float ny = (2613072.0f * r + 8788810.0f * g + 887015.0f * b) / 12288897.0f;
        const float nz = (1425312.0f * r + 8788810.0f * g + 70074185.0f * b) / 73733382.0f / whiteZ;
        y[i] = 116.0f * ny - 16.0f;
        cx[i] = 500.0f * (nx - ny);
        cz[i] = 200.0f * (ny - nz);
    }
}

[[gnu::always_inline]] inline float clamped(float v) {
    return v < 0.0f ? 0.0f : v > 1.0f ? 1.0f : v;
}

/// Returns first ? a : b, without a branch: the compiler only vectorises calls that are unconditional.
[[gnu::always_inline]] inline float chosen(bool first, float a, float b) {
    const float share = first ? 1.0f : 0.0f;
    return share * a + (1.0f - share) * b;
}

[[gnu::always_inline]] inline float labCurve(float t) {
    constexpr float delta = 6.0f / 29.0f;
    // The root is only used for larger t. The limit avoids cbrtf(0), which is slow.
    const float root = ::cbrtf(t > 0.008f ? t : 0.008f), line = t / (3.0f * delta * delta) + 4.0f / 29.0f;
    return chosen(t > delta * delta * delta, root, line);
}

struct Lab {
    float l, a, b;
};

/// Converts a filtered colour to CIELAB: clamps it to the display's gamut, and scales chroma by lightness
/// (Hunt effect).
[[gnu::always_inline]] inline Lab perceived(float luma, float cx, float cz) {
    const float y = (luma + 16.0f) / 116.0f;
    const float x = (y + cx / 500.0f) * whiteX, z = (y - cz / 200.0f) * whiteZ;
    const float r = clamped(3.241003275f * x - 1.537398934f * y - 0.498615861f * z);
    const float g = clamped(-0.969224334f * x + 1.875930071f * y + 0.041554224f * z);
    const float b = clamped(0.055639423f * x - 0.204011202f * y + 1.057148933f * z);
    const float fx = labCurve((10135552.0f * r + 8788810.0f * g + 4435075.0f * b) / 24577794.0f / whiteX);
    const float fy = labCurve((2613072.0f * r + 8788810.0f * g + 887015.0f * b) / 12288897.0f);
    const float fz = labCurve((1425312.0f * r + 8788810.0f * g + 70074185.0f * b) / 73733382.0f / whiteZ);
    const float lightness = 116.0f * fy - 16.0f;
    return {lightness, 0.01f * lightness * 500.0f * (fx - fy), 0.01f * lightness * 200.0f * (fy - fz)};
}

/// powf() with a minimum for the base, since it is slow at 0.
[[gnu::always_inline]] inline float power(float base, float exponent) {
    return ::powf(base > 1e-30f ? base : 1e-30f, exponent);
}

[[gnu::always_inline]] inline float distanceAt(const FlipRow& test, const FlipRow& reference, size_t i) {
    const Lab p = perceived(test.y[i], test.cx[i], test.cz[i]);
    const Lab q = perceived(reference.y[i], reference.cx[i], reference.cz[i]);
    const float l = p.l - q.l, a = p.a - q.a, b = p.b - q.b;
    return ::fabsf(l) + ::sqrtf(a * a + b * b);
}

void distances(const FlipRow& test, const FlipRow& reference, size_t count, float* __restrict distance) {
    for (size_t i = 0; i < count; ++i) distance[i] = power(distanceAt(test, reference, i), colorExponent);
}

/// Returns the difference of two gradient magnitudes. Gradients here are of Y, but the paper's are of Y /
/// 116.
[[gnu::always_inline]] inline float featureDifference(const float* testX, const float* testY,
                                                      const float* referenceX, const float* referenceY,
                                                      size_t i) {
    const float test = ::sqrtf(testX[i] * testX[i] + testY[i] * testY[i]);
    const float reference = ::sqrtf(referenceX[i] * referenceX[i] + referenceY[i] * referenceY[i]);
    return ::fabsf(test - reference) / 116.0f;
}

void errors(const FlipRow& test, const FlipRow& reference, float largest, size_t count,
            float* __restrict error) {
    const float knee = colorKnee * largest;
    for (size_t i = 0; i < count; ++i) {
        const float difference = distanceAt(test, reference, i);
        const float distance = power(difference, colorExponent);
        // Maps distances to [0,1], with most of that range for small ones.
        const float below = colorKneeValue / knee * distance;
        const float above = colorKneeValue + (distance - knee) / (largest - knee) * (1.0f - colorKneeValue);
        const float colorError = distance < knee ? below : above;
        const float edges = featureDifference(test.edgeX, test.edgeY, reference.edgeX, reference.edgeY, i);
        const float points =
            featureDifference(test.pointX, test.pointY, reference.pointX, reference.pointY, i);
        // The square root is the exponent qf = 1/2.
        const float featureError = ::sqrtf((edges > points ? edges : points) / std::numbers::sqrt2_v<float>);
        // Feature differences amplify colour differences.
        const float amplified = power(colorError, 1.0f - featureError);
        error[i] = chosen(difference > 0.0f, clamped(amplified), 0.0f);
    }
}

constexpr FlipRows tableWith(decltype(FlipRows::filter) filter) {
    return {toneMap, toYcxcz, filter, errors, distances};
}
