#include "scene/device/scene_data.h"

#include <algorithm>

#include "scene/device/pack.h"
#include "scene/device/run_both.h"

namespace limpid::scene {
namespace {

bool hasVertexData(const Scene& scene) {
    return std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& mesh) {
        return !mesh.normals.empty() || !mesh.uv0.empty() || !mesh.uv1.empty() || !mesh.colors.empty();
    });
}

void fillTexelsAndTables(const TexturePlaces& places, const Scene& scene, SceneData& data,
                         const Progress& progress) {
    fillTexels(places, scene, data, progress);
    if (data.features.specular) fillGgxTable(data.ggxTable);
    if (data.features.sheen) fillSheenTable(data.ggxTable);
    if (data.features.roughGlass) fillDielectricTable(data.dielectricTable);
}

template <typename Vector>
uint64_t bytesIn(const Vector& values) {
    return values.size() * sizeof(values[0]);
}

}  // namespace

size_t Scene::triangleCount() const {
    size_t count = 0;
    for (const Instance& instance : instances)
        count += meshes[static_cast<size_t>(instance.mesh)].triangleCount();
    return count;
}

uint64_t SceneData::byteCount() const {
    uint64_t sum = bytesIn(bvhTriangles) + bytesIn(environment) + bytesIn(ggxTable) + bytesIn(lightPyramid) +
                   bytesIn(environmentPyramid) + bytesIn(motion.morphDeltas) + bytesIn(lightDensity) +
                   bytesIn(dielectricTable) + bytesIn(triangles) + bytesIn(vertices);
    for (const auto* records : {&bvhNodes, &bvhInstances, &instances, &previousGeometry, &materials,
                                &textureRefs, &lights, &lightTree, &motion.restVertices}) {
        sum += bytesIn(*records);
    }
    for (const auto& buffer : texels) sum += bytesIn(buffer);
    return sum;
}

SceneData buildSceneData(const Scene& scene, const Progress& progress, std::optional<bool> hasLightTree) {
    SceneData data;
    data.features.vertexData = hasVertexData(scene);
    const TexturePlaces places = packMaterials(scene, data);
    runBoth([&] { fillTexelsAndTables(places, scene, data, progress.part(0.0, 0.3)); },
            [&] { packGeometry(scene, data, progress.part(0.0, 0.9)); });
    progress.at(0.9);
    packLights(scene, data, hasLightTree);
    return data;
}

}  // namespace limpid::scene
