#include "serve/session/protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/json_float.h"
#include "image/colormap.h"
#include "image/tone_curve.h"
#include "renderer/method/parameters.h"
#include "serve/session/preset_edits.h"
#include "studio/state/state_json.h"

namespace limpid::serve {
namespace {

using nlohmann::json;
using studio::Field;
using studio::Gesture;
using studio::Request;

/// What one message may do to the camera: a hand does less in a second.
constexpr float largestMovement = 100.0f;
constexpr int maxDepth = 32;
constexpr int legendBands = 64;  ///< of the colors from 0 to 1

constexpr std::array<std::pair<const char*, Request::Kind>, 13> requests{{
    {"reset", Request::Kind::Reset},
    {"step", Request::Kind::Step},
    {"measure_exposure", Request::Kind::MeasureExposure},
    {"reset_camera", Request::Kind::ResetCamera},
    {"see_all", Request::Kind::SeeAll},
    {"focus", Request::Kind::Focus},
    {"probe", Request::Kind::Probe},
    {"cancel_loading", Request::Kind::CancelLoading},
    {"add_point", Request::Kind::AddPoint},
    {"add_sun", Request::Kind::AddSun},
    {"remove_lamp", Request::Kind::RemoveLamp},
    {"keep_settings", Request::Kind::KeepSettings},
    {"command_line", Request::Kind::CommandLine},
}};

float movementOf(const json& value) {
    const auto number = finiteFloat(value);
    if (!number) throw UsageError("a movement is no number, or too large");
    if (!(std::abs(*number) <= largestMovement)) throw UsageError("a movement is too large");
    return *number;
}

/// Others than whole numbers would be converted with undefined results.
uint64_t wholeNumberOf(const json& value, uint64_t largest) {
    if (!value.is_number_unsigned() || value.get<uint64_t>() > largest)
        throw UsageError("a whole number is needed that is not negative");
    return value.get<uint64_t>();
}

template <int N>
glm::vec<N, float> movementsOf(const json& message, const char* key) {
    glm::vec<N, float> result(0.0f);
    const auto found = message.find(key);
    if (found == message.end()) return result;
    if (!found->is_array() || found->size() != N)
        throw UsageError(std::string(key) + ": wrong number of values");
    for (int i = 0; i < N; ++i) result[i] = movementOf(found->at(static_cast<size_t>(i)));
    return result;
}

Gesture gestureOf(const json& message) {
    Gesture gesture{.orbit = movementsOf<2>(message, "orbit"),
                    .look = movementsOf<2>(message, "look"),
                    .pan = movementsOf<2>(message, "pan"),
                    .fly = movementsOf<3>(message, "fly")};
    if (message.contains("zoom")) gesture.zoom = movementOf(message.at("zoom"));
    if (message.contains("speed")) gesture.speed = movementOf(message.at("speed"));
    return gesture;
}

std::array<float, 2> positionOf(const json& value) {
    if (!value.is_array() || value.size() != 2) throw UsageError("position: two numbers are needed");
    std::array<float, 2> position{};
    for (size_t i = 0; i < 2; ++i) {
        const auto number = finiteFloat(value.at(i));
        if (!number || !(*number >= 0.0f && *number <= 1.0f))
            throw UsageError("position: not between 0 and 1");
        position[i] = *number;
    }
    return position;
}

Request requestOf(const json& message) {
    const auto name = message.at("request").get<std::string>();
    const auto found =
        std::ranges::find_if(requests, [&](const auto& request) { return name == request.first; });
    if (found == requests.end()) throw UsageError("there is no request '" + name.substr(0, 40) + "'");
    Request request{.kind = found->second};
    if (message.contains("index"))
        request.index = static_cast<int>(wholeNumberOf(message.at("index"), 1 << 20));
    if (message.contains("position")) request.position = positionOf(message.at("position"));
    return request;
}

/// Everything else is checked where the edit is made.
Edit editOf(const json& message) {
    const json& changes = message.at("changes");
    const auto viewport = changes.find("viewport");
    if (viewport != changes.end() && viewport->is_array() && viewport->size() == 2 &&
        wholeNumberOf(viewport->at(0), 16384) * wholeNumberOf(viewport->at(1), 16384) > maxPixels)
        throw UsageError("viewport: too many pixels");
    return {changes};
}

Start startOf(const json& message) {
    Start start;
    bool jpeg = false;
    for (const json& codec : message.at("codecs")) {
        start.vp9 |= codec == "vp9" && !jpeg;
        jpeg |= codec == "jpeg";
    }
    if (!start.vp9 && !jpeg) throw UsageError("none of the codecs is known");
    start.jpegFirst = start.vp9 && jpeg;
    return start;
}

ClientMessage messageOf(const json& message) {
    const auto type = message.at("type").get<std::string>();
    ClientMessage result;
    if (message.contains("id")) result.id = wholeNumberOf(message.at("id"), UINT64_MAX);
    if (type == "start")
        result.content = startOf(message);
    else if (type == "received")
        result.content = Received{static_cast<uint32_t>(wholeNumberOf(message.at("frame"), UINT32_MAX))};
    else if (type == "edit")
        result.content = editOf(message);
    else if (type == "steer")
        result.content = gestureOf(message);
    else if (type == "ask")
        result.content = requestOf(message);
    else if (type == "open")
        result.content = Open{message.at("scene").get<std::string>()};
    else if (type == "read")
        result.content = Read{positionOf(message.at("position"))};
    else
        throw UsageError("there is no message '" + type.substr(0, 40) + "'");
    return result;
}

/// Nested arrays cost a stack frame each when they are copied. The parser counts: brackets in strings nest
/// nothing.
json parsed(std::string_view text) {
    return json::parse(text, [](int depth, json::parse_event_t, const json&) {
        if (depth > maxDepth) throw UsageError("the message is too deep");
        return true;
    });
}

const char* nameOf(Field::Kind kind) {
    constexpr std::array names{"bool", "int",    "float",      "choice", "index",   "vector",
                               "text", "lights", "background", "extent", "settings"};
    return names.at(static_cast<size_t>(kind));
}

json describe(const Field& field) {
    json result{{"key", field.key},
                {"section", field.section},
                {"label", field.label},
                {"help", field.help},
                {"unit", field.unit},
                {"kind", nameOf(field.kind)},
                {"minimum", field.minimum},
                {"maximum", field.maximum},
                {"slider",
                 {{"min", field.slider.min},
                  {"max", field.slider.max},
                  {"scale", field.slider.scale == SliderScale::Linear ? "linear" : "logarithmic"},
                  {"smallest", field.slider.smallest}}},
                {"choices", field.choices},
                {"default", field.defaultValue}};
    if (!field.choiceHelp.empty()) result["choice_help"] = field.choiceHelp;
    if (!field.denoisers.empty()) result["denoisers"] = field.denoisers;
    return result;
}

/// Encoded color as CSS has it.
std::string cssColor(const std::array<float, 3>& color) {
    const auto byte = [&](size_t i) { return std::lround(255.0f * std::clamp(color[i], 0.0f, 1.0f)); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(0), byte(1), byte(2));
}

/// What colors mean that stand for numbers.
json legends() {
    json stops = json::array(), values = json::array();
    for (const vec3& color : image::falseColors()) stops.push_back(cssColor({color.r, color.g, color.b}));
    for (int i = 0; i < legendBands; ++i)
        values.push_back(cssColor(image::magma((static_cast<float>(i) + 0.5f) / legendBands)));
    return {{"stops", std::move(stops)}, {"values", std::move(values)}};
}

/// The groups of parameters that take part in each pipeline.
json groupsByPipeline() {
    json result = json::object();
    for (const Integrator integrator : integrators()) {
        for (const std::string_view denoiser : denoiserNames()) {
            const Pipeline pipeline{integrator, parseDenoiser(denoiser)};
            if (pipeline.denoiser && !canBeDenoised(integrator, *pipeline.denoiser)) continue;
            const std::string name = std::string(limpid::nameOf(integrator)) + "+" + std::string(denoiser);
            result[name] = groupsOf(pipeline);
        }
    }
    return result;
}

template <typename T>
void put(std::span<std::byte> bytes, size_t at, T value) {
    for (size_t i = 0; i < sizeof(T); ++i)
        bytes[at + i] = static_cast<std::byte>(uint64_t{value} >> 8 * i & 0xff);
}

template <typename T>
T take(std::span<const std::byte> bytes, size_t at) {
    uint64_t value = 0;
    for (size_t i = 0; i < sizeof(T); ++i)
        value |= uint64_t{std::to_integer<uint8_t>(bytes[at + i])} << 8 * i;
    return static_cast<T>(value);
}

}  // namespace

ClientMessage parseMessage(std::string_view text) {
    if (text.size() > maxTextBytes) throw UsageError("the message is too long");
    try {
        return messageOf(parsed(text));
    } catch (const json::exception&) {
        throw UsageError("the message is not one of the protocol");
    }
}

json helloMessage(const std::vector<std::string>& scenes, uint64_t uploads) {
    json fields = json::array(), names = json::array();
    for (const Field& field : studio::fields()) fields.push_back(describe(field));
    for (const auto& [name, kind] : requests) names.push_back(name);
    return {{"type", "hello"},
            {"version", 1},
            {"fields", std::move(fields)},
            {"requests", std::move(names)},
            {"scenes", scenes},
            {"uploads", uploads},
            {"presets", presetEdits()},
            {"legends", legends()},
            {"groups", groupsByPipeline()}};
}

std::array<std::byte, frameHeaderBytes> packed(const FrameHeader& header) {
    std::array<std::byte, frameHeaderBytes> bytes{};
    const std::span<std::byte> out(bytes);
    put(out, 0, static_cast<uint8_t>(header.codec));
    put(out, 1,
        static_cast<uint8_t>(int{header.key} | int{header.compared} << 1 | int{header.lossless} << 2 |
                             int{header.inspected} << 3));
    put(out, 4, header.width);
    put(out, 6, header.height);
    put(out, 8, header.frame);
    put(out, 16, header.message);
    put(out, 24, header.snapshot);
    return bytes;
}

FrameHeader unpackedHeader(std::span<const std::byte> bytes) {
    if (bytes.size() < frameHeaderBytes) throw Error("the picture has no header");
    const auto codec = take<uint8_t>(bytes, 0), flags = take<uint8_t>(bytes, 1);
    if (codec < 1 || codec > 4) throw Error("the picture is of an unknown kind");
    return {.codec = static_cast<Codec>(codec),
            .key = (flags & 1) != 0,
            .compared = (flags & 2) != 0,
            .lossless = (flags & 4) != 0,
            .inspected = (flags & 8) != 0,
            .width = take<uint16_t>(bytes, 4),
            .height = take<uint16_t>(bytes, 6),
            .frame = take<uint32_t>(bytes, 8),
            .message = take<uint64_t>(bytes, 16),
            .snapshot = take<uint64_t>(bytes, 24)};
}

}  // namespace limpid::serve
