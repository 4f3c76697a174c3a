// Compares the kernel-predicting network with PyTorch (training/limpid_training/fixture.py), and tests what
// every denoiser must satisfy.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "denoise/kpcn/kpcn_params.h"
#include "neural/tensor_file.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

using denoise::KpcnNetwork;
using denoise::KpcnPrecision;
using denoise::KpcnWeights;
using neural::TensorFile;

const std::string dataFolder = std::string(LIMPID_SOURCE_DIR) + "/tests/data/";

KpcnWeights weightsOf(const std::string& network) {
    KpcnWeights weights = denoise::readKpcnWeights(
        network == "shipped" ? std::string(LIMPID_SOURCE_DIR) + "/weights/kpcn.safetensors"
                             : dataFolder + "kpcn_small.safetensors");
    if (network == "anywhere") weights.facing = -2.0f;
    if (network == "linear") weights.logarithmicDiffuse = false;
    return weights;
}

/// A network with random weights.
KpcnWeights randomWeights(uint32_t hidden, uint32_t channels, uint32_t width) {
    std::mt19937 generator(7);
    KpcnWeights weights{width, {}};
    for (auto& side : weights.sides) {
        uint32_t inputs = denoise::KPCN_INPUT_CHANNELS;
        for (uint32_t i = 0; i <= hidden; ++i) {
            const uint32_t outputs = i < hidden ? channels : width * width;
            const double spread = std::sqrt(2.0 / (25.0 * inputs));
            std::normal_distribution<float> normal(0.0f, static_cast<float>(spread));
            denoise::KpcnLayer layer{inputs, outputs, std::vector<float>(size_t{25} * inputs * outputs),
                                     std::vector<float>(outputs)};
            for (float& w : layer.weights) w = normal(generator);
            for (float& b : layer.bias) b = normal(generator);
            side.push_back(layer);
            inputs = channels;
        }
    }
    return weights;
}

/// Converts tensors (channels, rows, columns) to four floats per pixel.
std::vector<float> pixelsOf(const TensorFile& file, const std::string& name, const std::string& fourth) {
    const neural::Tensor& tensor = file.tensors.at(name);
    const std::vector<float> values = neural::valuesOf(tensor);
    const size_t pixels = tensor.shape[1] * tensor.shape[2];
    std::vector<float> result(4 * pixels);
    for (size_t c = 0; c < tensor.shape[0]; ++c) {
        for (size_t p = 0; p < pixels; ++p) result[4 * p + c] = values[c * pixels + p];
    }
    if (fourth.empty()) return result;
    const std::vector<float> variances = neural::valuesOf(file.tensors.at(fourth));
    for (size_t p = 0; p < pixels; ++p) result[4 * p + 3] = variances[p];
    return result;
}

HostFrame frameOf(const TensorFile& file, const std::string& name) {
    const std::vector<uint64_t>& shape = file.tensors.at(name + "/depth").shape;
    HostFrame frame;
    frame.height = static_cast<uint32_t>(shape[1]);
    frame.width = static_cast<uint32_t>(shape[2]);
    const auto pixels = [&](const std::string& layer) {
        return pixelsOf(file, name + "/" + layer, name + "/" + layer + ".variance");
    };
    frame.diffuse = pixels("diffuse");
    frame.specular = pixels("specular");
    frame.albedo = pixels("albedo");
    frame.normal = pixels("normal");
    frame.depth = pixels("depth");
    for (size_t p = 0; p < frame.pixelCount(); ++p)
        frame.depth[4 * p + 1] = frame.depth[4 * p] > 0 ? 1.0f : 0.0f;
    frame.emission.assign(4 * frame.pixelCount(), 0.0f);
    frame.motion = frame.previousNormal = frame.emission;
    frame.ids.assign(2 * frame.pixelCount(), 0);
    frame.samples = 2;
    return frame;
}

bool single(KpcnPrecision precision) {
    return precision == KpcnPrecision::Float || precision == KpcnPrecision::Host;
}

/// Returns the fourth of the four floats of each pixel.
std::vector<float> alphaOf(const std::vector<float>& texels) {
    std::vector<float> result;
    for (size_t i = 3; i < texels.size(); i += 4) result.push_back(texels[i]);
    return result;
}

/// Returns the root of the summed squared differences over that of the squares. `texels`: skips alpha.
double relativeError(const std::vector<float>& picture, const std::vector<float>& truth, bool texels = true) {
    double differences = 0.0, squares = 0.0;
    for (size_t i = 0; i < truth.size(); ++i) {
        if (texels && i % 4 == 3) continue;
        differences += std::pow(double{picture[i]} - double{truth[i]}, 2);
        squares += std::pow(double{truth[i]}, 2);
    }
    return std::sqrt(differences / squares);
}

/// Returns the largest difference of a pixel, relative to its value plus a tenth of the mean.
double largestError(const std::vector<float>& picture, const std::vector<float>& truth) {
    double mean = 0.0, largest = 0.0;
    for (const float value : truth) mean += std::abs(double{value}) / static_cast<double>(truth.size());
    for (size_t i = 0; i < truth.size(); ++i) {
        if (i % 4 == 3) continue;
        const double difference = std::abs(double{picture[i]} - double{truth[i]});
        largest = std::max(largest, difference / (std::abs(double{truth[i]}) + 0.1 * mean));
    }
    return largest;
}

class KpcnTest : public DenoiseTest {
  protected:
    static const denoise::Denoiser& method() { return *denoise::findDenoiser("kpcn"); }

    /// Uses this network from now on.
    DenoiserSettings settingsWith(const KpcnWeights& weights, KpcnPrecision precision, int tile = 512) {
        DenoiserSettings settings;
        settings.kpcn.standardErrors = 0.0f;  // only the network
        settings.kpcn.levels = 0;
        settings.kpcn.tile = tile;
        networks_.kpcn = std::make_shared<KpcnNetwork>(device(), weights, precision);
        return settings;
    }
    /// Settings with all steps after the network.
    DenoiserSettings smallSettings() {
        DenoiserSettings settings =
            settingsWith(randomWeights(1, 7, 5), denoise::kpcnPrecision(device().info(), true));
        settings.kpcn.levels = denoise::KpcnSettings{}.levels;
        settings.kpcn.standardErrors = denoise::KpcnSettings{}.standardErrors;
        return settings;
    }
    gpu::ImageHandle sideOf(const std::string& side, KpcnPrecision precision) {
        const std::string step = precision == KpcnPrecision::Host ? " layers" : " kernel";
        return written("kpcn/" + side + step, "kpcn/" + side);
    }
    std::vector<KpcnPrecision> precisions() {
        std::vector<KpcnPrecision> all{KpcnPrecision::Float, KpcnPrecision::Half};
        if (device().info().cooperativeMatrices) all.push_back(KpcnPrecision::Matrices);
        if (device().isCpu() && denoise::kpcnHostAvailable()) all.push_back(KpcnPrecision::Host);
        return all;
    }
};

TEST_F(KpcnTest, IsWhatPyTorchComputes) {
    const TensorFile cases = neural::readTensorFile(dataFolder + "kpcn_cases.safetensors");
    for (const std::string name : {"small", "shipped", "anywhere", "linear"}) {
        const HostFrame frame = frameOf(cases, name);
        const std::vector<float> truth = pixelsOf(cases, name + "/clean", "");
        for (const KpcnPrecision precision : precisions()) {
            const double most = single(precision) ? 1e-3 : 1e-2;
            const std::vector<float> picture =
                denoise(method(), frame, settingsWith(weightsOf(name), precision));
            const std::string what = name + ", " + std::string(denoise::toString(precision));
            RecordProperty(what, std::to_string(relativeError(picture, truth)));
            EXPECT_LT(relativeError(picture, truth), most) << what;
            EXPECT_LT(largestError(picture, truth), 3 * most) << what;
            for (size_t side = 0; side < 2; ++side) {
                const std::string which = side == 0 ? "diffuse" : "specular";
                const std::vector<float> clean = graph_.downloadFloat(device(), sideOf(which, precision));
                EXPECT_LT(relativeError(clean, pixelsOf(cases, name + "/" + which + ".clean", "")), most)
                    << what;
                const std::vector<float> deviations =
                    neural::valuesOf(cases.tensors.at(name + "/" + which + ".deviation"));
                EXPECT_LT(relativeError(alphaOf(clean), deviations, false), most) << what;
            }
        }
    }
}

/// One level of the filter after the kernels, by the formula of docs/kpcn.md in double precision.
class DoubleLevel {
  public:
    DoubleLevel(const HostFrame& frame, bool specular, int step, double phiColor)
        : frame_(frame), specular_(specular), step_(step), phiColor_(phiColor) {}

    /// `clean`: light and deviation per texel.
    std::vector<dvec4> operator()(const std::vector<dvec4>& clean) const {
        std::vector<dvec4> result;
        for (int y = 0; y < static_cast<int>(frame_.height); ++y) {
            for (int x = 0; x < static_cast<int>(frame_.width); ++x) result.push_back(filtered(clean, x, y));
        }
        return result;
    }

  private:
    size_t at(int x, int y) const { return static_cast<size_t>(y) * frame_.width + static_cast<size_t>(x); }
    bool inside(int x, int y) const {
        return x >= 0 && y >= 0 && x < static_cast<int>(frame_.width) && y < static_cast<int>(frame_.height);
    }
    double distance(int x, int y) const { return double{frame_.depth[4 * at(x, y)]}; }
    dvec3 normal(int x, int y) const {
        const float* n = &frame_.normal[4 * at(x, y)];
        return glm::normalize(dvec3(n[0], n[1], n[2]));
    }
    dvec3 albedo(int x, int y) const {
        const float* a = &frame_.albedo[4 * at(x, y)];
        return dvec3(a[0], a[1], a[2]) + 0.00316;
    }
    /// Returns the luminance of the light at (x, y).
    double luminance(dvec3 light, int x, int y) const {
        const dvec3 weights(0.2126, 0.7152, 0.0722);
        if (specular_) return glm::dot(light, weights);
        return glm::dot(light * albedo(x, y), weights) / glm::dot(albedo(x, y), weights);
    }

    double slope(int x, int y, int dx, int dy) const {
        const bool ends = !inside(x + dx, y + dy), begins = !inside(x - dx, y - dy);
        if (ends && begins) return 0.0;
        const double after = ends ? 0.0 : distance(x + dx, y + dy) - distance(x, y);
        const double before = begins ? 0.0 : distance(x, y) - distance(x - dx, y - dy);
        if (ends || begins) return ends ? before : after;
        return std::abs(after) < std::abs(before) ? after : before;
    }
    double surfaceWeight(int x, int y, int dx, int dy) const {
        const double here = distance(x, y), there = distance(x + dx, y + dy);
        if ((here > 0.0) != (there > 0.0)) return 0.0;
        if (here <= 0.0) return 1.0;
        const double expected = here + dx * slope(x, y, 1, 0) + dy * slope(x, y, 0, 1);
        const double bend = 1.0 - glm::dot(normal(x, y), normal(x + dx, y + dy));
        const dvec3 colors = (albedo(x + dx, y + dy) - albedo(x, y)) / (0.05 * albedo(x, y));
        return std::exp(-std::pow((there - expected) / (0.005 * here), 2.0) - 64.0 * bend -
                        glm::dot(colors, colors));
    }
    dvec4 filtered(const std::vector<dvec4>& clean, int x, int y) const {
        const double spline[] = {1.0 / 16, 4.0 / 16, 6.0 / 16, 4.0 / 16, 1.0 / 16};
        const dvec4 own = clean[at(x, y)];
        dvec3 sum(0.0);
        double weights = 0.0, squares = 0.0;
        for (int k = 0; k < 25; ++k) {
            const int dx = step_ * (k % 5 - 2), dy = step_ * (k / 5 - 2);
            if (!inside(x + dx, y + dy)) continue;
            const dvec4 other = clean[at(x + dx, y + dy)];
            const double apart = luminance(dvec3(other - own), x, y) / (phiColor_ * own.w + 1e-6);
            const double weight =
                spline[k % 5] * spline[k / 5] * surfaceWeight(x, y, dx, dy) * std::exp(-apart * apart);
            sum += weight * dvec3(other);
            weights += weight;
            squares += weight * weight * other.w * other.w;
        }
        return {sum / weights, std::sqrt(squares) / weights};
    }

    const HostFrame& frame_;
    bool specular_;
    int step_;
    double phiColor_;
};

/// Repeats `frame` to the right and downwards.
HostFrame repeated(const HostFrame& frame, uint32_t across, uint32_t down) {
    HostFrame result = frame;
    result.width *= across;
    result.height *= down;
    const auto repeat = [&](std::vector<float> HostFrame::*layer) {
        std::vector<float>& pixels = result.*layer;
        pixels.clear();
        for (uint32_t y = 0; y < result.height; ++y) {
            const auto row = (frame.*layer).begin() + std::ptrdiff_t{4} * (y % frame.height) * frame.width;
            for (uint32_t i = 0; i < across; ++i)
                pixels.insert(pixels.end(), row, row + std::ptrdiff_t{4} * frame.width);
        }
    };
    for (const auto layer :
         {&HostFrame::diffuse, &HostFrame::specular, &HostFrame::albedo, &HostFrame::normal,
          &HostFrame::depth, &HostFrame::emission, &HostFrame::motion, &HostFrame::previousNormal})
        repeat(layer);
    result.ids.assign(2 * result.pixelCount(), 0);
    return result;
}

TEST_F(KpcnTest, LevelsAgreeWithDoublePrecision) {
    // 90x111 pixels: the fourth level is skipped, because its taps are further apart than a tenth of an edge.
    const HostFrame frame =
        repeated(frameOf(neural::readTensorFile(dataFolder + "kpcn_cases.safetensors"), "small"), 2, 3);
    const std::vector<int> steps{8, 2, 1};
    for (const KpcnPrecision precision : precisions()) {
        DenoiserSettings settings = settingsWith(weightsOf("small"), precision);
        settings.kpcn.levels = 4;
        settings.kpcn.phiColor = 1.5f;
        denoise(method(), frame, settings);
        for (const std::string side : {"diffuse", "specular"}) {
            std::vector<dvec4> before = download(sideOf(side, precision));
            for (size_t i = 0; i < steps.size(); ++i) {
                const std::string pass = "kpcn/" + side + " level " + std::to_string(i + 1);
                const std::vector<dvec4> after = download(pass, pass);
                const std::vector<dvec4> truth =
                    DoubleLevel(frame, side == "specular", steps[i], 1.5)(before);
                double moved = 0.0;
                for (size_t p = 0; p < truth.size(); ++p) {
                    moved += glm::length(truth[p] - before[p]) / static_cast<double>(truth.size());
                    for (int c = 0; c < 4; ++c)
                        ASSERT_NEAR(after[p][c], truth[p][c], 1e-4 * (std::abs(truth[p][c]) + 0.01))
                            << pass << ", pixel " << p << ", " << denoise::toString(precision);
                }
                EXPECT_GT(moved, 1e-3) << pass;
                before = after;
            }
        }
    }
}

/// Limits the network's light by the formula of docs/kpcn.md in double precision.
TEST_F(KpcnTest, LightStaysNearWhatTheSamplesAreSureOf) {
    const TensorFile cases = neural::readTensorFile(dataFolder + "kpcn_cases.safetensors");
    HostFrame frame = frameOf(cases, "small");
    frame.samples = 9;  // with fewer than 8, nothing is changed
    for (std::vector<float>* layer :
         {&frame.diffuse, &frame.specular, &frame.albedo, &frame.normal, &frame.depth}) {
        for (size_t i = 3; i < layer->size(); i += 4)
            (*layer)[i] *= 8.0f;  // from variances of means to deviations
    }
    const KpcnPrecision precision = denoise::kpcnPrecision(device().info(), true);
    DenoiserSettings settings = settingsWith(weightsOf("small"), precision);
    settings.kpcn.standardErrors = 1.5f;
    const std::vector<float> picture = denoise(method(), frame, settings);
    const std::vector<float> diffuse = graph_.downloadFloat(device(), sideOf("diffuse", precision)),
                             specular = graph_.downloadFloat(device(), sideOf("specular", precision));
    // By pixel and side: the fraction of the way to the noisy light, positive if that is darker.
    const auto lights = [&](size_t at, int side) {
        dvec3 clean, noisy;
        for (int c = 0; c < 3; ++c) {
            const size_t i = at + static_cast<size_t>(c);
            clean[c] = side == 0 ? diffuse[i] * (frame.albedo[i] + 0.00316) : std::exp(specular[i]) - 1.0;
            noisy[c] = side == 0 ? frame.diffuse[i] : frame.specular[i];
        }
        return std::pair(clean, noisy);
    };
    const auto wanted = [&](size_t at, int side) {
        const auto [clean, noisy] = lights(at, side);
        const double apart = glm::dot(clean - noisy, dvec3(0.2126, 0.7152, 0.0722));
        const double variance = (side == 0 ? frame.diffuse : frame.specular)[at + 3] / 8.0;
        const double share = 1.0 - 1.5 * std::sqrt(variance) / std::abs(apart);
        return share > 0.0 ? std::copysign(share, apart) : 0.0;
    };
    const int width = static_cast<int>(frame.width), height = static_cast<int>(frame.height);
    const auto texelOf = [&](int x, int y) { return 4 * static_cast<size_t>(y * width + x); };
    int moved = 0, heldBack = 0;
    const auto scattered = [&](int x, int y, int side) {
        const auto [clean, noisy] = lights(texelOf(x, y), side);
        const double own = wanted(texelOf(x, y), side);
        double around = 0.0;
        for (int k = 0; k < 9; ++k) {
            const int i = x + k % 3 - 1, j = y + k / 3 - 1;
            if (k == 4 || i < 0 || j < 0 || i >= width || j >= height) continue;
            const double other = wanted(texelOf(i, j), side);
            if (other * own > 0.0) around = std::max(around, std::abs(other));
        }
        moved += own != 0.0;
        heldBack += around < std::abs(own);
        return clean + (noisy - clean) * std::min(std::abs(own), around);
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const dvec3 truth = scattered(x, y, 0) + scattered(x, y, 1);
            const float* const texel = &picture[texelOf(x, y)];
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(texel[c], truth[c], 1e-4 * (1.0 + truth[c])) << x << " " << y;
        }
    }
    const auto count = static_cast<int>(picture.size() / 2);
    EXPECT_GT(moved, count / 50);
    EXPECT_LT(moved, count * 9 / 10);
    EXPECT_GT(heldBack, moved / 50);
    EXPECT_LT(heldBack, moved / 2);
}

TEST_F(KpcnTest, TilesDoNotShow) {
    const TensorFile cases = neural::readTensorFile(dataFolder + "kpcn_cases.safetensors");
    const HostFrame frame = frameOf(cases, "small");
    for (const KpcnPrecision precision : precisions()) {
        const std::vector<float> whole =
            denoise(method(), frame, settingsWith(weightsOf("small"), precision));
        const std::vector<float> tiled =
            denoise(method(), frame, settingsWith(weightsOf("small"), precision, 16));
        EXPECT_EQ(whole, tiled) << denoise::toString(precision);
    }
}

/// Compares every precision with single precision, which is PyTorch's, for shapes whose channels do and do
/// not fill whole slabs.
TEST_F(KpcnTest, AnyShapeOfNetwork) {
    const HostFrame frame = SyntheticScene({}).frame(3, 41, 23, 1);
    for (const auto& [hidden, channels, width] :
         {std::tuple{1u, 1u, 3u}, {2u, 15u, 5u}, {1u, 16u, 21u}, {3u, 40u, 9u}}) {
        const KpcnWeights weights = randomWeights(hidden, channels, width);
        const std::vector<float> truth =
            denoise(method(), frame, settingsWith(weights, KpcnPrecision::Float));
        for (const KpcnPrecision precision : precisions())
            EXPECT_LT(relativeError(denoise(method(), frame, settingsWith(weights, precision, 32)), truth),
                      1e-2)
                << hidden << " " << channels << " " << width << " " << denoise::toString(precision);
    }
}

TEST_F(KpcnTest, AConstantImageStaysConstant) {
    HostFrame frame = frontalPlane(40, 30);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        for (size_t c = 0; c < 3; ++c)
            frame.diffuse[4 * p + c] = frame.specular[4 * p + c] = 0.25f * static_cast<float>(c + 1);
    }
    const std::vector<float> picture = denoise(method(), frame, smallSettings());
    for (size_t i = 0; i < picture.size(); ++i)
        ASSERT_NEAR(picture[i], i % 4 == 3 ? 1.0f : 0.5f * static_cast<float>(i % 4 + 1), 1e-4f) << i;
}

TEST_F(KpcnTest, AnySizeWorks) {
    const DenoiserSettings settings = smallSettings();
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {1u, 9u}, {9u, 1u}, {2u, 3u}, {17u, 5u}, {33u, 65u}}) {
        HostFrame frame = SyntheticScene({}).frame(1, width, height, 1);
        frame.samples = 9;
        const std::vector<float> picture = denoise(method(), frame, settings);
        ASSERT_EQ(picture.size(), size_t{4} * width * height);
        for (const float value : picture) ASSERT_TRUE(std::isfinite(value)) << width << "x" << height;
    }
}

TEST_F(KpcnTest, APixelAlwaysCountsItself) {
    KpcnWeights weights = randomWeights(1, 7, 5);
    weights.facing = 2.0f;  // no two normals are alike
    const HostFrame frame = SyntheticScene({}).frame(1, 41, 23, 1);
    std::vector<float> noisy = frame.diffuse;
    for (size_t i = 0; i < noisy.size(); ++i) noisy[i] += frame.specular[i] + frame.emission[i];
    for (const KpcnPrecision precision : precisions())
        EXPECT_LT(relativeError(denoise(method(), frame, settingsWith(weights, precision)), noisy), 1e-3)
            << denoise::toString(precision);
}

TEST_F(KpcnTest, NoNanGoesInOrComesOut) {
    const DenoiserSettings settings = smallSettings();
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                         -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::max()};
    HostFrame frame = SyntheticScene({}).frame(1, 48, 27, 1);
    frame.samples = 9;
    const float expected = medianOf(denoise(method(), frame, settings));
    size_t at = 5;
    for (auto* layer :
         {&frame.diffuse, &frame.specular, &frame.emission, &frame.albedo, &frame.normal, &frame.depth}) {
        for (const float value : bad) {
            if (layer == &frame.emission && value == bad[3]) continue;  // emission is not filtered
            for (size_t i = 0; i < 4; ++i) (*layer)[(at += 617) % layer->size()] = value;
        }
    }
    const std::vector<float> picture = denoise(method(), frame, settings);
    for (const float value : picture) ASSERT_TRUE(std::isfinite(value));
    ASSERT_GT(expected, 0.0f);
    EXPECT_NEAR(medianOf(picture), expected, 0.25f * expected) << "the rest of the picture stays";
}

TEST_F(KpcnTest, MemoryIsWhatTheTileSays) {
    DenoiserSettings settings = settingsWith(randomWeights(2, 100, 21), KpcnPrecision::Half, 64);
    settings.kpcn.levels = denoise::KpcnSettings{}.levels;
    gpu::FrameGraph graph;
    graph.beginFrame();
    denoise::DenoiserInput input = denoise::upload(graph, frontalPlane(300, 200));
    const size_t first = graph.passes().size();
    method().record(graph, input, settings, networks_);
    // A tile of 64x64 (60x50 rounded up), 10 pixels of the kernel around it and 16 at its end: 7 slabs of 32
    // bytes, twice, light of 16 and faces of 4. For the picture: distances, two sides, three levels of each
    // (the fourth would be too wide), scattered light, beauty; and the largest of 38x25, 5x4 and 1.
    const uint64_t buffers = uint64_t{64 + 20 + 16} * (64 + 20 + 16) * (2 * 7 * 32 + 16 + 4);
    const uint64_t images = uint64_t{300} * 200 * (4 + 10 * 16) + (38 * 25 + 5 * 4 + 1) * 4;
    EXPECT_EQ(graph.bytesOfImagesWrittenFrom(first), buffers + images);
}

TEST_F(KpcnTest, WithoutANetworkItSaysSo) {
    graph_.beginFrame();
    const denoise::DenoiserInput input = denoise::upload(graph_, frontalPlane(8, 8));
    EXPECT_THROW(method().record(graph_, input, {}, {}), Error);
}

}  // namespace
}  // namespace limpid::test
