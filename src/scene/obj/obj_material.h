// Converts MTL materials to scene::Material. MTL describes Phong shading loosely; Limpid reads it like this:
//
// - Kd, map_Kd: base colour. A black Kd with a map counts as white; if the map cannot be read, as grey.
// - Ke, map_Ke: emission (none if the map cannot be read). Without Ke: Ka, if the material's name contains
// "light" (old Cornell boxes).
// - Ks: its largest component is `specular`. Without Ks, or with Ks 0 0 0: 0, which is Lambertian.
// - Ns: roughness (2 / (Ns + 2))^(1/4), which makes GGX's lobe as wide as Phong's; Pr overrides it.
// - Pm: metallic, or 0.
// - Ni: ior, if above 1.
// - illum 5: a mirror of colour Ks (Kd if Ks is black).
// - illum 6, 7: glass of index Ni, coloured by Tf; also 4 and 9 with d < 1.
// - d, Tr = 1 - d: alpha for all other materials (blend). map_d, if it is the same file as map_Kd: that
// file's alpha (mask).
// - norm: a normal map. "bump" and other maps are ignored with a warning.
//
// All materials are double-sided except glass.
#pragma once

#include <map>
#include <string>

#include "scene/device/texture_pool.h"
#include "scene/load/scene_files.h"
#include "scene/model/scene.h"
#include "scene/obj/obj_text.h"

namespace limpid::scene {

/// The material of faces without one: grey and Lambertian.
Material greyMaterial();

/// Appends the materials of an MTL file to `scene`, and their names to `names` (the first use of a name
/// counts). Warns about maps that cannot be read (texture_pool.h). Throws InputError naming file and line.
void readMaterials(Lines lines, const std::filesystem::path& folder, SceneFiles& files, TexturePool& textures,
                   Scene& scene, std::map<std::string, int, std::less<>>& names);

}  // namespace limpid::scene
