#include "studio/state/state_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/json_float.h"
#include "renderer/method/parameters.h"

namespace limpid::studio {
namespace {

using nlohmann::json;
using Kind = Field::Kind;

/// A field with its place in the state. `set` throws json::exception where the value has another type.
struct Entry {
    Field field;
    std::function<json(const State&)> get;
    std::function<void(State&, const json&)> set;
};

struct Texts {
    const char *key, *section, *label, *help;
    const char* unit = "";
};

Field fieldOf(Kind kind, const Texts& texts) {
    Field field{.kind = kind,
                .key = texts.key,
                .section = texts.section,
                .label = texts.label,
                .help = texts.help,
                .unit = texts.unit,
                .slider = {}};
    return field;
}

[[noreturn]] void refuse(const std::string& key, const std::string& why) {
    throw UsageError(key + ": " + why);
}

/// Access to one member, as a function that returns a reference to it.
template <typename Member>
Entry flag(const Texts& texts, Member member) {
    return {fieldOf(Kind::Bool, texts), [=](const State& s) -> json { return member(const_cast<State&>(s)); },
            [=](State& s, const json& v) { member(s) = v.get<bool>(); }};
}

template <typename Member>
Entry number(const Texts& texts, Kind kind, double minimum, double maximum, const SliderSpan& slider,
             Member member) {
    Field field = fieldOf(kind, texts);
    field.minimum = minimum;
    field.maximum = maximum;
    field.slider = slider;
    using Value = std::remove_cvref_t<decltype(member(std::declval<State&>()))>;
    const std::string key = texts.key;
    // The ends as a control has them, which clamps to them: 0.01 as a float is below 0.01.
    const auto least = static_cast<double>(static_cast<Value>(minimum)),
               most = static_cast<double>(static_cast<Value>(maximum));
    return {field, [=](const State& s) -> json { return member(const_cast<State&>(s)); },
            [=](State& s, const json& v) {
                const double value = v.get<double>();
                if (!(value >= std::min(least, minimum) && value <= std::max(most, maximum)))
                    refuse(key, fmt::format("{} is not between {} and {}", value, minimum, maximum));
                if (kind == Kind::Int && value != std::floor(value))
                    refuse(key, fmt::format("{} is no integer", value));
                member(s) = static_cast<Value>(value);
            }};
}

/// A choice whose number `get` returns and `set` takes.
template <typename Get, typename Set>
Entry choice(const Texts& texts, std::vector<std::string> names, Get get, Set set) {
    Field field = fieldOf(Kind::Choice, texts);
    field.choices = names;
    const std::string key = texts.key;
    return {field, [=](const State& s) -> json { return names.at(get(s)); },
            [=](State& s, const json& v) {
                const auto name = v.get<std::string>();
                const auto found = std::ranges::find(names, name);
                if (found == names.end()) refuse(key, "'" + name + "' is none of the choices");
                set(s, static_cast<size_t>(found - names.begin()));
            }};
}

template <typename Member>
Entry choice(const Texts& texts, std::vector<std::string> names, Member member) {
    using Value = std::remove_cvref_t<decltype(member(std::declval<State&>()))>;
    return choice(
        texts, std::move(names),
        [=](const State& s) { return static_cast<size_t>(member(const_cast<State&>(s))); },
        [=](State& s, size_t index) { member(s) = static_cast<Value>(index); });
}

json jsonOf(const vec3& v) {
    return json::array({v.x, v.y, v.z});
}

vec3 vectorOf(const std::string& key, const json& value) {
    vec3 vector(0.0f);
    if (!value.is_array() || value.size() != 3) refuse(key, "three numbers are needed");
    for (int i = 0; i < 3; ++i) {
        const auto number = finiteFloat(value[static_cast<size_t>(i)]);
        if (!number) refuse(key, "three numbers are needed");
        vector[i] = *number;
    }
    return vector;
}

template <typename Member>
Entry vector(const Texts& texts, Member member) {
    const std::string key = texts.key;
    return {fieldOf(Kind::Vector, texts),
            [=](const State& s) { return jsonOf(member(const_cast<State&>(s))); },
            [=](State& s, const json& v) { member(s) = vectorOf(key, v); }};
}

template <typename Member>
Entry index(const Texts& texts, const char* list, Member member) {
    Entry entry = number(texts, Kind::Index, 0, 1 << 20, {}, member);
    entry.field.choices = {list};
    return entry;
}

// ---- The light desk

json jsonOf(const scene::LightControl& light) {
    return {{"name", light.name},
            {"kind", light.kind == scene::LightControl::Kind::Lamp      ? "lamp"
                     : light.kind == scene::LightControl::Kind::Emitter ? "emitter"
                                                                        : "environment"},
            {"on", light.on},
            {"color", jsonOf(light.color)},
            {"brightness", light.brightness},
            {"position", jsonOf(light.position)},
            {"direction", jsonOf(light.direction)},
            {"turn", light.turn}};
}

/// Limits the number before it becomes a float, which may not have its range.
float limitedOf(const json& value, double minimum, double maximum) {
    return static_cast<float>(std::clamp(value.get<double>(), minimum, maximum));
}

void setLight(scene::LightControl& light, const json& value) {
    light.on = value.at("on").get<bool>();
    light.color = glm::max(vectorOf("lights", value.at("color")), vec3(0.0f));
    light.position = vectorOf("lights", value.at("position"));
    const vec3 direction = vectorOf("lights", value.at("direction"));
    if (glm::length(direction) > 1e-6f) light.direction = glm::normalize(direction);
    light.brightness = limitedOf(value.at("brightness"), 0.0, 1e9);
    light.turn = limitedOf(value.at("turn"), -360.0, 360.0);
}

Entry lightsEntry() {
    return {fieldOf(Kind::Lights,
                    {"lights", "light", "lights", "Every lamp, emitter and environment of the scene"}),
            [](const State& s) {
                json all = json::array();
                for (const scene::LightControl& light : s.lights.lights) all.push_back(jsonOf(light));
                return all;
            },
            [](State& s, const json& v) {
                if (!v.is_array() || v.size() != s.lights.lights.size())
                    refuse("lights", "the scene has another number of lights");
                for (size_t i = 0; i < v.size(); ++i) setLight(s.lights.lights[i], v[i]);
            }};
}

Entry backgroundEntry() {
    return {fieldOf(Kind::Background, {"background", "light", "background",
                                       "A uniform environment instead of the scene's own; linear Rec. 709"}),
            [](const State& s) { return s.lights.hasBackground ? jsonOf(s.lights.background) : json(); },
            [](State& s, const json& v) {
                s.lights.hasBackground = !v.is_null();
                if (!v.is_null()) s.lights.background = glm::max(vectorOf("background", v), vec3(0.0f));
            }};
}

Entry viewportEntry() {
    return {fieldOf(Kind::Extent, {"viewport", "scene", "size", "Pixels in which the picture is shown"}),
            [](const State& s) {
                return json::array({s.viewport.width, s.viewport.height});
            },
            [](State& s, const json& v) {
                const bool whole = v.is_array() && std::ranges::all_of(v, [](const json& n) {
                                       return n.is_number_integer() && n >= 0;
                                   });
                const auto size = whole ? v.get<std::vector<uint64_t>>() : std::vector<uint64_t>();
                if (size.size() != 2 || size[0] > 16384 || size[1] > 16384)
                    refuse("viewport", "width and height are needed, each at most 16384");
                s.viewport = {static_cast<uint32_t>(size[0]), static_cast<uint32_t>(size[1])};
            }};
}

// ---- The method

/// The settings as a list of assignments: "integrator=path", "denoiser=svgf", "jitter=frame",
/// "svgf.levels=3".
json assignmentsJson(const RenderSettings& settings) {
    json list = json::array({"integrator=" + std::string(nameOf(settings.pipeline.integrator)),
                             "denoiser=" + std::string(nameOf(settings.pipeline.denoiser)),
                             "jitter=" + std::string(toString(settings.jitter))});
    for (const std::string& text : assignmentsOf(settings)) list.push_back(text);
    return list;
}

Jitter jitterOf(const std::string& name) {
    for (const Jitter jitter : {Jitter::Pixel, Jitter::Frame, Jitter::Off})
        if (name == toString(jitter)) return jitter;
    refuse("kept_settings", "there is no jitter '" + name + "'");
}

RenderSettings settingsOf(const json& list) {
    RenderSettings settings;
    std::string integrator = "path", denoiser = "none";
    std::optional<Jitter> jitter;
    if (!list.is_array() || list.size() > 1000) refuse("kept_settings", "a list of assignments is needed");
    for (const json& item : list) {
        const auto text = item.get<std::string>();
        if (text.starts_with("integrator="))
            integrator = text.substr(11);
        else if (text.starts_with("denoiser="))
            denoiser = text.substr(9);
        else if (text.starts_with("jitter="))
            jitter = jitterOf(text.substr(7));
        else
            assign(settings, text);
    }
    settings.pipeline = parsePipeline(integrator, denoiser);
    settings.jitter = jitter.value_or(defaultJitter(settings.pipeline));
    return settings;
}

Entry keptSettingsEntry() {
    return {fieldOf(Kind::Settings, {"kept_settings", "compare", "kept settings",
                                     "Method and parameters that the picture is compared with"}),
            [](const State& s) { return assignmentsJson(s.comparison.kept); },
            [](State& s, const json& v) { s.comparison.kept = settingsOf(v); }};
}

Entry integratorEntry() {
    std::vector<std::string> names, help;
    for (const Integrator integrator : integrators()) {
        names.emplace_back(nameOf(integrator));
        help.emplace_back(helpOf(integrator));
    }
    Entry entry = choice(
        {"integrator", "method", "integrator", "What is computed"}, names,
        [](const State& s) {
            return static_cast<size_t>(std::ranges::find(integrators(), s.render.pipeline.integrator) -
                                       integrators().begin());
        },
        [](State& s, size_t chosen) {
            Pipeline pipeline = s.render.pipeline;
            pipeline.integrator = integrators()[chosen];
            if (pipeline.denoiser && !canBeDenoised(pipeline.integrator, *pipeline.denoiser))
                pipeline.denoiser = nullptr;
            s.render.pipeline = pipeline;
        });
    entry.field.choiceHelp = std::move(help);
    return entry;
}

Entry denoiserEntry() {
    std::vector<std::string> names, help;
    for (const std::string_view name : denoiserNames()) {
        names.emplace_back(name);
        const denoise::Denoiser* const denoiser = parseDenoiser(names.back());
        help.emplace_back(denoiser ? denoiser->help : "the picture as it is rendered");
    }
    Entry entry = choice(
        {"denoiser", "method", "denoiser", "How noise is removed"}, names,
        [names](const State& s) {
            return static_cast<size_t>(std::ranges::find(names, nameOf(s.render.pipeline.denoiser)) -
                                       names.begin());
        },
        [names](State& s, size_t chosen) {
            Pipeline pipeline = s.render.pipeline;
            pipeline.denoiser = parseDenoiser(names[chosen]);
            if (pipeline.denoiser)
                pipeline.integrator = integratorFor(*pipeline.denoiser, pipeline.integrator);
            s.render.pipeline = pipeline;
        });
    entry.field.choiceHelp = std::move(help);
    return entry;
}

json jsonOf(const ParamValue& value) {
    return std::visit([](auto v) -> json { return v; }, value);
}

std::string textOf(const std::string& key, const json& value) {
    if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
    if (value.is_number_integer()) return std::to_string(value.get<int64_t>());
    if (const auto number = finiteFloat(value)) return fmt::format("{}", *number);
    refuse(key, value.is_number() ? "the number is too large" : "a number, or true or false, is needed");
}

Entry parameterEntry(const ParamGroup& group, size_t number) {
    const ParamInfo& info = group.infos[number];
    Field field{.kind = std::holds_alternative<bool>(info.defaultValue)  ? Kind::Bool
                        : std::holds_alternative<int>(info.defaultValue) ? Kind::Int
                                                                         : Kind::Float,
                .key = group.name + "." + info.name,
                .section = group.name,
                .label = info.name,
                .help = info.help,
                .unit = info.unit,
                .minimum = info.minimum,
                .maximum = info.maximum,
                .slider = info.slider};
    const std::string key = field.key, name = info.name;
    return {field, [get = group.get, number](const State& s) { return jsonOf(get(s.render, number)); },
            [set = group.set, name, key](State& s, const json& v) { set(s.render, name, textOf(key, v)); }};
}

/// "part.temporal" and so on.
Entry partEntry(size_t part) {
    const DenoiserPart& info = denoiserParts[part];
    const std::string key = "part." + std::string(info.name), help(info.help);
    Entry entry = flag(
        {key.c_str(), "method", info.name.data(), help.c_str()}, [part](State & s) -> auto& {
            return s.parts.on[part];
        });
    for (const std::string_view name : denoiserNames())
        if (hasPart(parseDenoiser(name), part)) entry.field.denoisers.emplace_back(name);
    return entry;
}

void addMethod(std::vector<Entry>& all) {
    const SliderSpan samples{1, 64, SliderScale::Logarithmic}, many{1, 1 << 20, SliderScale::Logarithmic};
    all.push_back(integratorEntry());
    all.push_back(denoiserEntry());
    for (size_t part = 0; part < denoiserParts.size(); ++part) all.push_back(partEntry(part));
    all.push_back(number(
        {"samples", "method", "samples a frame", "More are less noisy and slower", "per pixel"}, Kind::Int, 1,
        64, samples, [](State & s) -> auto& { return s.samples; }));
    all.push_back(number(
        {"max_samples", "method", "samples at most", "A picture in which nothing changes is finished then",
         "per pixel"},
        Kind::Int, 1, 1 << 20, many, [](State & s) -> auto& { return s.maxSamples; }));
    all.push_back(number(
        {"seed", "method", "seed", "Another seed gives other noise"}, Kind::Int, 0, 0x7fffffff, {0, 1000},
        [](State & s) -> auto& { return s.render.seed; }));
    all.push_back(choice(
        {"jitter", "method", "jitter", "Where in a pixel its samples lie"},
        {"as the method needs it", "pixel", "frame", "off"}, [](State & s) -> auto& { return s.jitter; }));
    all.push_back(choice(
        {"resolution", "method", "resolution",
         "Automatic renders fewer pixels while something moves and the device is slow"},
        {"automatic", "full", "1/2", "1/4", "1/8"}, [](State & s) -> auto& { return s.resolution; }));
    all.push_back(flag(
        {"layers", "method", "layers in EXR files", "Albedo, normal, depth and others; slower"},
        [](State & s) -> auto& { return s.render.layers; }));
}

void addCamera(std::vector<Entry>& all) {
    all.push_back(index(
        {"camera", "camera", "camera", "A free one, one of the scene's, or a path"}, "cameras",
        [](State & s) -> auto& { return s.camera; }));
    all.push_back(number(
        {"fov", "camera", "field of view", "Vertical", "degrees"}, Kind::Float, 0.01, 179.0, {5.0, 150.0},
        [](State & s) -> auto& { return s.fovDegrees; }));
    all.push_back(number(
        {"half_height", "camera", "half height",
         "Half of the height that a camera without perspective sees; 0: with perspective", "world units"},
        Kind::Float, 0.0, 1e9, {0.0, 100.0, SliderScale::Logarithmic, 0.01},
        [](State & s) -> auto& { return s.halfHeight; }));
    all.push_back(vector(
        {"eye", "camera", "eye", "Where the camera is", "world units"},
        [](State & s) -> auto& { return s.pose.eye; }));
    all.push_back(vector(
        {"target", "camera", "target", "What the camera looks at and turns around", "world units"},
        [](State & s) -> auto& { return s.pose.target; }));
    all.push_back(vector(
        {"up", "camera", "up", "Direction of the picture's vertical"},
        [](State & s) -> auto& { return s.pose.up; }));
    all.push_back(flag(
        {"running", "camera", "rendering", "Frames are rendered as long as they improve the picture"},
        [](State & s) -> auto& { return s.running; }));
    all.push_back(flag(
        {"playing", "camera", "playing", "The scene's animation, or the camera's path"},
        [](State & s) -> auto& { return s.playing; }));
    all.push_back(number(
        {"time", "camera", "time", "Moment of the animation", "s"}, Kind::Float, 0.0, 1e6, {0.0, 10.0},
        [](State & s) -> auto& { return s.time; }));
    all.push_back(number(
        {"shutter", "camera", "shutter",
         "Motion blur: how long the shutter is open; a frame is 1/30 s. Works while nothing moves, with the "
         "integrators path and direct, without denoiser and comparison",
         "frames"},
        Kind::Float, 0.0, 100.0, {0.0, 2.0}, [](State & s) -> auto& { return s.shutter.open; }));
    all.push_back(choice(
        {"shutter_position", "camera", "shutter position",
         "At the frame's time the shutter opens (start), is halfway (center) or closes (end)"},
        {Shutter::positionNames.begin(), Shutter::positionNames.end()},
        [](State & s) -> auto& { return s.shutter.position; }));
}

void addLook(std::vector<Entry>& all) {
    const SliderSpan stops{-16.0, 16.0};
    all.push_back(number(
        {"exposure", "look", "exposure", "One more doubles the brightness", "stops"}, Kind::Float, -32.0,
        32.0, stops, [](State & s) -> auto& { return s.exposure; }));
    all.push_back(choice(
        {"tone_curve", "look", "tone curve",
         "How radiance becomes colour: standard (filmic), agx (bright colours turn white), none (clipped), "
         "or "
         "false-color (a colour for each stop)"},
        image::toneCurveNames(), [](State & s) -> auto& { return s.toneCurve; }));
    all.push_back(choice(
        {"compare", "compare", "compare with", "Shown beside the picture, on the same frames"},
        comparisonNames(), [](State & s) -> auto& { return s.comparison.with; }));
    all.push_back(number(
        {"reference_samples", "compare", "reference samples", "The reference is finished then", "per pixel"},
        Kind::Int, 1, 1 << 16, {1, 1 << 16, SliderScale::Logarithmic},
        [](State & s) -> auto& { return s.comparison.referenceSamples; }));
    all.push_back(keptSettingsEntry());
    all.push_back(
        {fieldOf(Kind::Text, {"pass", "inspect", "pass", "Pass whose images are shown; empty: the picture"}),
         [](const State& s) -> json { return s.pass; },
         [](State& s, const json& v) { s.pass = v.get<std::string>(); }});
    all.push_back(index(
        {"image", "inspect", "image", "Image of the pass"}, "images",
        [](State & s) -> auto& { return s.image; }));
    all.push_back(choice(
        {"view.channels", "inspect", "channels", "Channels of the image that are shown"},
        {"color", "red", "green", "blue", "alpha"}, [](State & s) -> auto& { return s.view.channels; }));
    all.push_back(number(
        {"view.stops", "inspect", "brightness", "Values are multiplied by 2 to its power", "stops"},
        Kind::Float, -32.0, 32.0, stops, [](State & s) -> auto& { return s.view.stops; }));
    all.push_back(flag(
        {"view.false_color", "inspect", "false color", "From black over purple to pale yellow"},
        [](State & s) -> auto& { return s.view.falseColor; }));
    all.push_back(flag(
        {"arrows", "inspect", "motion arrows", "Motion since the frame before, with a denoiser"},
        [](State & s) -> auto& { return s.arrows; }));
}

std::vector<Entry> makeEntries() {
    std::vector<Entry> all{viewportEntry()};
    addCamera(all);
    all.push_back(lightsEntry());
    all.push_back(backgroundEntry());
    addMethod(all);
    addLook(all);
    for (const ParamGroup& group : paramGroups()) {
        for (size_t i = 0; i < group.infos.size(); ++i) all.push_back(parameterEntry(group, i));
    }
    const State initial;
    // The exposure is measured for each scene.
    const auto fromScene = [](const Field& field) {
        const bool isCamera = field.section == "camera" && !field.key.starts_with("shutter");
        return field.section == "light" || isCamera || field.key == "exposure";
    };
    for (Entry& entry : all) {
        if (!fromScene(entry.field)) entry.field.defaultValue = entry.get(initial);
    }
    return all;
}

const std::vector<Entry>& entries() {
    static const std::vector<Entry> all = makeEntries();
    return all;
}

const Entry* findEntry(std::string_view key) {
    static const auto byKey = [] {
        std::map<std::string_view, const Entry*> map;
        for (const Entry& entry : entries()) map.emplace(entry.field.key, &entry);
        return map;
    }();
    const auto found = byKey.find(key);
    return found == byKey.end() ? nullptr : found->second;
}

}  // namespace

const std::vector<Field>& fields() {
    static const auto all = [] {
        std::vector<Field> list;
        for (const Entry& entry : entries()) list.push_back(entry.field);
        return list;
    }();
    return all;
}

const Field* findField(std::string_view key) {
    const Entry* const entry = findEntry(key);
    return entry ? &entry->field : nullptr;
}

json toJson(const State& state) {
    json all = json::object();
    for (const Entry& entry : entries()) all[entry.field.key] = entry.get(state);
    return all;
}

void apply(State& state, const json& changes) {
    if (!changes.is_object()) throw UsageError("an object with the changed fields is needed");
    State changed = state;
    for (const auto& [key, value] : changes.items()) {
        const Entry* const entry = findEntry(key);
        if (!entry) throw UsageError("there is no field '" + key + "'");
        try {
            entry->set(changed, value);
        } catch (const json::exception&) {
            refuse(key, "the value has the wrong type");
        }
    }
    // Integrator and denoiser may change together: what counts is the pipeline before all changes.
    if (changed.isPreview() && !state.isPreview()) changed.pipelineBefore = state.render.pipeline;
    state = std::move(changed);
}

json changesOf(const json& before, const json& now) {
    json changes = json::object();
    for (const auto& [key, value] : now.items()) {
        const auto old = before.find(key);
        if (old == before.end() || *old != value) changes[key] = value;
    }
    return changes;
}

json toJson(const Facts& facts) {
    json passes = json::array();
    for (const PassTrack& pass : facts.timings.passes())
        passes.push_back({{"name", pass.name}, {"milliseconds", pass.milliseconds.last()}});
    return {{"device", facts.device},
            {"scene", facts.scene},
            {"scenes", facts.scenesShown},
            {"notes", facts.notes},
            {"activity", facts.activityText()},
            {"extent", {facts.extent.width, facts.extent.height}},
            {"picture_extent", {facts.pictureExtent.width, facts.pictureExtent.height}},
            {"samples", facts.samplesInMean},
            {"frames", facts.frames},
            {"frames_begun", facts.framesBegun},
            {"computing", facts.computing},
            {"compiling", facts.compiling},
            {"duration", facts.duration},
            {"cameras", facts.cameras},
            {"frame_milliseconds", facts.timings.frames().last()},
            {"passes", passes},
            {"memory", facts.memoryBytes},
            {"scene_memory", facts.sceneBytes},
            {"scene_radius", facts.sceneRadius},
            {"compared_with", facts.comparedWith},
            {"scores", facts.scores},
            {"errors", facts.errors.values()},
            {"values", facts.allValues},
            {"probed_at", facts.probedAt},
            {"images", facts.images},
            {"message", facts.messageIsOld ? "" : facts.message},
            {"fault", facts.fault},
            {"command", facts.command},
            {"commands", facts.commands}};
}

}  // namespace limpid::studio
