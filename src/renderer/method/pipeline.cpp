#include "renderer/method/pipeline.h"

#include <algorithm>

#include "base/error.h"
#include "renderer/layers/layers.h"

namespace limpid {

const std::vector<Integrator>& integrators() {
    static const std::vector<Integrator> all{Integrator::Path, Integrator::Direct,
                                             Integrator::AmbientOcclusion, Integrator::GBuffer,
                                             Integrator::Preview};
    return all;
}

std::string_view nameOf(Integrator integrator) {
    switch (integrator) {
        case Integrator::Path:
            return "path";
        case Integrator::Direct:
            return "direct";
        case Integrator::AmbientOcclusion:
            return "ao";
        case Integrator::GBuffer:
            return "gbuffer";
        case Integrator::Preview:
            break;
    }
    return "preview";
}

std::string_view helpOf(Integrator integrator) {
    switch (integrator) {
        case Integrator::Path:
            return "path tracing: all light";
        case Integrator::Direct:
            return "path tracing of one bounce: direct light only";
        case Integrator::AmbientOcclusion:
            return "ambient occlusion: the unoccluded share at each visible point";
        case Integrator::GBuffer:
            return "visible surfaces with direct light from one sampled light";
        case Integrator::Preview:
            break;
    }
    return "visible surfaces, shaded by a light at the camera: fast, for navigation";
}

bool canBeDenoised(Integrator integrator) {
    return integrator != Integrator::GBuffer && integrator != Integrator::Preview;
}

bool canBeDenoised(Integrator integrator, const denoise::Denoiser& denoiser) {
    return canBeDenoised(integrator) && (!denoiser.oneChannel || integrator == Integrator::AmbientOcclusion);
}

Integrator integratorFor(const denoise::Denoiser& denoiser, Integrator wanted) {
    if (canBeDenoised(wanted, denoiser)) return wanted;
    return denoiser.oneChannel ? Integrator::AmbientOcclusion : Integrator::Path;
}

Integrator parseIntegrator(std::string_view name) {
    std::string names;
    for (const Integrator integrator : integrators()) {
        if (nameOf(integrator) == name) return integrator;
        names += " " + std::string(nameOf(integrator));
    }
    throw UsageError("--integrator: there is no '" + std::string(name) + "'; the integrators are" + names);
}

std::string_view nameOf(const denoise::Denoiser* denoiser) {
    return denoiser ? denoiser->name : "none";
}

std::vector<std::string_view> denoiserNames() {
    std::vector<std::string_view> names{nameOf(nullptr)};
    for (const denoise::Denoiser& denoiser : denoise::denoisers()) names.push_back(denoiser.name);
    return names;
}

const denoise::Denoiser* parseDenoiser(std::string_view name) {
    if (name == nameOf(nullptr)) return nullptr;
    if (const denoise::Denoiser* denoiser = denoise::findDenoiser(name)) return denoiser;
    if (name == "history") throw UsageError("--denoiser history is now --denoiser temporal");
    std::string names;
    for (const std::string_view each : denoiserNames()) names += " " + std::string(each);
    throw UsageError("--denoiser: there is no '" + std::string(name) + "'; the denoisers are" + names);
}

std::string Pipeline::options() const {
    return "--integrator " + std::string(nameOf(integrator)) + " --denoiser " + std::string(nameOf(denoiser));
}

std::string Pipeline::title() const {
    return std::string(nameOf(integrator)) + (denoiser ? ", " + std::string(denoiser->name) : "");
}

std::vector<std::string> Pipeline::layers() const {
    std::vector<std::string> names = layerNames();
    if (denoiser || !takesOneSampleALaunch()) return names;
    std::erase(names, "specular");
    std::erase(names, "variance");
    if (!needsExposure()) std::erase(names, "diffuse");
    if (!needsExposure()) std::erase(names, "emission");
    return names;
}

const std::vector<Pipeline>& pipelines() {
    static const std::vector<Pipeline> all = [] {
        std::vector<Pipeline> list;
        for (const Integrator integrator : integrators()) {
            list.push_back({integrator});
            for (const denoise::Denoiser& denoiser : denoise::denoisers())
                if (canBeDenoised(integrator, denoiser)) list.push_back({integrator, &denoiser});
        }
        return list;
    }();
    return all;
}

Pipeline parsePipeline(std::string_view integrator, std::string_view denoiser) {
    const Pipeline pipeline{parseIntegrator(integrator), parseDenoiser(denoiser)};
    if (!pipeline.denoiser || canBeDenoised(pipeline.integrator, *pipeline.denoiser)) return pipeline;
    if (canBeDenoised(pipeline.integrator))
        throw UsageError("--denoiser " + std::string(denoiser) + " is not for --integrator " +
                         std::string(integrator) + ": it filters one channel; use it with --integrator ao");
    const char* const why =
        pipeline.integrator == Integrator::Preview
            ? "it has no noise"
            : "it has no light signals for a denoiser; --integrator direct has the same light with them";
    throw UsageError("--integrator " + std::string(integrator) + " takes no denoiser: " + why);
}

}  // namespace limpid
