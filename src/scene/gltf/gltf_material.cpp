#include "scene/gltf/gltf_material.h"

#include <algorithm>
#include <cmath>

namespace limpid::scene::gltf {
namespace {

/// Reads a factor with the range 0 to `most`.
float factor(Document& document, const Object& owner, const char* key, float absent, float most = 1.0f) {
    const float value = owner.number(key, absent);
    const float clamped = std::clamp(value, 0.0f, most);
    if (clamped != value) document.warn(owner.place() + "." + key + " is out of range and clamped");
    return clamped;
}

void readMetallicRoughness(Document& document, const Object& pbr, TextureLibrary& textures,
                           Material& material) {
    const vec4 color = pbr.vector("baseColorFactor", vec4(1.0f));
    material.baseColor = glm::clamp(color, 0.0f, 1.0f);
    if (material.baseColor != color)
        document.warn(pbr.place() + ".baseColorFactor is out of range and clamped");
    material.metallic = factor(document, pbr, "metallicFactor", 1.0f);
    material.roughness = factor(document, pbr, "roughnessFactor", 1.0f);
    material.baseColorTexture = textures.add(pbr, "baseColorTexture", true);
    material.metallicRoughnessTexture = textures.add(pbr, "metallicRoughnessTexture", false);
}

void readEmission(Document& document, const Object& source, TextureLibrary& textures, Material& material) {
    vec3 emission = source.vector("emissiveFactor", vec3(0.0f));
    if (glm::any(glm::greaterThan(emission, vec3(1.0f)))) {
        document.warn(source.place() +
                      ".emissiveFactor is above 1, which glTF leaves to emissive_strength; it is kept");
    }
    emission = glm::max(emission, vec3(0.0f));
    if (const auto extension = source.extension("KHR_materials_emissive_strength")) {
        emission *= factor(document, *extension, "emissiveStrength", 1.0f, 1e30f);
    }
    material.emission = glm::min(emission, vec3(1e30f));
    // A texture that is multiplied by zero need not be loaded.
    if (emission == vec3(0.0f)) return;
    material.emissionTexture = textures.add(source, "emissiveTexture", true);
    // Without the texture, the factor alone would make the whole surface glow.
    if (source.has("emissiveTexture") && !material.emissionTexture) material.emission = vec3(0.0f);
}

void readAlpha(Document& document, const Object& source, Material& material) {
    const std::string mode = source.text("alphaMode", "OPAQUE");
    if (mode == "MASK") {
        material.alphaMode = AlphaMode::Mask;
    } else if (mode == "BLEND") {
        material.alphaMode = AlphaMode::Blend;
    } else if (mode != "OPAQUE") {
        source.fail("alphaMode", "is '" + mode.substr(0, 20) + "', which is none of glTF's");
    }
    // A cutoff above 1 is allowed and hides everything.
    material.alphaCutoff = factor(document, source, "alphaCutoff", 0.5f, 1e6f);
}

void readSpecular(Document& document, const Object& source, TextureLibrary& textures, Material& material) {
    if (const auto ior = source.extension("KHR_materials_ior")) {
        const float value = ior->number("ior", 1.5f);
        // The extension uses 0 for a Fresnel reflectance of 1.
        if (value != 0.0f && value < 1.0f) document.warn(ior->place() + ".ior is below 1 and clamped");
        material.ior = value == 0.0f ? 1e3f : std::clamp(value, 1.0f, 1e3f);
    }
    const auto specular = source.extension("KHR_materials_specular");
    if (!specular) return;
    material.specular = factor(document, *specular, "specularFactor", 1.0f);
    material.specularColor = glm::max(specular->vector("specularColorFactor", vec3(1.0f)), vec3(0.0f));
    // Textures that are multiplied by zero need not be loaded.
    if (material.specular == 0.0f) return;
    material.specularTexture = textures.add(*specular, "specularTexture", false);
    if (material.specularColor == vec3(0.0f)) return;
    material.specularColorTexture = textures.add(*specular, "specularColorTexture", true);
}

void readClearcoat(Document& document, const Object& source, TextureLibrary& textures, Material& material) {
    const auto clearcoat = source.extension("KHR_materials_clearcoat");
    if (!clearcoat) return;
    material.clearcoat = factor(document, *clearcoat, "clearcoatFactor", 0.0f);
    material.clearcoatRoughness = factor(document, *clearcoat, "clearcoatRoughnessFactor", 0.0f);
    if (material.clearcoat == 0.0f) return;
    material.clearcoatTexture = textures.add(*clearcoat, "clearcoatTexture", false);
    material.clearcoatRoughnessTexture = textures.add(*clearcoat, "clearcoatRoughnessTexture", false);
    material.clearcoatNormalTexture = textures.add(*clearcoat, "clearcoatNormalTexture", false);
    if (!material.clearcoatNormalTexture) return;
    material.clearcoatNormalScale = clearcoat->object("clearcoatNormalTexture")->number("scale", 1.0f);
}

/// Reads a colour whose channels have the range 0 to 1.
vec3 colorFactor(Document& document, const Object& owner, const char* key, const vec3& absent) {
    const vec3 value = owner.vector(key, absent);
    const vec3 clamped = glm::clamp(value, 0.0f, 1.0f);
    if (clamped != value) document.warn(owner.place() + "." + key + " is out of range and clamped");
    return clamped;
}

void readAnisotropy(Document& document, const Object& source, TextureLibrary& textures, Material& material) {
    const auto anisotropy = source.extension("KHR_materials_anisotropy");
    if (!anisotropy) return;
    material.anisotropy = factor(document, *anisotropy, "anisotropyStrength", 0.0f);
    if (material.anisotropy == 0.0f) return;
    material.anisotropyRotation = anisotropy->number("anisotropyRotation", 0.0f);
    material.anisotropyTexture = textures.add(*anisotropy, "anisotropyTexture", false);
}

void readSheen(Document& document, const Object& source, TextureLibrary& textures, Material& material) {
    const auto sheen = source.extension("KHR_materials_sheen");
    if (!sheen) return;
    material.sheenColor = colorFactor(document, *sheen, "sheenColorFactor", vec3(0.0f));
    if (material.sheenColor == vec3(0.0f)) return;
    material.sheenRoughness = factor(document, *sheen, "sheenRoughnessFactor", 0.0f);
    material.sheenColorTexture = textures.add(*sheen, "sheenColorTexture", true);
    material.sheenRoughnessTexture = textures.add(*sheen, "sheenRoughnessTexture", false);
}

void readDiffuseTransmission(Document& document, const Object& source, TextureLibrary& textures,
                             Material& material) {
    const auto diffuse = source.extension("KHR_materials_diffuse_transmission");
    if (!diffuse) return;
    material.diffuseTransmission = factor(document, *diffuse, "diffuseTransmissionFactor", 0.0f);
    if (material.diffuseTransmission == 0.0f) return;
    material.diffuseTransmissionTexture = textures.add(*diffuse, "diffuseTransmissionTexture", false);
    material.diffuseTransmissionColor =
        colorFactor(document, *diffuse, "diffuseTransmissionColorFactor", vec3(1.0f));
    material.diffuseTransmissionColorTexture =
        textures.add(*diffuse, "diffuseTransmissionColorTexture", true);
}

void readIridescence(Document& document, const Object& source, TextureLibrary& textures, Material& material) {
    const auto film = source.extension("KHR_materials_iridescence");
    if (!film) return;
    material.iridescence = factor(document, *film, "iridescenceFactor", 0.0f);
    if (material.iridescence == 0.0f) return;
    constexpr float thickest = 1e9f;
    material.iridescenceIor = std::max(factor(document, *film, "iridescenceIor", 1.3f, 1e3f), 1.0f);
    material.iridescenceThicknessMin =
        factor(document, *film, "iridescenceThicknessMinimum", 100.0f, thickest);
    material.iridescenceThicknessMax =
        factor(document, *film, "iridescenceThicknessMaximum", 400.0f, thickest);
    material.iridescenceTexture = textures.add(*film, "iridescenceTexture", false);
    material.iridescenceThicknessTexture = textures.add(*film, "iridescenceThicknessTexture", false);
}

void readTransmission(Document& document, const Object& source, TextureLibrary& textures,
                      Material& material) {
    if (const auto transmission = source.extension("KHR_materials_transmission")) {
        material.transmission = factor(document, *transmission, "transmissionFactor", 0.0f);
        if (material.transmission > 0.0f) {
            material.transmissionTexture = textures.add(*transmission, "transmissionTexture", false);
        }
    }
}

/// The thickness only tells whether the object is solid; the distance inside is traced.
void readVolume(Document& document, const Object& source, Material& material) {
    const auto volume = source.extension("KHR_materials_volume");
    if (!volume) return;
    material.thin = !(volume->number("thicknessFactor", 0.0f) > 0.0f);
    const float distance = volume->number("attenuationDistance", 0.0f);
    const vec3 color = volume->vector("attenuationColor", vec3(1.0f));
    if (color != glm::clamp(color, 0.0f, 1.0f))
        document.warn(volume->place() + ".attenuationColor is out of range and clamped");
    if (!volume->has("attenuationDistance")) return;  // infinite
    if (!(distance > 0.0f)) {
        document.warn(volume->place() + ".attenuationDistance is not positive and ignored");
        return;
    }
    // KHR_materials_volume, "Attenuation"; black would be infinitely dense.
    for (int c = 0; c < 3; ++c) {
        material.absorption[c] = std::min(-std::log(std::clamp(color[c], 1e-30f, 1.0f)) / distance, 1e30f);
    }
}

}  // namespace

Material readMaterial(Document& document, const Object& source, TextureLibrary& textures) {
    Material material;
    material.name = source.text("name", source.place());
    if (const auto pbr = source.object("pbrMetallicRoughness")) {
        readMetallicRoughness(document, *pbr, textures, material);
    }
    material.normalTexture = textures.add(source, "normalTexture", false);
    if (material.normalTexture) material.normalScale = source.object("normalTexture")->number("scale", 1.0f);
    material.occlusionTexture = textures.add(source, "occlusionTexture", false);
    if (material.occlusionTexture) {
        material.occlusionStrength = factor(document, *source.object("occlusionTexture"), "strength", 1.0f);
    }
    readEmission(document, source, textures, material);
    readAlpha(document, source, material);
    readSpecular(document, source, textures, material);
    readTransmission(document, source, textures, material);
    readVolume(document, source, material);
    if (const auto dispersion = source.extension("KHR_materials_dispersion"))
        material.dispersion = factor(document, *dispersion, "dispersion", 0.0f, 1e3f);
    readAnisotropy(document, source, textures, material);
    readIridescence(document, source, textures, material);
    readSheen(document, source, textures, material);
    readDiffuseTransmission(document, source, textures, material);
    readClearcoat(document, source, textures, material);
    material.doubleSided = source.boolean("doubleSided", false);
    material.unlit = source.extension("KHR_materials_unlit").has_value();
    return material;
}

}  // namespace limpid::scene::gltf
