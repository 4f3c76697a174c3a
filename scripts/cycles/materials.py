"""Creates each material twice: as a Principled node for Blender's glTF exporter, and as simple nodes for Cycles.

The Principled node of Cycles 3.4 differs from glTF's material: its diffuse part is not Lambert's, and its parts
together reflect more light than they receive. So Cycles renders simple nodes instead. `GLTF` has glTF fields that the
exporter does not write; they are merged into the exported material of the same name.
"""

import math

import bpy

GLTF = {}  # material name -> glTF fields
_for_cycles = []  # (material, output socket of its simple nodes)


def clear():
    GLTF.clear()
    _for_cycles.clear()


def use_cycles_nodes():
    """Switches all materials to their simple nodes. Call it after the export."""
    for material, socket in _for_cycles:
        tree = material.node_tree
        tree.links.new(socket, tree.nodes["Material Output"].inputs["Surface"])


def principled(name, **inputs):
    """Creates a Principled material. `inputs` name the node's inputs with underscores for spaces, such as
    Base_Color=(r, g, b). A node as value is linked."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = material.node_tree.nodes["Principled BSDF"]
    for key, value in inputs.items():
        socket = node.inputs[key.replace("_", " ")]
        if isinstance(value, bpy.types.Node):
            material.node_tree.links.new(value.outputs["Color"], socket)
        else:
            socket.default_value = (*value, 1) if isinstance(value, tuple) else value
    return material


def picture(material, image, interpolation="Closest"):
    """Adds an image node to the material."""
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image, node.interpolation = image, interpolation
    return node


def link(material, source, target):
    material.node_tree.links.new(source, target)


def base(material):
    return material.node_tree.nodes["Principled BSDF"]


def plain(material, kind, color=None, **inputs):
    """Adds a node that Cycles renders instead of the Principled one. `color`: a tuple or an image node."""
    node = material.node_tree.nodes.new("ShaderNode" + kind)
    if isinstance(color, bpy.types.Node):
        link(material, color.outputs["Color"], node.inputs["Color"])
    elif color is not None:
        node.inputs["Color"].default_value = (*color, 1)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    show(material, node)
    return node


def show(material, node):
    _for_cycles.append((material, node.outputs[0]))


NO_COAT = {"extensions": {"KHR_materials_specular": {"specularFactor": 0.0}}}


def diffuse(name, color):
    """Creates a Lambertian material: glTF's dielectric without its specular coat."""
    material = principled(name, Base_Color=color, Roughness=1.0, Specular=0.0)
    GLTF[name] = NO_COAT
    plain(material, "BsdfDiffuse", color)
    return material


def textured(name, image, interpolation="Closest", cycles_image=None):
    """Like diffuse(), with an image. `cycles_image`: another image for Cycles."""
    material = principled(name, Roughness=1.0, Specular=0.0)
    node = picture(material, image, interpolation)
    link(material, node.outputs["Color"], base(material).inputs["Base Color"])
    GLTF[name] = NO_COAT
    plain(material, "BsdfDiffuse", picture(material, cycles_image, interpolation) if cycles_image else node)
    return material


def emitter(name, color, strength):
    material = principled(name, Base_Color=(0, 0, 0), Specular=0.0, Emission=color, Emission_Strength=strength)
    GLTF[name] = NO_COAT
    plain(material, "Emission", color, Strength=strength)
    return material


def metal(name, color, roughness, distribution):
    """Creates a metal. Cycles renders a Glossy node, which reflects `color` at all angles; this equals glTF's metal if
    the colour is white."""
    material = principled(name, Base_Color=color, Metallic=1.0, Roughness=roughness)
    plain(material, "BsdfGlossy", color, Roughness=roughness).distribution = distribution
    return material


def glass(name, ior, roughness, distribution, absorption=None):
    """Creates glass for closed bodies. `absorption`: absorption per unit of length, as a colour."""
    material = principled(name, Base_Color=(1, 1, 1), Transmission=1.0, Roughness=roughness, IOR=ior)
    volume = {"thicknessFactor": 1.0}
    if absorption:
        volume |= {"attenuationDistance": 1.0, "attenuationColor": [math.exp(-a) for a in absorption]}
        node = material.node_tree.nodes.new("ShaderNodeVolumeAbsorption")
        # Cycles absorbs (1 - colour) * density per unit of length.
        most = max(absorption)
        node.inputs["Density"].default_value = most
        node.inputs["Color"].default_value = (*(1 - a / most for a in absorption), 1)
        link(material, node.outputs["Volume"], material.node_tree.nodes["Material Output"].inputs["Volume"])
    GLTF[name] = {"extensions": {"KHR_materials_ior": {"ior": ior}, "KHR_materials_volume": volume}}
    plain(material, "BsdfGlass", (1, 1, 1), Roughness=roughness, IOR=ior).distribution = distribution
    return material


def see_through(name, color, alpha, method):
    """Creates a diffuse material with an alpha channel. `alpha`: an image. `method`: BLEND, or CLIP at 0.5."""
    material = principled(name, Base_Color=color, Roughness=1.0, Specular=0.0)
    material.blend_method, material.alpha_threshold = method, 0.5
    node = picture(material, alpha)
    link(material, node.outputs["Color"], base(material).inputs["Base Color"])
    link(material, node.outputs["Alpha"], base(material).inputs["Alpha"])
    GLTF[name] = NO_COAT
    nodes = material.node_tree.nodes
    opacity = node.outputs["Alpha"]
    if method == "CLIP":
        cut = nodes.new("ShaderNodeMath")
        cut.operation = "GREATER_THAN"
        cut.inputs[1].default_value = 0.5
        link(material, opacity, cut.inputs[0])
        opacity = cut.outputs[0]
    solid = plain(material, "BsdfDiffuse", node)
    mix = nodes.new("ShaderNodeMixShader")
    link(material, opacity, mix.inputs[0])
    link(material, nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
    link(material, solid.outputs[0], mix.inputs[2])
    show(material, mix)
    return material
