// The kernel of an a-trous filter: a B3 spline (H. Dammertz et al., "Edge-Avoiding A-Trous Wavelet Transform for fast
// Global Illumination Filtering", HPG 2010).
const float B3[3] = float[3](6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0);

/// The weight of a tap, whose offset `from` is in steps.
float splineWeight(ivec2 from) {
    return B3[abs(from.x)] * B3[abs(from.y)];
}

/// The including shader declares `params` with width and height beforehand.
bool inPicture(ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(params.width, params.height)));
}
