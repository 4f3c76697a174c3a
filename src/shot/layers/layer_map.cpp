#include "shot/layers/layer_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files/file.h"
#include "base/json_float.h"

namespace limpid::shot {
namespace {

constexpr std::array roleTable{
    RoleInfo{"beauty", "there is nothing to denoise", 3, true},
    RoleInfo{"diffuse",
             "diffuse and specular light are filtered as one: reflections blur with textures' edges", 3,
             false},
    RoleInfo{"specular",
             "diffuse and specular light are filtered as one: reflections blur with textures' edges", 3,
             false},
    RoleInfo{"emission",
             "lamps are found by their even brightness, textured ones are filtered with the light", 3, false},
    RoleInfo{"albedo", "textures are blurred like noise", 3, true},
    RoleInfo{"albedoSpecular", "textures in reflections, and coloured metal, are blurred", 3, false},
    RoleInfo{"normal", "edges between surfaces of one colour are blurred", 3, true, RoleValues::Exact},
    RoleInfo{"depth", "edges between parallel surfaces are blurred, and hidden ones may leave ghosts", 1,
             true, RoleValues::Amounts},
    RoleInfo{"motion", "each frame is denoised alone, so the shot flickers", 2, true, RoleValues::Exact},
    RoleInfo{"id", "objects that touch share their light at the edge", 1, false, RoleValues::Exact},
    RoleInfo{"roughness", "glossy and rough reflections are filtered alike", 1, false, RoleValues::Amounts},
    RoleInfo{"alpha", "", 1, false, RoleValues::Amounts},
    RoleInfo{"albedoReflected", "", 3, false},
    RoleInfo{"mirroredEmission", "", 3, false},
    RoleInfo{"background", "", 3, false},
    RoleInfo{"position", "", 3, false, RoleValues::Exact},
    RoleInfo{"distance", "", 1, false, RoleValues::Amounts},
    RoleInfo{"cameraNormal", "", 3, false, RoleValues::Exact},
    RoleInfo{"seenAlbedo", "", 3, false},
};

constexpr std::array otherKeys{"normal.space", "normal.scale", "depth.kind", "depth.far",
                               "motion.unit",  "motion.scale", "world.up"};

template <size_t N>
std::array<float, N> numbersOf(std::string_view key, std::string_view text) {
    std::array<float, N> result{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (size_t i = 0; i < N; ++i) {
        const auto [next, error] = std::from_chars(at, end, result[i]);
        const bool last = i + 1 == N;
        if (error != std::errc{} || !std::isfinite(result[i]) ||
            (last ? next != end : next == end || *next != ','))
            throw UsageError(
                fmt::format("'{}={}': {} numbers are needed, separated by commas", key, text, N));
        at = next + 1;
    }
    return result;
}

template <typename Value>
Value choiceOf(std::string_view key, std::string_view text, std::string_view first, Value ifFirst,
               std::string_view second, Value ifSecond) {
    if (text == first) return ifFirst;
    if (text == second) return ifSecond;
    throw UsageError(fmt::format("'{}={}': it is '{}' or '{}'", key, text, first, second));
}

/// Sets one of otherKeys.
void setEncoding(Encoding& e, std::string_view key, std::string_view value) {
    if (key == "normal.space")
        e.normalSpace = choiceOf(key, value, "world", NormalSpace::World, "camera", NormalSpace::Camera);
    if (key == "depth.kind")
        e.depthKind = choiceOf(key, value, "distance", DepthKind::Distance, "planar", DepthKind::Planar);
    if (key == "motion.unit")
        e.motionUnit = choiceOf(key, value, "pixels", MotionUnit::Pixels, "picture", MotionUnit::Picture);
    if (key == "world.up") e.worldUp = choiceOf(key, value, "y", UpAxis::Y, "z", UpAxis::Z);
    if (key == "depth.far") e.farDepth = numbersOf<1>(key, value)[0];
    if (key == "normal.scale") {
        const auto [x, y, z] = numbersOf<3>(key, value);
        e.normalScale = {x, y, z};
    }
    if (key == "motion.scale") {
        const auto [x, y] = numbersOf<2>(key, value);
        e.motionScale = {x, y};
    }
}

void setRole(LayerMap& map, const RoleInfo& role, const std::string& value, const ChannelTable& table,
             const std::filesystem::path& file) {
    map.layers.erase(std::string(role.name));
    if (role.name == "beauty") {  // who names it has chosen what is cleaned
        map.replaced.reset();
        map.remarks.clear();
    }
    if (value.empty()) return;
    auto expression = LayerExpression::resolve(value, table, map.prefix);
    if (!expression) expression = LayerExpression::resolve(value, table);
    if (!expression) throw InputError(file, fmt::format("lacks a channel of '{}={}'", role.name, value));
    const uint32_t given = expression->components();
    if (given != role.components)
        throw UsageError(fmt::format("'{}={}': {} components are needed, not {}", role.name, value,
                                     role.components, given));
    map.layers.emplace(role.name, std::move(*expression));
}

std::string textOf(const nlohmann::json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (const auto number = finiteFloat(value)) return fmt::format("{}", *number);
    std::string list;
    for (const auto& item : value) list += (list.empty() ? "" : ",") + textOf(item);
    return list;
}

}  // namespace

bool LayerMap::uses(size_t part) const {
    const auto reads = [&](const LayerExpression& expression) {
        const std::vector<ChannelPlace> places = expression.places();
        return std::any_of(places.begin(), places.end(),
                           [&](const ChannelPlace& place) { return place.part == part; });
    };
    return std::any_of(layers.begin(), layers.end(),
                       [&](const auto& layer) { return reads(layer.second); }) ||
           std::any_of(groups.begin(), groups.end(), reads);
}

std::span<const RoleInfo> roles() {
    return roleTable;
}

std::string_view withoutRole(const LayerMap& map, const RoleInfo& role) {
    if (role.name != "motion" || !map.searchesMotion) return role.without;
    if (!map.find("normal")) return "it is searched by block matching on albedo";
    if (!map.find("albedo")) return "it is searched by block matching on normals";
    return "it is searched by block matching on albedo and normals";
}

const RoleInfo* findRole(std::string_view name) {
    const auto found = std::find_if(roleTable.begin(), roleTable.end(),
                                    [&](const RoleInfo& role) { return role.name == name; });
    return found == roleTable.end() ? nullptr : &*found;
}

std::pair<std::string, std::string> parseAssignment(std::string_view text) {
    const size_t equals = text.find('=');
    if (equals == 0 || equals == std::string_view::npos)
        throw UsageError(fmt::format("'{}' is no assignment; an example: albedo=MyAlbedo.RGB", text));
    return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

Assignments readAssignments(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, uint64_t{1} << 20);
    const auto* const begin = reinterpret_cast<const char*>(bytes.data());
    const auto json = nlohmann::json::parse(begin, begin + bytes.size(), nullptr, false);
    if (!json.is_object()) throw InputError(file, "is no JSON object with a layer for each role");
    Assignments result;
    for (const auto& [key, value] : json.items()) {
        const auto isNumber = [](const auto& item) { return finiteFloat(item).has_value(); };
        const bool flat = value.is_string() || isNumber(value) ||
                          (value.is_array() && std::all_of(value.begin(), value.end(), isNumber));
        if (!flat)
            throw InputError(file, fmt::format("'{}' is neither a text nor a number, or is too large", key));
        result.emplace_back(key, textOf(value));
    }
    return result;
}

void apply(const Assignments& assignments, const ChannelTable& table, const std::filesystem::path& file,
           LayerMap& map) {
    for (const auto& [key, value] : assignments) {
        if (const RoleInfo* const role = findRole(key)) {
            setRole(map, *role, value, table, file);
        } else if (std::find(otherKeys.begin(), otherKeys.end(), key) != otherKeys.end()) {
            setEncoding(map.encoding, key, value);
        } else {
            std::string known;
            for (const RoleInfo& each : roleTable) known += std::string(each.name) + ", ";
            throw UsageError(
                fmt::format("'{}' is no layer; they are {}{}", key, known, fmt::join(otherKeys, ", ")));
        }
    }
}

}  // namespace limpid::shot
