// MTL materials to scene::Material. MTL describes Phong shading and is written loosely; this is the reading:
//
//   base colour    Kd, map_Kd (a black Kd under a map counts as white; under one that cannot be read, as
//   grey) emission       Ke, map_Ke (none if the map cannot be read); without Ke: Ka of a material whose name
//   contains "light" (old Cornell boxes) specular       the largest component of Ks; without Ks, or Ks 0 0 0:
//   0, which is Lambertian roughness      (2 / (Ns + 2))^(1/4), so that GGX's lobe is as wide as Phong's; Pr
//   overrides it metallic       Pm, or 0 ior            Ni, if above 1 illum 5        a mirror of colour Ks
//   (Kd if Ks is black) illum 6, 7     glass of index Ni, coloured by Tf; so are 4 and 9 with d < 1 d, Tr = 1
//   - d  otherwise alpha (blend); map_d, if it is the same file as map_Kd: that file's alpha (mask) norm a
//   normal map; "bump" and other maps are ignored with a warning
//
// All materials are double-sided except glass.
#pragma once

#include <map>
#include <string>

#include "scene/device/texture_pool.h"
#include "scene/model/scene.h"
#include "scene/model/scene_files.h"
#include "scene/obj/obj_text.h"

namespace limpid::scene {

/// The material of faces that have none: grey and Lambertian.
Material greyMaterial();

/// Appends the materials of one MTL file to `scene` and their names to `names` (the first of a name counts).
/// A map that cannot be read is a warning (texture_pool.h). Throws InputError naming file and line.
void readMaterials(Lines lines, const std::filesystem::path& folder, SceneFiles& files, TexturePool& textures,
                   Scene& scene, std::map<std::string, int, std::less<>>& names);

}  // namespace limpid::scene
