"""Renders a short animated test shot with Blender's Cycles to multilayer EXR, with the passes that Limpid reads.

    blender -b --factory-startup -noaudio -P scripts/shots/make_shot.py -- SHOT OUT_DIR --samples N

Writes OUT_DIR/SHOT.0001.exr to SHOT.0016.exr, and the cameras to OUT_DIR/SHOT.camera.json. All shots are built here,
without downloaded files. Written for Blender 3.4.
"""

import argparse
import math
import os
import sys

import bmesh
import bpy
import numpy
from mathutils import Matrix, Vector

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "blender"))

import limpid_denoise  # noqa: E402

FIRST, LAST = 1, 16


# Materials. A texture is a function that adds nodes to a tree and returns the socket of their colour.

def nodes(tree, kind, **inputs):
    node = tree.nodes.new(kind)
    for name, value in inputs.items():
        node.inputs[name.replace("_", " ")].default_value = value
    return node


def placed(tree, node, space):
    """Feeds the texture node with texture coordinates: "Object", "Generated" or "UV"."""
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs[space], node.inputs["Vector"])
    return node


def checker(scale, first, second, space="Object"):
    return lambda tree: placed(tree, nodes(tree, "ShaderNodeTexChecker", Scale=scale, Color1=(*first, 1),
                                           Color2=(*second, 1)), space).outputs["Color"]


def bricks(scale, first, second, mortar, space="Object"):
    return lambda tree: placed(tree, nodes(tree, "ShaderNodeTexBrick", Scale=scale, Color1=(*first, 1),
                                           Color2=(*second, 1), Mortar=(*mortar, 1)), space).outputs["Color"]


def ramp(tree, value, colors):
    """Maps a value from 0 to 1 to evenly spaced colours."""
    node = tree.nodes.new("ShaderNodeValToRGB")
    elements = node.color_ramp.elements
    for _ in range(len(colors) - 2):
        elements.new(0.5)
    for i, color in enumerate(colors):
        elements[i].position, elements[i].color = i / (len(colors) - 1), (*color, 1)
    tree.links.new(value, node.inputs["Fac"])
    return node.outputs["Color"]


def noise(scale, *colors, space="Object"):
    return lambda tree: ramp(tree, placed(tree, nodes(tree, "ShaderNodeTexNoise", Scale=scale, Detail=6.0),
                                          space).outputs["Fac"], colors)


def cells(scale, *colors, space="Object"):
    return lambda tree: ramp(tree, placed(tree, nodes(tree, "ShaderNodeTexVoronoi", Scale=scale),
                                          space).outputs["Distance"], colors)


def material(name, color=(0.8, 0.8, 0.8), rough=0.5, metal=0.0, glass=0.0):
    """`color`: a colour or a texture."""
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    tree = result.node_tree
    shader = tree.nodes["Principled BSDF"]
    shader.inputs["Roughness"].default_value = rough
    shader.inputs["Metallic"].default_value = metal
    shader.inputs["Transmission"].default_value = glass
    if callable(color):
        tree.links.new(color(tree), shader.inputs["Base Color"])
    else:
        shader.inputs["Base Color"].default_value = (*color, 1)
    return result


# Objects

def add(name, data, at=(0, 0, 0), turn=(0, 0, 0), size=(1, 1, 1)):
    thing = bpy.data.objects.new(name, data)
    thing.location, thing.rotation_euler, thing.scale = at, turn, size
    bpy.context.scene.collection.objects.link(thing)
    return thing


def mesh(name, points, faces, look, smooth=False, uvs=None):
    """`uvs`: one for each point."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(points, [], faces)
    data.polygons.foreach_set("use_smooth", [smooth] * len(data.polygons))
    data.materials.append(look)
    if uvs is not None:
        layer = data.uv_layers.new()
        for loop in data.loops:
            layer.data[loop.index].uv = uvs[loop.vertex_index]
    return data


def primitive(name, look, create, smooth=True, **options):
    """Makes a mesh with one of bmesh.ops.create_*()."""
    shape = bmesh.new()
    create(shape, **options)
    data = bpy.data.meshes.new(name)
    for face in shape.faces:
        face.smooth = smooth
    shape.to_mesh(data)
    shape.free()
    data.materials.append(look)
    return data


def box(name, look, at, size, turn=0.0):
    """Textures in object space are not scaled, as the size is in the mesh."""
    data = primitive(name, look, bmesh.ops.create_cube, smooth=False, size=1.0, matrix=Matrix.Diagonal((*size, 1)))
    return add(name, data, at, (0, 0, turn))


def ball(name, look, at, radius):
    return add(name, primitive(name, look, bmesh.ops.create_uvsphere, u_segments=64, v_segments=32, radius=radius), at)


def monkey(name, look, at, size, turn=(0, 0, 0)):
    thing = add(name, primitive(name, look, bmesh.ops.create_monkey), at, turn, (size, size, size))
    thing.modifiers.new("smooth", "SUBSURF").render_levels = 1
    return thing


def plane(name, look, at, size, turn=(0, 0, 0)):
    x, y = size[0] / 2, size[1] / 2
    data = mesh(name, [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], [(0, 1, 2, 3)], look,
                uvs=[(0, 0), (1, 0), (1, 1), (0, 1)])
    return add(name, data, at, turn)


def sheet(name, look, point, columns, rows, at=(0, 0, 0)):
    """A curved sheet. `point` maps u and v, from 0 to 1, to a point."""
    uvs = [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    corner = [j * (columns + 1) + i for j in range(rows) for i in range(columns)]
    faces = [(c, c + 1, c + columns + 2, c + columns + 1) for c in corner]
    return add(name, mesh(name, [point(u, v) for u, v in uvs], faces, look, True, uvs), at)


def ring(name, look, at, radius, thickness):
    def point(u, v):
        across = radius + thickness * math.cos(2 * math.pi * v)
        return (across * math.cos(2 * math.pi * u), across * math.sin(2 * math.pi * u),
                thickness * math.sin(2 * math.pi * v))
    return sheet(name, look, point, 64, 24, at)


def turned(name, look, at, profile):
    """A body of revolution, as from a lathe. `profile`: radius and height, from the bottom to the top."""
    def point(u, v):
        place = v * (len(profile) - 1)
        i = min(int(place), len(profile) - 2)
        radius, height = (a + (place - i) * (b - a) for a, b in zip(profile[i], profile[i + 1]))
        return radius * math.cos(2 * math.pi * u), radius * math.sin(2 * math.pi * u), height
    return sheet(name, look, point, 48, 8 * (len(profile) - 1), at)


def strands(name, look, roots, directions, length, width, seed, droop=0.0, segments=6):
    """Thin strips, each `segments` long, that end in a point. `roots`, `directions`: one row for each strand."""
    random = numpy.random.default_rng(seed)
    count = len(roots)
    lengths = length * random.uniform(0.7, 1.0, (count, 1))
    side = numpy.cross(directions, random.normal(size=(count, 3)))
    side *= width / 2 / numpy.linalg.norm(side, axis=1, keepdims=True)
    bend = 0.35 * length * random.normal(size=(count, 3)) + (0, 0, -droop)
    levels = []
    for k in range(segments + 1):
        t = k / segments
        center = roots + lengths * t * directions + bend * t * t
        levels += [center - side * (1 - 0.98 * t), center + side * (1 - 0.98 * t)]
    points = numpy.stack(levels, axis=1).reshape(-1, 3)
    start = numpy.arange(count)[:, None] * 2 * (segments + 1) + numpy.arange(segments)[None, :] * 2
    quads = (start.reshape(-1, 1) + numpy.array([0, 1, 3, 2])).tolist()
    return add(name, mesh(name, points.tolist(), quads, look))


def on_sphere(count, seed):
    points = numpy.random.default_rng(seed).normal(size=(count, 3))
    return points / numpy.linalg.norm(points, axis=1, keepdims=True)


# Light and camera

def lamp(kind, at, target, power, size, color=(1, 1, 1)):
    """`kind`: AREA, or SUN, whose size is an angle in degrees."""
    data = bpy.data.lights.new(kind.lower(), kind)
    data.energy, data.color = power, color
    if kind == "SUN":
        data.angle = math.radians(size)
    else:
        data.size = size
    thing = add(kind.lower(), data, at)
    thing.rotation_euler = towards(at, target).to_euler()
    return thing


def sky(horizon, zenith, strength):
    """A gradient from below the horizon upwards."""
    world = bpy.context.scene.world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    tree = world.node_tree
    split = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], split.inputs["Vector"])
    shader = tree.nodes["Background"]
    tree.links.new(ramp(tree, split.outputs["Z"], (horizon, zenith)), shader.inputs["Color"])
    shader.inputs["Strength"].default_value = strength


def towards(eye, target):
    return (Vector(target) - Vector(eye)).to_track_quat("-Z", "Y")


def animate(thing, attribute, value):
    """Animates an attribute. `value` maps time, 0 at the first frame and 1 at the last, to the attribute's value. The
    frames before and after are needed for motion vectors."""
    for frame in range(FIRST - 1, LAST + 2):
        setattr(thing, attribute, value((frame - FIRST) / (LAST - FIRST)))
        thing.keyframe_insert(attribute, frame=frame)


def camera(eye, target, angle):
    """Adds a moving camera. `eye` and `target` map time to points; `angle`: horizontal, in degrees."""
    data = bpy.data.cameras.new("camera")
    data.angle = math.radians(angle)
    thing = bpy.context.scene.camera = add("camera", data)
    thing.rotation_mode = "QUATERNION"
    animate(thing, "location", eye)
    animate(thing, "rotation_quaternion", lambda t: towards(eye(t), target(t)))


def between(first, last):
    return lambda t: Vector(first).lerp(Vector(last), t)


# The shots

def room_with_window(wall, floor):
    """A room of 5 x 5 x 2.7 m with a window in the left wall."""
    plane("floor", floor, (0, 0, 0), (5, 5))
    plane("ceiling", wall, (0, 0, 2.7), (5, 5), (math.pi, 0, 0))
    box("back wall", wall, (0, 2.55, 1.35), (5.2, 0.1, 2.7))
    box("front wall", wall, (0, -2.55, 1.35), (5.2, 0.1, 2.7))
    box("right wall", wall, (2.55, 0, 1.35), (0.1, 5, 2.7))
    box("wall below window", wall, (-2.55, 0, 0.4), (0.1, 5, 0.8))
    box("wall above window", wall, (-2.55, 0, 2.45), (0.1, 5, 0.5))
    box("wall before window", wall, (-2.55, -1.35, 1.5), (0.1, 2.3, 1.4))
    box("wall after window", wall, (-2.55, 2.1, 1.5), (0.1, 0.8, 1.4))
    for name, size in (("window bar", (0.06, 0.05, 1.4)), ("window crossbar", (0.06, 1.9, 0.05))):
        box(name, material(name, (0.7, 0.7, 0.68), 0.3), (-2.55, 0.75, 1.5), size)


def shot_camera():
    """A furnished room with a lamp, and sun through a window. The camera moves forward and sideways, and pans."""
    room_with_window(material("wall", noise(1.5, (0.7, 0.66, 0.58), (0.78, 0.75, 0.68)), 0.8),
                     material("floor", bricks(3, (0.36, 0.2, 0.1), (0.48, 0.3, 0.16), (0.1, 0.06, 0.04)), 0.25))
    box("rug", material("rug", checker(5, (0.5, 0.06, 0.07), (0.75, 0.65, 0.5)), 0.9), (0, 0.7, 0.01), (2.4, 1.8, 0.02))
    wood = material("wood", noise(9, (0.25, 0.12, 0.05), (0.5, 0.28, 0.12)), 0.35)
    box("table top", wood, (0.1, 0.8, 0.72), (1.3, 0.8, 0.05))
    for x in (-0.45, 0.65):
        for y in (0.5, 1.1):
            box("table leg", wood, (x, y, 0.36), (0.06, 0.06, 0.7))
    fabric = material("fabric", noise(60, (0.05, 0.16, 0.2), (0.15, 0.4, 0.42)), 0.9)
    box("sofa seat", fabric, (1.6, 1.9, 0.25), (1.6, 0.9, 0.4))
    box("sofa back", fabric, (1.6, 2.35, 0.6), (1.6, 0.2, 0.7))
    box("sofa arm", fabric, (0.75, 1.9, 0.4), (0.15, 0.9, 0.6))
    box("shelf", wood, (-1.1, 2.35, 1.3), (1.5, 0.3, 0.04))
    box("lower shelf", wood, (-1.1, 2.35, 0.8), (1.5, 0.3, 0.04))
    for i in range(9):
        shade = (0.1 + 0.6 * (i % 3 == 0), 0.1 + 0.5 * (i % 3 == 1), 0.15 + 0.5 * (i % 2))
        box("book", material("book", shade, 0.5), (-1.75 + 0.07 * i, 2.35, 0.97), (0.05, 0.2, 0.24 + 0.02 * (i % 4)))
    box("picture", material("picture", cells(5, (0.9, 0.5, 0.1), (0.1, 0.2, 0.6), (0.8, 0.8, 0.7)), 0.5),
        (0.5, 2.48, 1.65), (0.9, 0.04, 0.7))
    turned("vase", material("vase", (0.05, 0.15, 0.5), 0.08), (-0.25, 0.85, 0.745),
           [(0, 0), (0.08, 0), (0.13, 0.1), (0.11, 0.2), (0.05, 0.28), (0.07, 0.34)])
    ball("chrome ball", material("chrome", (0.9, 0.9, 0.9), 0.05, 1), (0.15, 0.65, 0.855), 0.11)
    ball("red ball", material("red", (0.7, 0.05, 0.04), 0.3), (0.5, 0.9, 0.825), 0.08)
    monkey("bronze monkey", material("bronze", (0.7, 0.4, 0.2), 0.3, 1), (-0.7, 2.3, 1.5), 0.17, (0, 0, 0.3))
    ring("ring", material("gold", (0.9, 0.6, 0.2), 0.2, 1), (-1.2, 0.4, 0.1), 0.28, 0.08)
    box("chest", material("chest", checker(12, (0.15, 0.3, 0.15), (0.6, 0.6, 0.4)), 0.4), (-1.5, 1.5, 0.25),
        (0.6, 0.5, 0.5), 0.5)
    lamp("AREA", (0.6, 0.3, 2.65), (0.6, 0.3, 0), 32, 0.8, (1, 0.9, 0.75))
    lamp("SUN", (-4, -0.8, 2.4), (0, 0, 0), 14, 1.5, (1, 0.95, 0.85))
    sky((0.75, 0.85, 1), (0.3, 0.5, 0.9), 2)
    camera(between((-0.9, -2.1, 1.35), (0.5, -1.5, 1.55)), between((0.2, 2, 0.95), (-0.25, 2, 0.9)), 62)


def bending(thing, bent):
    """Gives the mesh a shape key. `bent` maps its points to those of the key. Returns the key."""
    thing.shape_key_add(name="rest")
    key = thing.shape_key_add(name="bent")
    key.slider_min, key.slider_max = -1, 1
    for point in key.data:
        point.co = bent(point.co.copy())
    return key


def flag(look, at):
    """A flag with travelling waves: two standing waves, each a shape key."""
    thing = sheet("flag", look, lambda u, v: (1.5 * u, 0, 0.85 * v), 48, 24, at)
    thing.rotation_euler = (0, 0, -0.7)
    for wave, phase in ((math.sin, math.sin), (math.cos, math.cos)):
        key = bending(thing, lambda p, wave=wave: Vector((p.x, 0.22 * p.x * wave(6 * p.x + 2 * p.z), p.z)))
        animate(key, "value", lambda t, phase=phase: phase(2 * math.pi * 1.2 * t))


def shot_objects():
    """Rigid objects that turn and move, a waving flag and a bending pillar. The camera drifts slowly."""
    plane("ground", material("ground", checker(1.6, (0.3, 0.29, 0.27), (0.55, 0.53, 0.5)), 0.4), (0, 0, 0), (14, 14))
    plane("wall", material("wall", bricks(1.6, (0.45, 0.2, 0.13), (0.58, 0.3, 0.2), (0.6, 0.58, 0.54)), 0.8),
          (0, 3, 2.5), (14, 5), (math.pi / 2, 0, 0))
    cube = box("cube", material("cube", checker(6, (0.8, 0.55, 0.1), (0.1, 0.12, 0.3)), 0.4), (-1.5, 0.1, 0.75),
               (0.75, 0.75, 0.75))
    animate(cube, "rotation_euler", lambda t: (0.5 + 1.2 * t, 0.4, 2.6 * t))
    head = monkey("monkey", material("monkey", noise(7, (0.1, 0.35, 0.15), (0.5, 0.7, 0.3)), 0.35), (0, 0, 0.75), 0.55)
    animate(head, "rotation_euler", lambda t: (0, 0, -0.7 + 1.6 * t))
    hopper = ball("ball", material("ball", cells(8, (0.75, 0.08, 0.06), (0.9, 0.8, 0.7)), 0.15), (0, 0, 0), 0.28)
    animate(hopper, "location", lambda t: (-0.9 + 2.4 * t, -1.2, 0.3 + 0.7 * math.sin(math.pi * t)))
    animate(hopper, "rotation_euler", lambda t: (0, 5 * t, 0))
    hoop = ring("ring", material("steel", (0.75, 0.77, 0.8), 0.25, 1), (0, 0, 0), 0.42, 0.1)
    animate(hoop, "location", lambda t: (1.3, 0.4 - 0.4 * t, 0.75 + 0.3 * t))
    animate(hoop, "rotation_euler", lambda t: (1.2 + 2.2 * t, 0.6 * t, 0))
    pillar = turned("pillar", material("pillar", checker(9, (0.1, 0.25, 0.55), (0.75, 0.75, 0.8)), 0.3),
                    (2.35, 1.0, 0), [(0.25, 0), (0.25, 1), (0.25, 2), (0, 2)])
    key = bending(pillar, lambda p: Vector((p.x + 0.16 * p.z * p.z, p.y, p.z * (1 - 0.06 * p.z))))
    animate(key, "value", lambda t: math.sin(2 * math.pi * t - 0.6))
    box("pole", material("pole", (0.3, 0.3, 0.32), 0.3, 1), (-2.5, 1.5, 1.4), (0.06, 0.06, 2.8))
    flag(material("flag", bricks(7, (0.75, 0.1, 0.1), (0.85, 0.8, 0.2), (0.9, 0.9, 0.9), "UV"), 0.7),
         (-2.47, 1.5, 1.85))
    lamp("AREA", (2.5, -3, 4.5), (0, 0, 0.6), 300, 2, (1, 0.95, 0.88))
    lamp("SUN", (-4, -3, 6), (0, 0, 0), 1.2, 3, (1, 0.9, 0.8))
    sky((0.6, 0.65, 0.75), (0.3, 0.45, 0.8), 0.5)
    camera(between((-0.15, -5.2, 1.75), (0.15, -5.15, 1.8)), between((0, 0, 1.05), (0, 0, 1.05)), 55)


def shot_glass():
    """Glass, a mirror and rough metal before fine textures. The camera circles around them."""
    plane("floor", material("floor", checker(12, (0.08, 0.08, 0.09), (0.7, 0.68, 0.65)), 0.3), (0, 0, 0), (12, 12))
    plane("backdrop", material("backdrop", bricks(14, (0.3, 0.36, 0.45), (0.45, 0.5, 0.58), (0.75, 0.75, 0.75), "UV"),
                               0.8), (0, 3.2, 2), (12, 4), (math.pi / 2, 0, 0))
    ball("glass ball", material("glass", (1, 1, 1), 0, glass=1), (-0.35, -0.35, 0.55), 0.55)
    plane("mirror", material("mirror", (0.93, 0.93, 0.93), 0, 1), (-1.5, 1.3, 0.95), (1.7, 1.7),
          (math.pi / 2, 0, 0.55))
    box("mirror frame", material("frame", noise(25, (0.2, 0.1, 0.04), (0.45, 0.26, 0.1)), 0.4),
        (-1.5 - 0.025 * math.sin(0.55), 1.3 + 0.04 * math.cos(0.55) - 0.01, 0.95), (1.85, 0.05, 1.85), 0.55)
    turned("rough copper", material("copper", (0.85, 0.45, 0.3), 0.35, 1), (1.05, 0.35, 0),
           [(0.001, 0), (0.35, 0), (0.4, 0.3), (0.2, 0.7), (0.28, 1.0), (0.3, 1.1), (0.001, 1.1)])
    monkey("gold monkey", material("rough gold", (0.9, 0.65, 0.25), 0.25, 1), (0.35, 1.3, 0.55), 0.55, (-0.3, 0, 0.4))
    ring("glass ring", material("green glass", (0.7, 1, 0.8), 0.0, glass=1), (0.45, -0.9, 0.1), 0.26, 0.1)
    box("speckled cube", material("speckles", noise(14, (0.05, 0.1, 0.3), (0.9, 0.8, 0.5), (0.7, 0.1, 0.1)), 0.5),
        (-1.55, -0.1, 0.25), (0.5, 0.5, 0.5), 0.6)
    box("striped block", material("grid", checker(28, (0.8, 0.3, 0.1), (0.9, 0.85, 0.8)), 0.5), (1.75, -0.45, 0.3),
        (0.4, 0.4, 0.6), 0.3)
    lamp("AREA", (2.5, -2, 4), (0, 0, 0.4), 260, 1.6, (1, 0.93, 0.85))
    lamp("AREA", (-3.5, -1.5, 2.5), (0, 0, 0.6), 90, 1.5, (0.8, 0.9, 1))
    sky((0.7, 0.7, 0.72), (0.35, 0.5, 0.8), 0.5)

    def eye(t):
        angle = -0.32 + 0.6 * t
        return Vector((4.3 * math.sin(angle), -4.3 * math.cos(angle), 1.5 + 0.25 * t))
    camera(eye, between((0, 0.3, 0.7), (0, 0.3, 0.65)), 50)


def shot_hair():
    """Turning bodies of hair, thinner than a pixel, before a transparent background. The camera moves, too."""
    bpy.context.scene.render.film_transparent = True
    normals = on_sphere(6000, 1)
    fur = strands("fur", material("fur", noise(6, (0.35, 0.14, 0.05), (0.8, 0.45, 0.2)), 0.4), 0.42 * normals, normals,
                  0.36, 0.006, 2, droop=0.1)
    core = ball("core", material("core", (0.12, 0.05, 0.02), 0.8), (0, 0, 0), 0.42)
    core.parent = fur
    animate(fur, "location", lambda t: (-0.5 + 0.15 * t, 0, 0.1 * math.sin(2 * math.pi * t)))
    animate(fur, "rotation_euler", lambda t: (0.3 * t, 0.2, 1.3 * t))
    seeds = on_sphere(700, 3)
    clock = strands("dandelion", material("silk", (0.85, 0.85, 0.8), 0.3), 0.03 * seeds, seeds, 0.42, 0.005, 4)
    stem = turned("stem", material("stem", (0.15, 0.4, 0.08), 0.5), (0, 0, 0), [(0.012, -1.2), (0.012, 0)])
    stem.parent = clock
    clock.location = (0.65, -0.2, 0.2)
    animate(clock, "rotation_euler", lambda t: (0.15 * math.sin(5 * t), 0.25 * math.sin(4 * t), -1.1 * t))
    blades = numpy.random.default_rng(5).uniform((-1.9, -0.6, 0), (1.9, 1.2, 0), (2500, 3))
    grass = strands("grass", material("grass", noise(3, (0.06, 0.2, 0.03), (0.3, 0.5, 0.12)), 0.5), blades,
                    numpy.tile((0.0, 0.0, 1.0), (2500, 1)), 0.4, 0.012, 6)
    grass.location = (0, 0, -1)
    lamp("AREA", (2, -2.5, 3), (0, 0, 0), 170, 1.2, (1, 0.95, 0.85))
    lamp("SUN", (-3, 2, 3), (0, 0, 0), 3, 2, (1, 0.9, 0.8))
    sky((0.5, 0.5, 0.5), (0.4, 0.55, 0.9), 0.6)
    camera(between((-0.5, -3.2, 0.2), (0.5, -3.0, 0.5)), between((0, 0, -0.1), (0.1, 0, -0.1)), 46)


SHOTS = {"camera": shot_camera, "objects": shot_objects, "glass": shot_glass, "hair": shot_hair}


# Rendering

def arguments():
    parser = argparse.ArgumentParser(prog="scripts/shots/make_shot.py", description=__doc__.splitlines()[0])
    parser.add_argument("shot", choices=SHOTS, help="the shot")
    parser.add_argument("out", metavar="OUT_DIR", help="folder of the pictures")
    parser.add_argument("--samples", type=int, required=True, help="samples for each pixel")
    parser.add_argument("--first", type=int, default=FIRST, help=f"first frame to render; default: {FIRST}")
    parser.add_argument("--last", type=int, default=LAST, help=f"last frame to render; default: {LAST}")
    parser.add_argument("--width", type=int, default=320, help="default: 320")
    parser.add_argument("--height", type=int, default=180, help="default: 180")
    parser.add_argument("--half", action="store_true", help="store 16-bit instead of 32-bit floats")
    parser.add_argument("--stereo", action="store_true", help="render two views, left and right, into the same files")
    parser.add_argument("--reference", action="store_true", help="store only the picture, without further passes")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def use_cycles(scene, samples):
    """Sets Cycles to unfiltered samples: no clamping, no denoising, as many in each pixel, others in each frame."""
    scene.render.engine = "CYCLES"
    scene.render.use_motion_blur = False  # otherwise there are no motion vectors
    scene.render.use_persistent_data = True
    cycles = scene.cycles
    cycles.samples = samples
    cycles.seed = samples  # a reference shares no samples with the frames that are compared with it
    cycles.use_animated_seed = True
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.diffuse_bounces = cycles.glossy_bounces = 4
    cycles.max_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = 8


def set_output(scene, given):
    render, image = scene.render, scene.render.image_settings
    render.resolution_x, render.resolution_y, render.resolution_percentage = given.width, given.height, 100
    render.filepath = os.path.join(os.path.abspath(given.out), given.shot + ".####.exr")
    image.file_format, image.color_mode, image.exr_codec = "OPEN_EXR_MULTILAYER", "RGBA", "ZIP"
    image.color_depth = "16" if given.half else "32"
    render.use_multiview, image.views_format = given.stereo, "MULTIVIEW" if given.stereo else "INDIVIDUAL"
    scene.frame_start, scene.frame_end = given.first, given.last


def number_objects(scene):
    """Gives each object a number of its own in the pass Object Index."""
    for number, thing in enumerate((thing for thing in scene.objects if thing.type == "MESH"), 1):
        thing.pass_index = number


def main():
    given = arguments()
    os.makedirs(given.out, exist_ok=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    SHOTS[given.shot]()
    number_objects(scene)
    use_cycles(scene, given.samples)
    set_output(scene, given)
    if not given.reference:
        limpid_denoise.enable_passes(scene)
    cameras = os.path.join(given.out, given.shot + ".camera.json")
    limpid_denoise.write_cameras(scene, range(FIRST, LAST + 1), cameras)
    bpy.ops.render.render(animation=True)


main()
