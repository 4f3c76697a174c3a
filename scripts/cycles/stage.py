"""Building blocks of scenes in Blender: objects, lights, camera, background."""

import math

import bmesh
import bpy
import mathutils


FPS = 24


def empty():
    """Starts an empty Blender file with settings that match Limpid: a pixel filter one pixel wide, caustics, and no
    clamping, denoising or adaptive sampling."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Standard"
    cycles = scene.cycles
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.transparent_max_bounces = 256
    background((0, 0, 0))


def size(width, height):
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100


def background(color, image=None):
    """Sets the world: one colour, or an equirectangular image with its centre towards +Y (glTF's -Z)."""
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    shader = tree.nodes["Background"]
    shader.inputs["Color"].default_value = (*color, 1)
    if image is None:
        return
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = (0, 0, -math.pi / 2)  # the centre of Blender's maps faces +X
    place = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], shader.inputs["Color"])


def camera(eye, target, fov=None, width=None):
    """Adds a perspective camera with the horizontal field of view `fov` (degrees), or an orthographic one that sees
    `width` units."""
    data = bpy.data.cameras.new("camera")
    if width is None:
        data.sensor_fit = "HORIZONTAL"
        data.angle = math.radians(fov)
    else:
        data.type = "ORTHO"
        data.ortho_scale = width
    bpy.context.scene.camera = aimed("camera", data, eye, target)


def lamp(kind, eye, target, energy, color=(1, 1, 1)):
    """Adds a light of zero size. `kind`: POINT, SPOT or SUN."""
    data = bpy.data.lights.new(kind.lower(), kind)
    data.energy, data.color = energy, color
    if kind == "SUN":
        data.angle = 0
    else:
        data.shadow_soft_size = 0
    aimed(kind.lower(), data, eye, target)
    return data


def aimed(name, data, eye, target):
    thing = bpy.data.objects.new(name, data)
    thing.location = eye
    towards = mathutils.Vector(target) - mathutils.Vector(eye)
    thing.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)
    return thing


def mesh(name, points, faces, material, uvs=None, smooth=False):
    """Adds a triangulated mesh, so that Cycles and the exporter use the same triangles. `uvs`: one per corner of each
    face."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(points, [], faces)
    if uvs:
        layer = data.uv_layers.new()
        for loop, uv in zip(layer.data, uvs):
            loop.uv = uv
    return place(name, data, material, smooth)


def place(name, data, material, smooth):
    shape = bmesh.new()
    shape.from_mesh(data)
    bmesh.ops.triangulate(shape, faces=shape.faces)
    for face in shape.faces:
        face.smooth = smooth
    shape.to_mesh(data)
    shape.free()
    data.materials.append(material)
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def quad(name, corners, material, repeat=1):
    """Adds a quadrangle. Corners are counter-clockwise seen from the front. Texture coordinates run from (0, 0) at the
    first corner to `repeat`."""
    uvs = [(0, 0), (repeat, 0), (repeat, repeat), (0, repeat)]
    return mesh(name, corners, [(0, 1, 2, 3)], material, uvs)


def floor(material, half=4.0, height=0.0, repeat=1):
    corners = [(-half, -half, height), (half, -half, height), (half, half, height), (-half, half, height)]
    return quad("floor", corners, material, repeat)


def sphere(name, center, radius, material, segments=128):
    data = bpy.data.meshes.new(name)
    shape = bmesh.new()
    bmesh.ops.create_uvsphere(shape, u_segments=segments, v_segments=segments // 2, radius=radius, calc_uvs=False)
    shape.to_mesh(data)
    shape.free()
    thing = place(name, data, material, True)
    thing.location = center
    return thing


def box(name, center, size, turn, material):
    corners = [(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    thing = mesh(name, corners, faces, material)
    thing.location, thing.scale, thing.rotation_euler = center, size, (0, 0, turn)
    return thing


def lens(diameter, distance):
    """Gives the camera a round aperture of this diameter, in focus at this distance."""
    data = bpy.context.scene.camera.data
    data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_blades = True, distance, 0
    data.dof.aperture_fstop = data.lens / 1000 / diameter


def move(thing, value, before, after):
    """Moves or turns an object at constant speed, from frame 0 to frame 2. Frame 1 is rendered."""
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = FPS, 0, 2
    for frame, position in ((0, before), (2, after)):
        setattr(thing, value, position)
        thing.keyframe_insert(value, frame=frame)
    for curve in thing.animation_data.action.fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    if hasattr(thing, "cycles"):
        thing.cycles.motion_steps = 7  # of the shutter's time, between which Cycles goes straight
    scene.frame_set(1)


def shutter(frames):
    """Switches motion blur on: the shutter is open for so many frames, centred on the frame's time."""
    scene = bpy.context.scene
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter, scene.cycles.motion_blur_position = frames, "CENTER"
