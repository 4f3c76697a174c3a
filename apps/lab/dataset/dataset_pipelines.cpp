#include "lab/dataset/dataset_pipelines.h"

namespace limpid::cli {
namespace {

/// The stack of a ray's walk through the trees has a multiple of this many entries.
constexpr uint32_t stackMultiple = 64;

/// A black one, of which no samples are taken where a light may reach.
void addEnvironment(scene::SceneData& data) {
    constexpr uint32_t width = 2, height = 2;
    data.features.environment = true;
    data.environment.assign(size_t{width} * height, vec4(0.0f));
    data.params.environmentWidth = width;
    data.params.environmentHeight = height;
    data.params.environmentScale = vec3(0.0f);
    data.params.environmentProbability =
        data.params.triangleLightCount + data.params.punctualCount > 0 ? 0.0f : 1.0f;
    data.params.environmentIsEven = 1;
}

}  // namespace

void generalise(scene::SceneData& data, bool lightsToo) {
    scene::SceneFeatures& features = data.features;
    data.stackSize = (data.stackSize + stackMultiple - 1) / stackMultiple * stackMultiple;
    if (features.specular) {
        features.textures = features.alpha = features.transmission = true;
        features.clearcoat = features.roughGlass = true;
    }
    if (!lightsToo) return;
    // Loops over no lights.
    features.punctualLights = features.suns = true;
    // Where there is nothing else, the environment takes all samples.
    if (data.params.punctualCount == 0) features.triangleLights = true;
    if (!features.environment) addEnvironment(data);
}

}  // namespace limpid::cli
