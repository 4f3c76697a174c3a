#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "base/error.h"
#include "scene/device/mip_levels.h"
#include "scene/device/pack.h"

namespace limpid::scene {
namespace {

constexpr uint64_t texelsPerBuffer = uint64_t{1} << layout::TEXEL_BUFFER_SHIFT;

/// Places a texture in the first texel buffer with enough space.
TexturePlaces::Place placed(const Texture& texture, TexturePlaces& places) {
    const uint64_t texels = mipTexelCount(texture);
    for (uint32_t index = 0; index < layout::TEXEL_BUFFERS; ++index) {
        uint64_t& used = places.used[index];
        if (used + texels > texelsPerBuffer) continue;
        used += texels;
        return {index, static_cast<uint32_t>(used - texels)};
    }
    throw Error(
        fmt::format("texture '{}' does not fit: all textures together exceed the limit of {} x 2^27 texels",
                    texture.name, layout::TEXEL_BUFFERS));
}

uint32_t samplerBits(const Texture& texture, const TextureRef& ref) {
    const Sampler& s = texture.sampler;
    uint32_t result = static_cast<uint32_t>(s.wrapU) << layout::TEXTURE_WRAP_U_SHIFT |
                      static_cast<uint32_t>(s.wrapV) << layout::TEXTURE_WRAP_V_SHIFT |
                      static_cast<uint32_t>(s.mip) << layout::TEXTURE_MIP_SHIFT;
    if (s.magLinear) result |= layout::TEXTURE_MAG_LINEAR;
    if (s.minLinear) result |= layout::TEXTURE_MIN_LINEAR;
    if (texture.srgb) result |= layout::TEXTURE_SRGB;
    if (ref.uvSet == 1) result |= layout::TEXTURE_UV1;
    return result;
}

class MaterialPacker {
  public:
    MaterialPacker(const Scene& scene, SceneData& data) : scene_(scene), data_(data) {
        places_.places.resize(scene.textures.size());
    }

    TexturePlaces pack() {
        for (const Material& material : scene_.materials) packMaterial(material);
        return std::move(places_);
    }

  private:
    uint32_t packRef(const TextureRef& ref) {
        if (!ref) return layout::NONE;
        data_.features.textures = true;
        const auto index = static_cast<size_t>(ref.texture);
        const Texture& texture = scene_.textures[index];
        std::optional<TexturePlaces::Place>& place = places_.places[index];
        if (!place) place = placed(texture, places_);
        const auto result = static_cast<uint32_t>(data_.textureRefs.size() / layout::TEXTURE_REF_TEXELS);
        data_.textureRefs.push_back(
            bits(ref.rowU, place->buffer << layout::TEXEL_BUFFER_SHIFT | place->first));
        data_.textureRefs.push_back(bits(ref.rowV, samplerBits(texture, ref)));
        data_.textureRefs.emplace_back(texture.width, texture.height, mipLevelCount(texture), 0);
        return result;
    }

    static uint32_t flagBits(const Material& m) {
        uint32_t flags = 0;
        if (m.alphaMode == AlphaMode::Mask) flags |= layout::MATERIAL_MASK;
        if (m.alphaMode == AlphaMode::Blend) flags |= layout::MATERIAL_BLEND;
        if (m.doubleSided) flags |= layout::MATERIAL_DOUBLE_SIDED;
        if (m.unlit) flags |= layout::MATERIAL_UNLIT;
        if (m.thin) flags |= layout::MATERIAL_THIN;
        if (isEmitter(m)) flags |= layout::MATERIAL_EMISSIVE;
        return flags;
    }

    void packMaterial(const Material& m) {
        SceneFeatures& features = data_.features;
        const float clearcoat = m.unlit ? 0.0f : m.clearcoat;
        const bool lambertian =
            m.metallic == 0.0f && m.specular == 0.0f && m.transmission == 0.0f && clearcoat == 0.0f;
        packFeaturesOfExtensions(m);
        features.specular |= !lambertian && !m.unlit;
        features.transmission |= m.transmission > 0.0f && !m.unlit;
        features.panes |= m.transmission > 0.0f && !m.unlit && m.thin &&
                          (m.roughness < layout::SMOOTH_ROUGHNESS || m.metallicRoughnessTexture);
        features.roughGlass |= m.transmission > 0.0f && !m.unlit && !m.thin &&
                               (m.roughness >= layout::SMOOTH_ROUGHNESS || m.anisotropy > 0.0f);
        features.clearcoat |= clearcoat > 0.0f;
        features.volume |=
            (m.transmission > 0.0f || m.diffuseTransmission > 0.0f) && !m.thin && m.absorption != vec3(0.0f);
        features.specularTextures |= m.specularTexture || m.specularColorTexture;
        features.alpha |= m.alphaMode != AlphaMode::Opaque;
        features.blended |= m.alphaMode == AlphaMode::Blend;
        auto& out = data_.materials;
        out.push_back(bits(vec3(m.baseColor), flagBits(m)));
        out.push_back(bits(m.emission, m.roughness));
        out.emplace_back(bits(m.metallic), bits(m.specular), bits(m.ior), bits(m.transmission));
        out.emplace_back(bits(m.baseColor.a), bits(m.alphaCutoff), bits(m.normalScale), 0);
        const uint32_t base = packRef(m.baseColorTexture), rough = packRef(m.metallicRoughnessTexture);
        const uint32_t normal = packRef(m.normalTexture), emission = packRef(m.emissionTexture);
        out.emplace_back(base, rough, normal, emission);
        out.emplace_back(packRef(m.transmissionTexture), bits(m.specularColor.r), bits(m.specularColor.g),
                         bits(m.specularColor.b));
        const uint32_t specular = packRef(m.specularTexture), color = packRef(m.specularColorTexture);
        const uint32_t coat = packRef(m.clearcoatTexture), coatRough = packRef(m.clearcoatRoughnessTexture);
        out.emplace_back(specular, color, coat, coatRough);
        out.emplace_back(packRef(m.clearcoatNormalTexture), bits(clearcoat), bits(m.clearcoatRoughness),
                         bits(m.clearcoatNormalScale));
        out.push_back(bits(m.absorption, m.dispersion));
        packExtensions(m);
    }

    /// The shaders for sheen and diffuse transmission build on those for materials that are not Lambertian.
    void packFeaturesOfExtensions(const Material& m) {
        if (m.unlit) return;
        SceneFeatures& features = data_.features;
        features.anisotropy |= m.anisotropy > 0.0f;
        features.sheen |= m.sheenColor != vec3(0.0f);
        features.diffuseTransmission |= m.diffuseTransmission > 0.0f;
        features.dispersion |= m.dispersion > 0.0f && m.transmission > 0.0f && !m.thin;
        features.iridescence |= m.iridescence > 0.0f;
        features.specular |=
            features.iridescence || features.anisotropy || features.sheen || features.diffuseTransmission;
    }

    void packExtensions(const Material& m) {
        auto& out = data_.materials;
        const float on = m.unlit ? 0.0f : 1.0f;
        const uint32_t anisotropy = packRef(m.anisotropyTexture);
        out.emplace_back(bits(on * m.anisotropy), bits(std::cos(m.anisotropyRotation)),
                         bits(std::sin(m.anisotropyRotation)), anisotropy);
        out.push_back(bits(on * m.sheenColor, m.sheenRoughness));
        const uint32_t sheen = packRef(m.sheenColorTexture), sheenRough = packRef(m.sheenRoughnessTexture);
        const uint32_t share = packRef(m.diffuseTransmissionTexture);
        out.emplace_back(sheen, sheenRough, share, packRef(m.diffuseTransmissionColorTexture));
        out.push_back(bits(m.diffuseTransmissionColor, on * m.diffuseTransmission));
        out.emplace_back(bits(on * m.iridescence), bits(m.iridescenceIor), bits(m.iridescenceThicknessMin),
                         bits(m.iridescenceThicknessMax));
        const uint32_t film = packRef(m.iridescenceTexture);
        out.emplace_back(film, packRef(m.iridescenceThicknessTexture), layout::NONE, layout::NONE);
    }

    const Scene& scene_;
    SceneData& data_;
    TexturePlaces places_;
};

}  // namespace

TexturePlaces packMaterials(const Scene& scene, SceneData& data) {
    return MaterialPacker(scene, data).pack();
}

void fillTexels(const TexturePlaces& places, const Scene& scene, SceneData& data, const Progress& progress) {
    for (size_t i = 0; i < data.texels.size(); ++i) data.texels[i].resize(places.used[i]);
    std::atomic<size_t> done = 0;
    // Each texture's levels are made by one thread.
    tbb::parallel_for(size_t{0}, scene.textures.size(), [&](size_t i) {
        if (const auto& place = places.places[i]) {
            const Texture& texture = scene.textures[i];
            writeMipLevels(
                texture, std::span(data.texels[place->buffer]).subspan(place->first, mipTexelCount(texture)));
        }
        progress.at(++done, scene.textures.size());
    });
}

}  // namespace limpid::scene
