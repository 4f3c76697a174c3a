#include "shot/layers/conventions.h"

#include "base/layers/layer_table.h"

namespace limpid::shot {
namespace {

/// Light by closure, with the names up to Blender 4.5 and since 5.0. What the closures do not tell (volumes)
/// is in the beauty, and becomes specular light.
std::vector<Rule> cyclesRules() {
    return {
        {"diffuse", "DiffCol.RGB * DiffDir.RGB + DiffCol.RGB * DiffInd.RGB", true},
        {"diffuse", "Diffuse Color.RGB * Diffuse Direct.RGB + Diffuse Color.RGB * Diffuse Indirect.RGB",
         true},
        {"specular",
         "GlossCol.RGB * GlossDir.RGB + GlossCol.RGB * GlossInd.RGB + TransCol.RGB * TransDir.RGB + "
         "TransCol.RGB * TransInd.RGB",
         true},
        {"specular",
         "Glossy Color.RGB * Glossy Direct.RGB + Glossy Color.RGB * Glossy Indirect.RGB + "
         "Transmission Color.RGB * Transmission Direct.RGB + "
         "Transmission Color.RGB * Transmission Indirect.RGB",
         true},
        {"emission", "Emit.RGB"},
        {"emission", "Emission.RGB"},
        {"background", "Env.RGB"},
        {"background", "Environment.RGB"},
        {"albedo", "DiffCol.RGB"},
        {"albedo", "Diffuse Color.RGB"},
        {"albedo", "Denoising Albedo.RGB"},
        {"albedoSpecular", "GlossCol.RGB + TransCol.RGB", true},
        {"albedoSpecular", "Glossy Color.RGB + Transmission Color.RGB", true},
        {"albedoReflected", "GlossCol.RGB"},
        {"albedoReflected", "Glossy Color.RGB"},
        {"mirroredEmission", "GlossCol.RGB * GlossDir.RGB"},
        {"mirroredEmission", "Glossy Color.RGB * Glossy Direct.RGB"},
        {"normal", "Normal.XYZ"},
        {"normal", "Denoising Normal.XYZ"},
        {"cameraNormal", "Denoising Normal.XYZ"},
        {"seenAlbedo", "Denoising Albedo.RGB"},
        {"depth", "Depth.?"},
        {"depth", "Denoising Depth.?"},
        {"distance", "Denoising Depth.?"},
        {"position", "Position.XYZ"},
        {"motion", "Vector.XY"},
        {"id", "IndexOB.?"},
        {"id", "Object Index.?"},
        {"roughness", "Roughness.?"},
    };
}

void normalInCamera(Encoding& e) {
    e.normalSpace = NormalSpace::Camera;
    e.normalScale = {1.0f, 1.0f, -1.0f};
}

void depthAlongTheRay(Encoding& e) {
    e.depthKind = DepthKind::Distance;
}

Convention cycles() {
    Convention c{.renderer = "Cycles (Blender)",
                 .beauties = {"Combined.RGB"},
                 .rules = cyclesRules(),
                 .encodingRules = {{"depth", "Denoising Depth.?", depthAlongTheRay},
                                   {"normal", "Denoising Normal.XYZ", normalInCamera}},
                 .group = "Combined_",
                 .noisy = "Noisy Image.RGB",
                 .hasIndependentPixels = true,
                 .composite = "Composite."};
    c.encoding.worldUp = UpAxis::Z;
    c.encoding.depthKind = DepthKind::Planar;
    c.encoding.cameraNormalScale = {1.0f, 1.0f, -1.0f};
    c.encoding.motionScale = {1.0f, -1.0f};  // y points up
    return c;
}

/// Layers of the table have their own names. `specular` and others are in files of other renderers, too.
Convention limpidFiles() {
    Convention c{.renderer = "Limpid",
                 .beauties = {"RGB"},
                 .evidence = {"@limpid.version", "@limpid.camera", "albedoSpecular", "prevNormal"},
                 .rules = {{"diffuse", "diffuse.RGB"},
                           {"specular", "specular.RGB"},
                           {"emission", "emission.RGB"},
                           {"albedo", "albedo.RGB"},
                           {"albedoSpecular", "albedoSpecular.RGB"},
                           {"normal", "normal.XYZ"},
                           {"depth", "depth.Z"},
                           {"motion", "motion.XY"},
                           {"id", "id.I"},
                           {"roughness", "roughness.R"}}};
    return c;
}

/// Light is with albedo, as `diffuse` includes the sum of its direct and indirect parts.
Convention arnold() {
    Convention c{.renderer = "Arnold",
                 .beauties = {"RGB", "RGBA.RGB"},
                 .evidence = {"@arnold/version", "denoise_albedo"},
                 .rules = {{"diffuse", "diffuse.RGB"},
                           {"diffuse", "diffuse_direct.RGB + diffuse_indirect.RGB"},
                           {"specular",
                            "specular.RGB + coat.RGB + sheen.RGB + transmission.RGB + sss.RGB + "
                            "volume.RGB",
                            true},
                           {"emission", "emission.RGB + background.RGB", true},
                           {"albedo", "diffuse_albedo.RGB"},
                           {"albedo", "denoise_albedo.RGB"},
                           {"albedo", "albedo.RGB"},
                           {"albedoSpecular", "specular_albedo.RGB"},
                           {"normal", "N.XYZ"},
                           {"depth", "Z"},
                           {"depth", "Z.?"},
                           {"motion", "motionvector.XY"}},
                 .group = "RGBA_"};
    c.encoding.depthKind = DepthKind::Planar;
    c.encoding.motionScale = {-1.0f, 1.0f};  // forwards, y up
    return c;
}

Convention renderMan() {
    Convention c{.renderer = "RenderMan",
                 .beauties = {"Ci.RGB", "RGB"},
                 .evidence = {"Ci", "mse", "albedo_mse", "normal_mse", "zfiltered", "motionBack"},
                 .rules = {{"diffuse", "diffuse.RGB"},
                           {"specular", "specular.RGB"},
                           {"albedo", "albedo.RGB"},
                           {"normal", "normal.XYZ"},
                           {"normal", "Nn.XYZ"},
                           {"depth", "zfiltered.?"},
                           {"depth", "zfiltered"},
                           {"depth", "z.?"},
                           {"depth", "z"},
                           {"motion", "motionBack.XY"},
                           {"motion", "backward.XY"},
                           {"alpha", "a"}},
                 .group = "Ci_"};
    normalInCamera(c.encoding);
    c.encoding.depthKind = DepthKind::Planar;
    return c;
}

/// GBufferFilm in its default coordinate system, "camera".
Convention pbrt() {
    Convention c{.renderer = "pbrt-v4",
                 .beauties = {"RGB"},
                 .evidence = {"RelativeVariance"},
                 .rules = {{"albedo", "Albedo.RGB"},
                           {"normal", "Ns.XYZ"},
                           {"normal", "N.XYZ"},
                           {"depth", "P.Z"},
                           {"depth", "Pz"}},
                 .hasIndependentPixels = true};
    normalInCamera(c.encoding);
    c.encoding.depthKind = DepthKind::Planar;
    return c;
}

/// Its users choose the layers' names, so these are the usual ones; a distance is known by its component. So
/// is an index, but only a shape's is an object's: prim_index is another one for each triangle.
Convention mitsuba() {
    return {.renderer = "Mitsuba 3",
            .beauties = {"RGB"},
            .evidence = {"@generatedBy=Mitsuba"},
            .rules = {{"albedo", "albedo.RGB"},
                      {"albedo", "albedos.RGB"},
                      {"normal", "nn.XYZ"},
                      {"normal", "sh_normal.XYZ"},
                      {"normal", "normal.XYZ"},
                      {"normal", "normals.XYZ"},
                      {"normal", "geo_normal.XYZ"},
                      {"depth", "*.T"},
                      {"id", "shape_index.I"},
                      {"id", "shape.I"},
                      {"id", "id.I"}}};
}

Convention karma() {
    Convention c{
        .renderer = "Karma",
        .beauties = {"C.RGB", "RGB", "rgba.RGB", "beauty.RGB"},
        .evidence = {"combineddiffuse", "combinedglossyreflection", "albedodiffuse", "motionvectors"},
        .rules = {{"diffuse", "combineddiffuse.RGB"},
                  {"diffuse", "directdiffuse.RGB + indirectdiffuse.RGB"},
                  {"specular",
                   "combinedglossyreflection.RGB + glossytransmission.RGB + coat.RGB + "
                   "sss.RGB",
                   true},
                  {"emission", "combinedemission.RGB"},
                  {"albedo", "albedodiffuse.RGB"},
                  {"albedo", "albedo.RGB"},
                  {"albedo", "basecolor.RGB"},
                  {"albedoSpecular", "albedoglossyreflection.RGB"},
                  {"normal", "N.XYZ"},
                  {"depth", "depth.?"},
                  {"motion", "motionvectors.XY"}}};
    c.encoding.depthKind = DepthKind::Planar;
    c.encoding.motionUnit = MotionUnit::Picture;
    c.encoding.motionScale = {-0.5f, 0.5f};  // forwards, from -1 to 1, y up
    c.group = "C_";
    return c;
}

/// Names that many programs share, among them what denoisers of single frames take.
Convention anyRenderer() {
    return {.renderer = "unknown",
            .beauties = {"RGB", "rgba.RGB", "RGBA.RGB", "beauty.RGB", "Beauty.RGB", "C.RGB", "color.RGB",
                         "Color.RGB", "hdr.RGB"},
            .rules = {{"diffuse", "diffuse.RGB"},
                      {"specular", "specular.RGB"},
                      {"emission", "emission.RGB"},
                      {"albedo", "albedo.RGB"},
                      {"albedo", "Albedo.RGB"},
                      {"albedo", "alb.RGB"},
                      {"albedo", "diffuse_albedo.RGB"},
                      {"albedo", "basecolor.RGB"},
                      {"albedo", "DiffuseFilter.RGB"},
                      {"albedo", "VRayDiffuseFilter.RGB"},
                      {"normal", "normal.XYZ"},
                      {"normal", "Normal.XYZ"},
                      {"normal", "normals.XYZ"},
                      {"normal", "Normals.XYZ"},
                      {"normal", "N.XYZ"},
                      {"normal", "nrm.XYZ"},
                      {"depth", "depth.?"},
                      {"depth", "Depth.?"},
                      {"depth", "depth"},
                      {"depth", "Z"},
                      {"depth", "z"},
                      {"motion", "motion.XY"},
                      {"id", "id.?"},
                      {"roughness", "roughness.?"}}};
}

}  // namespace

std::span<const Convention> conventions() {
    static const std::vector<Convention> all = {limpidFiles(), cycles(),  renderMan(), arnold(),
                                                pbrt(),        mitsuba(), karma(),     anyRenderer()};
    return all;
}

}  // namespace limpid::shot
