"""The test scenes. Each tests one feature. SCENES has them in the order of the table."""

import dataclasses
import math
import os

import bpy

import images
import materials
import stage


WIDTH, HEIGHT = 160, 96


@dataclasses.dataclass
class Settings:
    """How both renderers render a scene."""

    samples: int = 512  # per pixel and seed; multiplied by --quality
    bounces: int = 8  # scattering events of a path
    background: tuple = (0, 0, 0)
    environment: str = ""  # an EXR that replaces the background
    strips: tuple = ()  # names of vertical strips of the picture that are measured separately
    height: int = HEIGHT
    for_cycles: object = None  # called after the export, before Cycles renders
    options: tuple = ()  # more of Limpid's
    exact: bool = True  # False if the two renderers are known to differ


SCENES = {}


def scene(function):
    SCENES[function.__name__.replace("_", "-")] = function
    return function


def daylight(folder):
    path = os.path.join(folder, "sky.exr")
    images.save_picture(path, images.sky(128))
    image = bpy.data.images.load(path)
    stage.background((1, 1, 1), image)
    return path


def cornell_box():
    white, red = materials.diffuse("white", (0.73, 0.73, 0.73)), materials.diffuse("red", (0.63, 0.06, 0.05))
    green = materials.diffuse("green", (0.14, 0.45, 0.09))
    stage.quad("floor", [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], white)
    stage.quad("ceiling", [(-1, 1, 2), (1, 1, 2), (1, -1, 2), (-1, -1, 2)], white)
    stage.quad("back", [(-1, 1, 0), (1, 1, 0), (1, 1, 2), (-1, 1, 2)], white)
    stage.quad("left", [(-1, -1, 0), (-1, 1, 0), (-1, 1, 2), (-1, -1, 2)], red)
    stage.quad("right", [(1, 1, 0), (1, -1, 0), (1, -1, 2), (1, 1, 2)], green)
    stage.box("tall", (-0.35, 0.35, 0.6), (0.6, 0.6, 1.2), 0.3, white)
    stage.box("short", (0.35, -0.3, 0.3), (0.6, 0.6, 0.6), -0.3, white)
    light = materials.emitter("light", (1, 0.8, 0.5), 15)
    stage.quad("light", [(-0.25, 0.25, 1.99), (0.25, 0.25, 1.99), (0.25, -0.25, 1.99), (-0.25, -0.25, 1.99)], light)
    stage.camera((0, -3.9, 1), (0, 0, 1), fov=48)


def still_life(perspective=True):
    """Builds two diffuse spheres and a block on a floor."""
    stage.floor(materials.diffuse("floor", (0.6, 0.6, 0.6)))
    ball = materials.diffuse("ball", (0.8, 0.3, 0.2))
    stage.sphere("left", (-0.9, 0, 0.6), 0.6, ball)
    stage.sphere("right", (0.8, 0.5, 0.4), 0.4, ball)
    stage.box("block", (0.3, -0.6, 0.25), (0.5, 0.5, 0.5), 0.5, materials.diffuse("block", (0.2, 0.4, 0.7)))
    if perspective:
        stage.camera((0, -4.5, 2.2), (0, 0, 0.4), fov=40)


def row(make, names, **settings):
    """Builds spheres side by side with the materials make(i), seen by an orthographic camera, one per strip."""
    count = len(names)
    for i in range(count):
        stage.sphere(f"ball{i}", (i - (count - 1) / 2, 0, 0), 0.48, make(i))
    stage.camera((0, -5, 0), (0, 0, 0), width=count)
    return Settings(strips=tuple(f"{name:g}" for name in names), height=WIDTH // count, **settings)


ROUGHNESSES = (0.0, 0.25, 0.5, 0.75, 1.0)


@scene
def cornell(folder):
    cornell_box()
    return Settings()


@scene
def cornell_2_bounces(folder):
    cornell_box()
    return Settings(bounces=2)


@scene
def point_light(folder):
    still_life()
    stage.lamp("POINT", (1.5, -1.5, 3), (0, 0, 0), 300, (1, 0.9, 0.7))
    return Settings(samples=256)


@scene
def sun(folder):
    still_life()
    stage.lamp("SUN", (2, -2, 3), (0, 0, 0), 3, (1, 0.9, 0.8))
    return Settings(samples=256)


def spot(blend):
    still_life()
    lamp = stage.lamp("SPOT", (0.5, -1, 3.5), (0, 0, 0.3), 600)
    lamp.spot_size, lamp.spot_blend = math.radians(60), blend
    return lamp


@scene
def spot_light(folder):
    spot(0.5)
    return Settings(samples=256, exact=False)


@scene
def spot_light_of_khr(folder):
    """In Cycles, a point light whose nodes compute the cone by the formula of KHR_lights_punctual."""
    lamp = spot(0.5)

    def replace():
        outer = lamp.spot_size / 2
        cosines = math.cos(outer), math.cos(outer * (1 - lamp.spot_blend))
        lamp.type = "POINT"
        lamp.shadow_soft_size = 0
        cone_by_nodes(lamp, *cosines)

    return Settings(samples=256, for_cycles=replace)


def cone_by_nodes(lamp, outer, inner):
    """Multiplies a lamp's light by clamp((cosine - outer) / (inner - outer))^2. `outer` and `inner` are cosines, and
    `cosine` is that between the lamp's axis and the direction of the light."""
    lamp.use_nodes = True
    nodes, links = lamp.node_tree.nodes, lamp.node_tree.links
    bpy.context.view_layer.update()
    axis = bpy.data.objects["spot"].matrix_world.to_3x3() @ stage.mathutils.Vector((0, 0, -1))
    dot = nodes.new("ShaderNodeVectorMath")
    dot.operation = "DOT_PRODUCT"
    links.new(nodes.new("ShaderNodeNewGeometry").outputs["Incoming"], dot.inputs[0])
    dot.inputs[1].default_value = axis
    scale = nodes.new("ShaderNodeMapRange")
    scale.inputs["From Min"].default_value, scale.inputs["From Max"].default_value = outer, inner
    links.new(dot.outputs["Value"], scale.inputs["Value"])
    square = nodes.new("ShaderNodeMath")
    square.operation = "POWER"
    square.inputs[1].default_value = 2
    links.new(scale.outputs[0], square.inputs[0])
    links.new(square.outputs[0], nodes["Emission"].inputs["Strength"])


@scene
def environment(folder):
    still_life()
    return Settings(environment=daylight(folder))


@scene
def orthographic(folder):
    still_life(perspective=False)
    stage.lamp("SUN", (2, -2, 3), (0, 0, 0), 3)
    stage.camera((2, -4, 2.5), (0, 0, 0.3), width=3.5)
    return Settings(samples=256, background=(0.3, 0.4, 0.5))


@scene
def depth_of_field(folder):
    still_life()
    diameter, distance = 0.25, 4.2
    stage.lens(diameter, distance)
    return Settings(environment=daylight(folder),
                    options=("--lens-diameter", str(diameter), "--focus-distance", str(distance)))


@scene
def motion_blur(folder):
    """A ball that flies past, a block that turns, a lamp that moves, all seen by a camera that moves."""
    still_life()
    lamp = stage.mesh("lamp", [(-0.3, -0.3, 0), (-0.3, 0.3, 0), (0.3, 0.3, 0), (0.3, -0.3, 0)], [(0, 1, 2, 3)],
                      materials.emitter("lamp", (1, 0.9, 0.7), 30))
    lamp.location = (0.5, -1, 3)
    things = bpy.data.objects
    stage.move(things["left"], "location", (-1.4, -0.2, 0.6), (-0.4, 0.2, 0.6))
    stage.move(things["block"], "rotation_euler", (0, 0, 0.0), (0, 0, 1.2))
    stage.move(lamp, "location", (0.1, -1, 3), (0.9, -1, 3))
    stage.move(things["camera"], "location", (-0.1, -4.5, 2.2), (0.1, -4.5, 2.2))
    shutter = 0.8
    stage.shutter(shutter)
    return Settings(background=(0.3, 0.4, 0.5), options=("--animation", "all", "--shutter", str(shutter),
                                                         "--fps", str(stage.FPS), "--time", str(1 / stage.FPS)))


@scene
def instances(folder):
    stage.floor(materials.diffuse("floor", (0.5, 0.5, 0.5)))
    bpy.ops.mesh.primitive_monkey_add(size=0.5)
    first = bpy.context.object
    data = first.data
    bpy.data.objects.remove(first)
    head = stage.place("head", data, materials.diffuse("head", (0.7, 0.5, 0.3)), False)
    bpy.context.scene.collection.objects.unlink(head)
    for i in range(400):
        x, y = i % 20, i // 20
        thing = bpy.data.objects.new(f"head{i}", data)
        thing.location = (x * 0.4 - 3.8, y * 0.4 - 3.8, 0.2 + 0.1 * math.sin(i))
        thing.rotation_euler = (0.3 * math.sin(3 * i), 0.2 * math.cos(i), i * 2.4)
        thing.scale = (0.8, 0.8 + 0.3 * math.sin(i * 1.7), -0.8 if i % 5 == 0 else 0.9)
        bpy.context.scene.collection.objects.link(thing)
    stage.camera((0, -5, 2.5), (0, -1, 0), fov=40)
    return Settings(environment=daylight(folder))


def textured_floor(material, repeat=4, eye=(0, -4.5, 1.0)):
    stage.floor(material, repeat=repeat)
    stage.lamp("SUN", (2, -2, 5), (0, 0, 0), 3)
    stage.camera(eye, (0, 0, 0), fov=50)


@scene
def texture_nearest(folder):
    image = images.save_png(folder, "checker", images.checker(8, 64, (0.2, 0.3, 0.5), (0.9, 0.8, 0.6)))
    textured_floor(materials.textured("checker", image))
    return Settings(background=(0.5, 0.5, 0.5))


@scene
def texture_linear(folder):
    image = images.save_png(folder, "texels", images.random_texels(16, 1))
    textured_floor(materials.textured("texels", image, "Linear"))
    return Settings(background=(0.5, 0.5, 0.5), exact=False)


@scene
def texture_linear_decoded(folder):
    """In Cycles, the texture has the same texels as floats that are already decoded from sRGB."""
    image = images.save_png(folder, "texels", images.random_texels(16, 1))
    textured_floor(materials.textured("texels", image, "Linear", images.decoded(folder, image)))
    return Settings(background=(0.5, 0.5, 0.5))


@scene
def texture_reflected(folder):
    """The checkered floor directly and in metal walls of roughness 0, 0.1 and 0.3."""
    image = images.save_png(folder, "checker", images.checker(8, 64, (0.1, 0.1, 0.1), (0.9, 0.8, 0.6)))
    stage.floor(materials.textured("checker", image), repeat=2)
    for i, roughness in enumerate((0.0, 0.1, 0.3)):
        left = 1.2 * i - 1.8
        wall = materials.metal(f"wall{i}", (1, 1, 1), roughness, "MULTI_GGX")
        stage.quad(f"wall{i}", [(left, 1, 0), (left + 1.1, 1, 0), (left + 1.1, 1, 1.4), (left, 1, 1.4)], wall)
    stage.camera((0, -3.5, 1.6), (0, 0.5, 0.4), fov=50)
    return Settings(background=(1, 1, 1))


@scene
def emissive_texture(folder):
    image = images.save_png(folder, "sign", images.checker(4, 16, (0.0, 0.1, 0.4), (1.0, 0.6, 0.2)))
    sign = materials.principled("sign", Base_Color=(0, 0, 0), Specular=0.0, Emission_Strength=4.0)
    node = materials.picture(sign, image)
    materials.link(sign, node.outputs["Color"], materials.base(sign).inputs["Emission"])
    materials.GLTF["sign"] = materials.NO_COAT
    materials.plain(sign, "Emission", node, Strength=4.0)
    stage.floor(materials.diffuse("floor", (0.7, 0.7, 0.7)))
    stage.quad("sign", [(-1, 1, 0.2), (1, 1, 0.2), (1, 1, 2.2), (-1, 1, 2.2)], sign)
    stage.sphere("ball", (0.3, 0, 0.4), 0.4, materials.diffuse("ball", (0.8, 0.8, 0.8)))
    stage.camera((0, -4.5, 2.2), (0, 0, 0.7), fov=40)
    return Settings()


def sails(folder, method, alpha):
    stage.floor(materials.diffuse("floor", (0.7, 0.7, 0.7)))
    image = images.save_png(folder, method, images.checker(6, 48, (0.8, 0.2, 0.2), (0.2, 0.4, 0.8), alpha))
    sail = materials.see_through("sail", (1, 1, 1), image, method)
    stage.quad("front", [(-1.2, -0.3, 0.1), (0.6, -0.3, 0.1), (0.6, -0.3, 1.6), (-1.2, -0.3, 1.6)], sail)
    stage.quad("back", [(-0.6, 0.7, 0.1), (1.2, 0.7, 0.1), (1.2, 0.7, 1.6), (-0.6, 0.7, 1.6)], sail)
    stage.lamp("POINT", (1.0, -2.0, 3), (0, 0, 0), 400)
    stage.camera((0, -4.5, 2.0), (0, 0, 0.6), fov=40)
    return Settings(background=(0.4, 0.4, 0.4))


@scene
def alpha_blend(folder):
    return sails(folder, "BLEND", (0.25, 0.75))


@scene
def alpha_mask(folder):
    return sails(folder, "CLIP", (0.0, 1.0))


def bumpy(folder, surface, slope=0.3, eye=(0, -2.5, 3.5)):
    """`surface(name)` creates the material. The normal map is linked to its Principled and its simple node."""
    image = images.save_png(folder, "waves", images.waves(64, 4, slope), data=True)
    bumps = surface("bumps")
    tree = bumps.node_tree
    node = tree.nodes.new("ShaderNodeNormalMap")
    tree.links.new(materials.picture(bumps, image, "Closest").outputs["Color"], node.inputs["Color"])
    for target in tree.nodes:
        if "Normal" in target.inputs and target.type != "NORMAL_MAP":
            tree.links.new(node.outputs["Normal"], target.inputs["Normal"])
    textured_floor(bumps, repeat=2, eye=eye)


@scene
def normal_map_metal(folder):
    bumpy(folder, lambda name: materials.metal(name, (1, 1, 1), 0.5, "MULTI_GGX"))
    return Settings(background=(0.5, 0.5, 0.5))


@scene
def normal_map_diffuse(folder):
    bumpy(folder, lambda name: materials.diffuse(name, (0.8, 0.8, 0.8)))
    return Settings(background=(0.5, 0.5, 0.5), exact=False)


@scene
def normal_map_grazing(folder):
    """Steep bumps seen at a grazing angle: many normals face away from the camera or mirror it into the ground."""
    bumpy(folder, lambda name: materials.metal(name, (1, 1, 1), 0.5, "MULTI_GGX"), 0.6, (0, -4.5, 1.0))
    return Settings(background=(0.5, 0.5, 0.5), exact=False)


@scene
def metal_white(folder):
    return row(lambda i: materials.metal(f"metal{i}", (1, 1, 1), ROUGHNESSES[i], "MULTI_GGX"), ROUGHNESSES,
               environment=daylight(folder))


@scene
def metal_gold(folder):
    """Cycles' Principled node, whose Fresnel term follows a dielectric's curve. glTF uses Schlick's approximation."""
    def gold(i):
        material = materials.principled(f"gold{i}", Base_Color=(1, 0.72, 0.3), Metallic=1.0, Roughness=ROUGHNESSES[i])
        materials.base(material).distribution = "MULTI_GGX"
        return material
    return row(gold, ROUGHNESSES, environment=daylight(folder), exact=False)


@scene
def glass_smooth(folder):
    iors = (1.1, 1.33, 1.5, 1.8, 2.4)
    return row(lambda i: materials.glass(f"glass{i}", iors[i], 0.0, "SHARP"), iors,
               environment=daylight(folder), bounces=32)


@scene
def glass_rough(folder):
    roughnesses = (0.1, 0.25, 0.5, 0.75, 1.0)
    return row(lambda i: materials.glass(f"glass{i}", 1.5, roughnesses[i], "MULTI_GGX"), roughnesses,
               environment=daylight(folder), bounces=32)


@scene
def absorption(folder):
    iors = (1.1, 1.33, 1.5, 1.8, 2.4)
    absorbed = ((0.2, 0.1, 0.05), (0.2, 1.0, 2.0), (1.0, 0.3, 0.2), (3.0, 2.0, 0.4), (6.0, 8.0, 10.0))
    return row(lambda i: materials.glass(f"glass{i}", iors[i], 0.0, "SHARP", absorbed[i]), iors,
               environment=daylight(folder), bounces=32)


def plastics(color, **settings):
    def make(i):
        material = materials.principled(f"plastic{i}", Base_Color=color, Roughness=ROUGHNESSES[i], Specular=0.5)
        materials.base(material).distribution = "MULTI_GGX"
        return material
    return row(make, ROUGHNESSES, exact=False, **settings)


@scene
def coat_furnace(folder):
    """The specular coat over black, under a white sky."""
    return plastics((0, 0, 0), background=(1, 1, 1))


@scene
def plastic(folder):
    return plastics((0.8, 0.25, 0.1), environment=daylight(folder))


@scene
def plastic_furnace(folder):
    """White plastic under a white sky: a result other than 1 means that energy is created or lost."""
    return plastics((1, 1, 1), background=(1, 1, 1))
