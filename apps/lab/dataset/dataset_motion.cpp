#include "lab/dataset/dataset_motion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <utility>

#include "lab/dataset/dataset_random.h"
#include "lab/dataset/dataset_things.h"
#include "scene/motion/movement.h"

namespace limpid::cli {
namespace {

using scene::AnimatedValue;
using scene::Interpolation;
using scene::none;

/// The rest, and the shares among those clips in which lights move or are switched.
constexpr float objectShare = 0.4f, lightClips = 0.4f, lightShare = 0.5f, switchClips = 0.3f,
                switchShare = 0.4f;
/// A light that is off is that many sizes of the scene away.
constexpr float farAway = 1000.0f;

/// A thing or a sun, and what happens to it.
struct Part {
    Thing thing;
    int sun = none;  ///< of Scene::lights; otherwise it is the thing
    bool shines = false, moves = false, switched = false;
    bool goesOut = false;  ///< when it is switched; otherwise it goes on
};

scene::Channel channelOf(int node, AnimatedValue value, Interpolation interpolation) {
    const uint32_t components = value == AnimatedValue::Rotation ? 4 : 3;
    return {node, value, interpolation, components, {}, {}};
}

void addKey(scene::Channel& channel, float time, const vec3& value) {
    channel.times.push_back(time);
    channel.values.insert(channel.values.end(), {value.x, value.y, value.z});
}

void addKey(scene::Channel& channel, float time, const glm::quat& value) {
    channel.times.push_back(time);
    channel.values.insert(channel.values.end(), {value.x, value.y, value.z, value.w});
}

int addNode(scene::Rig& rig, const std::string& name, int parent, const vec3& translation = vec3(0.0f)) {
    const auto number = static_cast<int>(rig.nodes.size());
    scene::Node& node = rig.nodes.emplace_back();
    node.name = name;
    node.parent = parent;
    node.translation = translation;
    rig.order.push_back(number);
    return number;
}

class Mover {
  public:
    Mover(scene::Scene& scene, uint32_t seed, const SequenceTiming& timing,
          const std::vector<uint32_t>& frames)
        : scene_(scene),
          random_(seed),
          end_(static_cast<float>(timing.timeOf(frames.back() + 1))),
          surroundings_(surroundingsOf(scene)) {
        const std::vector<Thing> things = thingsOf(scene);
        size_ = sizeOf(scene, things);
        for (const Thing& thing : things) parts_.push_back({thing, none, shines(scene, thing)});
        for (size_t i = 0; i < scene.lights.size(); ++i)
            if (scene.lights[i].kind == scene::PunctualLight::Kind::Directional)
                parts_.push_back({{}, static_cast<int>(i), true});
        switchTime_ = switchTimeOf(timing, frames);
    }

    ClipMotion add() {
        choose();
        ClipMotion count;
        for (Part& part : parts_) {
            part.goesOut = part.switched && random_.chance(0.6f);
            count.objects += part.moves && !part.shines ? 1 : 0;
            count.lights += part.moves && part.shines ? 1 : 0;
            count.switched += part.switched ? 1 : 0;
            if (!part.moves && !part.switched) continue;
            if (part.sun == none)
                moveThing(part);
            else
                moveSun(part);
        }
        if (count.count() == 0) return count;
        clip_.name = "random";
        scene_.rig.clips.push_back(std::move(clip_));
        scene::chooseClip(scene_, "");
        return count;
    }

  private:
    /// At a random time between two stored frames, or before the only one; below 0 where there is none.
    float switchTimeOf(const SequenceTiming& timing, const std::vector<uint32_t>& frames) {
        const size_t last = frames.size() > 1 ? 1 + random_.index(frames.size() - 1) : 0;
        const double from = timing.timeOf(last > 0 ? frames[last - 1] : 0), to = timing.timeOf(frames[last]);
        const double share = double{random_.between(0.05f, 0.95f)};
        return to > from ? static_cast<float>(from + share * (to - from)) : -1.0f;
    }

    void choose() {
        const bool lightsMove = random_.chance(lightClips), switches = random_.chance(switchClips);
        std::vector<Part*> lights, switchable;
        for (Part& part : parts_) {
            if (!part.shines) {
                part.moves = random_.chance(objectShare);
                continue;
            }
            lights.push_back(&part);
            // Light from below meets the ground.
            if (part.sun == none || surroundings_) switchable.push_back(&part);
        }
        if (lightsMove) chooseSome(lights, lightShare, &Part::moves);
        if (switches && switchTime_ > 0.0f) chooseSwitched(lights, switchable);
        const bool still =
            std::ranges::none_of(parts_, [](const Part& part) { return part.moves || part.switched; });
        if (still && !parts_.empty()) parts_[random_.index(parts_.size())].moves = true;
    }

    void chooseSome(const std::vector<Part*>& from, float share, bool Part::*what) {
        if (from.empty()) return;
        for (Part* part : from) part->*what = random_.chance(share);
        from[random_.index(from.size())]->*what = true;
    }

    /// Something stays lit.
    void chooseSwitched(const std::vector<Part*>& lights, std::vector<Part*> switchable) {
        if (scene_.environment.empty() && switchable.size() == lights.size() && !switchable.empty())
            switchable.erase(switchable.begin() +
                             static_cast<std::ptrdiff_t>(random_.index(switchable.size())));
        chooseSome(switchable, switchShare, &Part::switched);
    }

    /// Two values, of which the one while the light is on is the rest's. All of a part is switched alike.
    template <typename Value>
    void addSwitch(int node, AnimatedValue what, bool goesOut, const Value& on, const Value& off) {
        scene::Channel channel = channelOf(node, what, Interpolation::Step);
        addKey(channel, 0.0f, goesOut ? on : off);
        addKey(channel, switchTime_, goesOut ? off : on);
        clip_.channels.push_back(std::move(channel));
    }

    void moveThing(const Part& part) {
        const vec3 center = part.thing.center();
        const int mover = addNode(scene_.rig, "thing", none, center);
        if (part.moves) addMovement(mover, part);
        for (const size_t i : part.thing.instances) {
            scene::Instance& instance = scene_.instances[i];
            vec3 origin = center;
            int parent = mover;
            if (part.switched && isLamp(scene_, instance)) {
                origin = boundsOf(scene_, instance).center();
                parent = addNode(scene_.rig, "switch", mover, origin - center);
                // Nothing is left of it, which shaders and light tree know (isInvertible()).
                addSwitch(parent, AnimatedValue::Scale, part.goesOut, vec3(1.0f), vec3(0.0f));
            }
            const int node = addNode(scene_.rig, instance.name, parent);
            scene_.rig.nodes.back().matrix = glm::translate(mat4(1.0f), -origin) * instance.transform;
            instance.node = node;
        }
        for (const size_t i : part.thing.lights) {
            scene::PunctualLight& light = scene_.lights[i];
            int parent = mover;
            if (part.switched) {
                parent = addNode(scene_.rig, "switch", mover);
                addSwitch(parent, AnimatedValue::Translation, part.goesOut, vec3(0.0f),
                          vec3(0.0f, farAway * size_, 0.0f));
            }
            light.node = addNode(scene_.rig, light.name, parent, light.position - center);
        }
    }

    /// Some turn besides, or only turn.
    void addMovement(int mover, const Part& part) {
        const bool turns = random_.chance(0.4f);
        if (turns) addTurning(mover, part);
        if (!turns || random_.chance(0.7f)) addPath(mover, part.thing);
    }

    void addTurning(int mover, const Part& part) {
        vec3 axis = random_.direction();
        if (part.shines || random_.chance(0.7f)) axis = vec3(0.0f, random_.chance(0.5f) ? 1.0f : -1.0f, 0.0f);
        const float speed = random_.logarithmic(0.1f, 4.0f);  // radians a second
        constexpr float step = pi / 3;
        scene::Channel channel = channelOf(mover, AnimatedValue::Rotation, Interpolation::Linear);
        for (int key = 0; channel.times.empty() || channel.times.back() < end_; ++key)
            addKey(channel, static_cast<float>(key) * step / speed,
                   glm::angleAxis(static_cast<float>(key) * step, axis));
        clip_.channels.push_back(std::move(channel));
    }

    /// From the place of rest through random ones near it, with stops.
    void addPath(int mover, const Thing& thing) {
        const float speed = size_ * random_.logarithmic(0.02f, 1.0f);
        const float reach = size_ * random_.logarithmic(0.08f, 0.4f);
        scene::Channel channel = channelOf(mover, AnimatedValue::Translation, Interpolation::Linear);
        vec3 place = thing.center();
        float time = 0.0f;
        addKey(channel, time, place);
        while (time < end_) {
            if (random_.chance(0.2f)) {
                time += random_.between(0.05f, 0.6f);
            } else {
                const vec3 next = placeNear(thing, reach);
                time += std::max(glm::distance(place, next) / speed, 0.02f);
                place = next;
            }
            addKey(channel, time, place);
        }
        clip_.channels.push_back(std::move(channel));
    }

    /// Not below the place of rest where there is a ground, within the walls, and not before the camera's
    /// eye.
    vec3 placeNear(const Thing& thing, float reach) {
        const vec3 rest = thing.center();
        const auto eye = vec3(scene_.cameras.front().toWorld[3]);
        constexpr int attempts = 8;
        for (int i = 0; i < attempts; ++i) {
            const float distance = reach * random_.between(0.2f, 1.0f);
            vec3 place = rest + distance * random_.direction();
            if (surroundings_) place.y = std::max(place.y, rest.y);
            place = withinWalls(scene_, place, 0.5f * thing.bounds.size() + 0.005f * size_, rest);
            if (glm::distance(place, eye) > thing.radius() + 0.15f * size_) return place;
        }
        return rest;
    }

    /// Turns about the vertical axis, back and forth.
    void moveSun(const Part& part) {
        scene::PunctualLight& light = scene_.lights[static_cast<size_t>(part.sun)];
        int parent = none;
        if (part.switched) {
            parent = addNode(scene_.rig, "switch", none);
            // Half a turn about a horizontal axis.
            addSwitch(parent, AnimatedValue::Rotation, part.goesOut, glm::quat(1, 0, 0, 0),
                      glm::quat(0, 1, 0, 0));
        }
        const int mover = addNode(scene_.rig, "turn", parent);
        if (part.moves) {
            const float speed = random_.logarithmic(0.02f, 1.5f);  // radians a second
            scene::Channel channel = channelOf(mover, AnimatedValue::Rotation, Interpolation::Linear);
            float time = 0.0f, angle = 0.0f;
            addKey(channel, time, glm::quat(1, 0, 0, 0));
            while (time < end_) {
                const float next = random_.between(-1.0f, 1.0f);
                time += std::max(std::abs(next - angle) / speed, 0.02f);
                angle = next;
                addKey(channel, time, glm::angleAxis(angle, vec3(0.0f, 1.0f, 0.0f)));
            }
            clip_.channels.push_back(std::move(channel));
        }
        light.node = addNode(scene_.rig, light.name, mover);
        const vec3 across = std::abs(light.direction.y) > 0.99f ? vec3(1, 0, 0) : vec3(0, 1, 0);
        scene_.rig.nodes.back().rotation = glm::quatLookAt(light.direction, across);
    }

    scene::Scene& scene_;
    ClipRandom random_;
    float end_, size_ = 1.0f, switchTime_ = -1.0f;  ///< seconds; metres; seconds
    const scene::Instance* surroundings_;
    std::vector<Part> parts_;
    scene::Clip clip_;
};

}  // namespace

ClipMotion addMotion(scene::Scene& scene, uint32_t seed, const SequenceTiming& timing,
                     const std::vector<uint32_t>& frames) {
    return Mover(scene, seed, timing, frames).add();
}

void addStillClip(scene::Scene& scene) {
    // Lamps come before other things.
    const auto found =
        std::find_if(scene.instances.rbegin(), scene.instances.rend(),
                     [&](const scene::Instance& instance) { return &instance != surroundingsOf(scene); });
    if (found == scene.instances.rend()) return;
    const int parent = addNode(scene.rig, "still", none);
    found->node = addNode(scene.rig, found->name, parent);
    scene.rig.nodes.back().matrix = found->transform;
    scene::Channel channel = channelOf(parent, AnimatedValue::Translation, Interpolation::Step);
    addKey(channel, 0.0f, vec3(0.0f));
    scene.rig.clips.push_back({"still", {std::move(channel)}});
    scene::chooseClip(scene, "");
}

}  // namespace limpid::cli
