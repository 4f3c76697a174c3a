#include "lab/dataset/dataset_night.h"

#include <algorithm>
#include <vector>

#include "lab/dataset/dataset_random.h"
#include "lab/dataset/dataset_things.h"

namespace limpid::cli {
namespace {

class Night {
  public:
    Night(scene::Scene& scene, uint32_t seed) : scene_(scene), random_(seed), things_(thingsOf(scene)) {}

    void make() {
        const float factor = random_.logarithmic(0.01f, 0.2f);
        const size_t kept = random_.chance(0.5f) ? 1 : 2;
        std::vector<Thing> lamps;
        for (const Thing& thing : things_)
            if (shines(scene_, thing)) lamps.push_back(thing);
        const bool hasLamps = !lamps.empty();
        for (size_t i = 0; i < kept && !lamps.empty(); ++i)
            lamps.erase(lamps.begin() + static_cast<std::ptrdiff_t>(random_.index(lamps.size())));
        for (const Thing& lamp : lamps) dim(lamp, factor);
        for (scene::PunctualLight& light : scene_.lights)
            if (light.kind == scene::PunctualLight::Kind::Directional) light.intensity *= factor;
        for (vec3& radiance : scene_.environment.radiance) radiance *= factor;
        for (size_t i = 0; i < kept && !hasLamps; ++i) addLight();
    }

  private:
    void dim(const Thing& lamp, float factor) {
        for (const size_t i : lamp.lights) scene_.lights[i].intensity *= factor;
        for (const size_t i : lamp.instances) {
            scene::Instance& instance = scene_.instances[i];
            if (!isLamp(scene_, instance)) continue;
            scene_.materials[static_cast<size_t>(instance.material)].emission *= factor;
        }
    }

    /// Near one of the things.
    void addLight() {
        const float size = sizeOf(scene_, things_);
        scene::PunctualLight light;
        light.name = "night light";
        if (!things_.empty()) {
            const Thing& thing = things_[random_.index(things_.size())];
            vec3 away = random_.direction();
            if (surroundingsOf(scene_)) away.y = std::abs(away.y);
            const vec3 place = thing.center() + (thing.radius() + random_.between(0.05f, 0.6f) * size) * away;
            light.position = withinWalls(scene_, place, vec3(0.005f * size), thing.center());
        }
        const float strength = random_.logarithmic(0.1f, 1.5f);
        const float warmth = random_.between(0.0f, 1.0f);
        light.intensity =
            strength * size * size * glm::mix(vec3(1.0f, 0.5f, 0.2f), vec3(1.0f, 0.8f, 0.6f), warmth);
        scene_.lights.push_back(light);
    }

    scene::Scene& scene_;
    ClipRandom random_;
    std::vector<Thing> things_;
};

}  // namespace

void makeNight(scene::Scene& scene, uint32_t seed) {
    Night(scene, seed).make();
}

}  // namespace limpid::cli
