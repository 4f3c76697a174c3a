#include "shot/explain.h"

#include <fmt/format.h>

#include <map>
#include <set>

namespace limpid::shot {
namespace {

std::string encodingOf(std::string_view role, const Encoding& e) {
    if (role == "normal") {
        std::string text = e.normalSpace == NormalSpace::World ? "world space" : "camera space";
        if (e.normalSpace == NormalSpace::World && e.worldUp == UpAxis::Z) text += ", z up";
        const vec3 s = e.normalScale;
        if (s != vec3(1.0f)) text += fmt::format(", times {},{},{}", s.x, s.y, s.z);
        return text;
    }
    if (role == "depth")
        return e.depthKind == DepthKind::Planar ? "along the camera's axis" : "along the ray";
    if (role == "motion") {
        const vec2 s = e.motionScale;
        return fmt::format("{}, times {},{}: previous minus this position, y down",
                           e.motionUnit == MotionUnit::Pixels ? "pixels" : "shares of the picture", s.x, s.y);
    }
    return {};
}

std::set<std::string> channelsOf(const LayerMap& map) {
    std::set<std::string> used;
    const auto add = [&](const LayerExpression& expression) {
        for (const Term& term : expression.terms())
            for (const Factor& factor : term.factors)
                for (const ChannelPlace& place : factor.channels)
                    used.insert(fmt::format("{} {}", place.part, place.channel));
    };
    for (const auto& [role, expression] : map.layers) add(expression);
    for (const LayerExpression& group : map.groups) add(group);
    add(map.target());
    return used;
}

std::string explainPicture(const LayerMap& map) {
    std::string text;
    if (!map.title.empty() || !map.view.empty()) text += pictureLine(map);
    for (const RoleInfo& role : roles()) {
        const LayerExpression* const layer = map.find(role.name);
        if (!layer) continue;
        const std::string encoding = encodingOf(role.name, map.encoding);
        text += fmt::format("    {:<15} {}{}\n", role.name, layer->text(),
                            encoding.empty() ? "" : fmt::format(" ({})", encoding));
    }
    for (const RoleInfo& role : roles())
        if (!map.find(role.name) && !role.without.empty())
            text += fmt::format("    no {:<12} {}\n", role.name, withoutRole(map, role));
    for (const LayerExpression& group : map.groups)
        text += fmt::format("    light group     {}\n", group.text());
    return text;
}

}  // namespace

std::string pictureLine(const LayerMap& map) {
    if (map.view.empty()) return fmt::format("  picture '{}'\n", map.title);
    return fmt::format("  {}view '{}' (names are given without it)\n",
                       map.title.empty() ? "" : fmt::format("picture '{}', ", map.title), map.view);
}

std::string explainLayers(const LoadedFrame& frame) {
    const auto parts = frame.file.parts();
    std::string text = fmt::format(
        "{}: layers of {}, {}x{} pixels, {} part{}, {}\n", frame.file.name().string(),
        frame.maps.front().renderer.empty() ? "unknown" : frame.maps.front().renderer, frame.file.width(),
        frame.file.height(), parts.size(), parts.size() == 1 ? "" : "s", parts.front().compression);
    std::set<std::string> used;
    for (const LayerMap& map : frame.maps) {
        text += explainPicture(map);
        used.merge(channelsOf(map));
    }
    std::map<std::string, std::string> unused;  // components by layer
    std::string list;
    for (size_t p = 0; p < parts.size(); ++p) {
        if (!parts[p].unreadable.empty())
            list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", parts[p].name, parts[p].unreadable);
        for (const auto& channel : parts[p].channels) {
            if (!parts[p].unreadable.empty() || used.contains(fmt::format("{} {}", p, channel.name)))
                continue;
            const ChannelName name = split(channel.name);
            std::string& components = unused[std::string(name.layer)];
            components = std::string(name.component) + components;  // files sort them: B, G, R
        }
    }
    for (const auto& [layer, components] : unused)
        list += (list.empty() ? "" : ", ") + joined(layer, components);
    if (!list.empty()) text += fmt::format("    not used: {}\n", list);
    for (const std::string& warning : frame.warnings) text += fmt::format("    {}\n", warning);
    return text;
}

std::string explainMotion(const MotionCheck& check, int before, int now, bool searched) {
    std::string text;
    if (searched)
        text = fmt::format("    searched motion is found for {:.0f} % of the pixels\n", 100.0 * check.share);
    if (check.still())
        return text + fmt::format("    motion: frames {} and {} hardly differ, so it cannot be checked\n",
                                  before, now);
    text += fmt::format("    motion explains {:.0f} % of the change between frames {} and {}\n",
                        100.0 * check.explained, before, now);
    if (!check.better.empty() && !searched)
        text += fmt::format("    is its sign right? --map {} would explain {:.0f} %\n", check.better,
                            100.0 * check.betterExplained);
    return text;
}

std::string explainVariances(const LoadedFrame& frame) {
    std::string names;
    for (const LayerInfo* layer : frame.estimated)
        names += (names.empty() ? "" : ", ") + std::string(layer->name);
    if (names.empty()) return {};
    return "variances are estimated from the neighbourhood: no layers are known for those of " + names;
}

std::string explainView(const FrameReport& report) {
    std::string text;
    if (report.camera == CameraSource::Given) {
        text = report.horizontalFov > 0.0f
                   ? fmt::format("    camera: given, {:.1f} degrees wide\n", report.horizontalFov)
                   : "    camera: given, orthographic\n";
    } else if (report.camera == CameraSource::Solved) {
        text = fmt::format("    camera: from the layers, {:.1f} degrees wide", report.horizontalFov);
        text += report.inliers > 0.0f
                    ? fmt::format("; its movement fits {:.0f} % of the motion\n", 100.0f * report.inliers)
                    : "\n";
    } else {
        text = fmt::format("    camera: unknown; supposed to be {:.0f} degrees wide (--camera gives it)\n",
                           report.horizontalFov);
    }
    if (report.lightShare < 0.99)
        text += fmt::format("    {:.0f} % of the beauty is in no layer of light and counts as specular\n",
                            100.0 * (1.0 - report.lightShare));
    for (const std::string& problem : report.problems) text += fmt::format("    {}\n", problem);
    return text;
}

}  // namespace limpid::shot
