#include "renderer/frame/pipeline.h"

#include "base/error.h"
#include "renderer/layers/layers.h"

namespace limpid {

std::string_view Pipeline::name() const {
    switch (kind) {
        case Kind::Path:
            return "path";
        case Kind::GBuffer:
            return "gbuffer";
        case Kind::AmbientOcclusion:
            return "ao";
        case Kind::Preview:
            return "preview";
        case Kind::Denoised:
            break;
    }
    return denoiser->name;
}

std::string_view Pipeline::help() const {
    switch (kind) {
        case Kind::Path:
            return "the path tracer alone, accumulated progressively";
        case Kind::GBuffer:
            return "what the camera sees, lit by the lights directly, without a bounce";
        case Kind::AmbientOcclusion:
            return "ambient occlusion: how open each visible point is";
        case Kind::Preview:
            return "what the camera sees, shaded by a light at the camera: fast, for finding one's way";
        case Kind::Denoised:
            break;
    }
    return denoiser->help;
}

std::vector<std::string> Pipeline::layers() const {
    std::vector<std::string> names = layerNames();
    if (takesOneSampleALaunch()) std::erase(names, "specular");
    if (takesOneSampleALaunch()) std::erase(names, "variance");
    if (!needsExposure()) std::erase(names, "diffuse");
    if (!needsExposure()) std::erase(names, "emission");
    return names;
}

const std::vector<Pipeline>& pipelines() {
    static const std::vector<Pipeline> all = [] {
        std::vector<Pipeline> list{{Pipeline::Kind::Path},
                                   {Pipeline::Kind::GBuffer},
                                   {Pipeline::Kind::AmbientOcclusion},
                                   {Pipeline::Kind::Preview}};
        for (const denoise::Denoiser& denoiser : denoise::denoisers())
            list.push_back({Pipeline::Kind::Denoised, &denoiser});
        return list;
    }();
    return all;
}

Pipeline parsePipeline(std::string_view name) {
    std::string names;
    for (const Pipeline& pipeline : pipelines()) {
        if (pipeline.name() == name) return pipeline;
        names += " " + std::string(pipeline.name());
    }
    throw UsageError("there is no pipeline '" + std::string(name) + "'; the pipelines are" + names);
}

}  // namespace limpid
