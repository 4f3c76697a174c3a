"""Blender add-on that denoises animations rendered by Cycles with the program `limpid`.

Install it in Blender's preferences and set the path of `limpid` there. Its panel "Limpid" is in the render properties.
The command line needs no installation:

    blender -b shot.blend -P limpid_denoise.py -- --output DIR [--frames 1-16] [--limpid PATH] [--still]

This renders DIR/noisy.0001.exr and so on, writes DIR/cameras.json and denoises to DIR/clean.0001.exr. The exit code is
nonzero on failure.

cameras.json has the camera of every frame, in Blender's world space: right-handed, Z up.

    {"frames": {"1": {"eye": [x, y, z], "forward": [x, y, z], "up": [x, y, z], "fov_y": 39.6,
                      "orthographic_height": null, "shift": [0, 0]}}}

`fov_y` is the vertical angle of the whole picture in degrees. An orthographic camera has the picture's height in
`orthographic_height` instead, and null in `fov_y`. `shift` is the lens shift in Blender's units: 1 is the picture's
side along which Blender measures the sensor, with sensor fit "Auto" the longer one.
"""

import argparse
import contextlib
import json
import math
import os
import re
import shutil
import subprocess
import sys
import traceback

import bpy

bl_info = {
    "name": "Limpid Denoiser",
    "description": "Denoises animations rendered by Cycles with the program limpid",
    "author": "The Limpid authors",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Limpid",
    "category": "Render",
}

# Passes of a view layer, and of its Cycles settings.
PASSES = ("use_pass_combined", "use_pass_z", "use_pass_position", "use_pass_normal", "use_pass_vector",
          "use_pass_object_index", "use_pass_diffuse_direct", "use_pass_diffuse_indirect", "use_pass_diffuse_color",
          "use_pass_glossy_direct", "use_pass_glossy_indirect", "use_pass_glossy_color",
          "use_pass_transmission_direct", "use_pass_transmission_indirect", "use_pass_transmission_color",
          "use_pass_emit", "use_pass_environment")
CYCLES_PASSES = ("use_pass_volume_direct", "use_pass_volume_indirect", "denoising_store_passes")
NEEDED_PASSES = ("use_pass_combined", "use_pass_z", "use_pass_normal", "use_pass_vector")


class Problem(Exception):
    """A failure that the user can do something about. Its text is shown to the user."""


def enable_passes(scene):
    """Switches on all passes that Limpid reads, in all view layers."""
    for layer in scene.view_layers:
        for name in PASSES:
            setattr(layer, name, True)
        for name in CYCLES_PASSES:
            setattr(layer.cycles, name, True)


def check_scene(scene):
    """Raises Problem for what would make the render unusable."""
    if scene.render.engine != "CYCLES":
        raise Problem("The render engine is not Cycles")
    if scene.camera is None:
        raise Problem("The scene has no camera")
    if scene.render.use_border and scene.render.use_crop_to_border:
        raise Problem("Turn off 'Crop to Render Region'")
    for layer in scene.view_layers:
        complete = all(getattr(layer, name) for name in NEEDED_PASSES) and layer.cycles.denoising_store_passes
        if layer.use and not complete:
            raise Problem(f"View layer '{layer.name}' lacks passes: use 'Enable passes'")


def camera_state(scene, depsgraph):
    """Describes the camera at the current frame, as in cameras.json."""
    camera = scene.camera.evaluated_get(depsgraph)
    if camera.data.type == "PANO":
        raise Problem("The camera is panoramic; only perspective and orthographic cameras can be denoised")
    top, bottom = camera.data.view_frame(scene=scene)[:2]  # the right corners of the picture
    height = top.y - bottom.y
    orthographic = camera.data.type == "ORTHO"
    axes = camera.matrix_world.to_3x3().normalized()  # renderers ignore the scale, too
    return {"eye": list(camera.matrix_world.translation),
            "forward": list(-axes.col[2]),
            "up": list(axes.col[1]),
            "fov_y": None if orthographic else math.degrees(2 * math.atan2(height / 2, -top.z)),
            "orthographic_height": height if orthographic else None,
            "shift": [camera.data.shift_x, camera.data.shift_y]}


def write_cameras(scene, frames, path):
    """Writes cameras.json. Leaves the scene at its current frame."""
    current, subframe = scene.frame_current, scene.frame_subframe
    states = {}
    try:
        for frame in frames:
            scene.frame_set(frame)
            states[str(frame)] = camera_state(scene, bpy.context.evaluated_depsgraph_get())
    finally:
        scene.frame_set(current, subframe=subframe)
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"frames": states}, file, indent=1)


@contextlib.contextmanager
def changed(settings):
    """Changes settings for the time of a `with` statement. `settings`: owner, attribute and value of each.

    They are restored in the same order, as a file format decides which colour depths can be set after it."""
    before = [(owner, name, getattr(owner, name)) for owner, name, _ in settings]
    try:
        for owner, name, value in settings:
            setattr(owner, name, value)
        yield
    finally:
        for owner, name, value in before:
            setattr(owner, name, value)


def action_curves(action):
    """Returns the F-curves of an action, which since Blender 5 are in its layers."""
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags
            for curve in bag.fcurves]


def is_seed_animated(scene):
    """True if a driver or keyframes change Cycles' seed already."""
    data = scene.animation_data
    if data is None:
        return False
    curves = list(data.drivers) + (action_curves(data.action) if data.action else [])
    return any(curve.data_path == "cycles.seed" for curve in curves)


def render_settings(scene, frames, path):
    """Returns the settings with which frames are rendered for Limpid, for changed()."""
    render, image = scene.render, scene.render.image_settings
    settings = [(scene, "frame_start", frames[0]), (scene, "frame_end", frames[-1]), (scene, "frame_step", 1),
                (render, "filepath", path), (render, "use_file_extension", True),
                (render, "use_compositing", False), (render, "use_sequencer", False), (render, "use_multiview", False),
                (render, "use_motion_blur", False),  # with it, Cycles writes no motion vectors
                (render, "use_overwrite", True), (render, "use_placeholder", False),
                (scene.cycles, "use_denoising", False)]
    if not is_seed_animated(scene):  # the same noise in all frames would not average out
        settings.append((scene.cycles, "use_animated_seed", True))
    if hasattr(image, "media_type"):  # Blender 5
        settings.append((image, "media_type", "MULTI_LAYER_IMAGE"))
    return settings + [(image, "file_format", "OPEN_EXR_MULTILAYER"), (image, "color_mode", "RGBA"),
                       (image, "color_depth", "32"), (image, "exr_codec", "ZIP")]


def frame_file(folder, name, frame):
    return os.path.join(folder, f"{name}.{frame:04d}.exr")


def remove_frames(folder, name, frames):
    """Deletes the frames of an earlier run, so that they are not taken for new ones."""
    for frame in frames:
        path = frame_file(folder, name, frame)
        if os.path.isfile(path):
            os.remove(path)


def render_frames(scene, frames, folder):
    """Renders noisy.####.exr. Raises Problem if a file is missing afterwards."""
    path = os.path.join(folder, "noisy.####.exr")
    remove_frames(folder, "noisy", frames)
    current, subframe = scene.frame_current, scene.frame_subframe
    try:
        with changed(render_settings(scene, frames, path)):
            bpy.ops.render.render(animation=True, scene=scene.name)
    except RuntimeError as error:
        raise Problem(f"Rendering failed: {error}") from error
    finally:
        scene.frame_set(current, subframe=subframe)
    require_files(folder, "noisy", frames, "Rendering was cancelled or failed")


def require_files(folder, name, frames, failure):
    for frame in frames:
        if not os.path.exists(frame_file(folder, name, frame)):
            raise Problem(f"{failure}: {frame_file(folder, name, frame)} is missing")


def refuse_other_frames(folder, frames):
    """Raises Problem if there are other rendered frames: `limpid` denoises all that it finds as one sequence."""
    for name in sorted(os.listdir(folder)):
        match = re.fullmatch(r"noisy\.(\d{4,})\.exr", name)
        if match and int(match[1]) not in frames:
            raise Problem(f"{os.path.join(folder, name)} is not among the frames {frames[0]} to {frames[-1]}: "
                          "move or delete the frames of earlier renders")


def find_program(name):
    path = shutil.which(bpy.path.abspath(name))
    if path is None:
        raise Problem(f"The program '{name}' was not found: set its path in the preferences of the add-on")
    return os.path.abspath(path)


def run_limpid(program, folder, number, bidirectional=False):
    """Denoises noisy.NUMBER.exr to clean.NUMBER.exr. `number`: a frame's number or %04d."""
    # Relative names, since a '%' in the folder's name would be read as part of a frame pattern.
    command = [program, "denoise", f"noisy.{number}.exr", "-o", f"clean.{number}.exr", "--camera", "cameras.json"]
    command += ["--bidirectional"] if bidirectional else []
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, errors="replace")
    if result.returncode != 0:
        raise Problem(f"limpid failed with exit code {result.returncode}:\n{result.stderr.strip()}")


def render_and_denoise(scene, folder, frames, program, still=False, bidirectional=False):
    """Renders and denoises the frames into the folder."""
    program = find_program(program)
    check_scene(scene)
    os.makedirs(folder, exist_ok=True)
    if not still:
        refuse_other_frames(folder, frames)
    write_cameras(scene, frames, os.path.join(folder, "cameras.json"))
    render_frames(scene, frames, folder)
    remove_frames(folder, "clean", frames)
    run_limpid(program, folder, f"{frames[0]:04d}" if still else "%04d", bidirectional)
    require_files(folder, "clean", frames, "limpid wrote no picture")


def load_result(folder, frames):
    """Loads the denoised sequence as the image "Limpid". Returns the image."""
    path = frame_file(folder, "clean", frames[0])
    image = bpy.data.images.get("Limpid")
    if image is None:
        image = bpy.data.images.load(path)
        image.name = "Limpid"
    image.source, image.filepath = "SEQUENCE", path
    image.reload()
    return image


def folder_of(scene):
    """Returns the folder `limpid` next to the scene's render output."""
    path = scene.render.filepath
    if path.startswith("//") and not bpy.data.filepath:
        raise Problem("The output path is relative to the .blend file: save that file first")
    return os.path.join(os.path.dirname(os.path.abspath(bpy.path.abspath(path))), "limpid")


def program_of(context):
    """Returns the program in the preferences. They are missing if the add-on runs as a script."""
    addon = context.preferences.addons.get(__name__)
    return addon.preferences.program if addon else "limpid"


class LIMPID_Preferences(bpy.types.AddonPreferences):
    bl_idname = __name__

    program: bpy.props.StringProperty(name="Program", subtype="FILE_PATH", default="limpid",
                                      description="Path of the program limpid, or its name if PATH has it")

    def draw(self, context):
        self.layout.prop(self, "program")


class LIMPID_OT_enable_passes(bpy.types.Operator):
    bl_idname = "limpid.enable_passes"
    bl_label = "Enable passes"
    bl_description = "Switch on the passes that Limpid reads, in all view layers"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        enable_passes(context.scene)
        return {"FINISHED"}


class LIMPID_OT_denoise_sequence(bpy.types.Operator):
    bl_idname = "limpid.denoise_sequence"
    bl_label = "Denoise rendered sequence"
    bl_description = ("Render the animation without motion blur and denoise it, into the folder 'limpid' next to the "
                      "output path. Blender does not respond meanwhile")

    def execute(self, context):
        scene = context.scene
        frames = range(scene.frame_start, scene.frame_end + 1)
        try:
            folder = folder_of(scene)
            render_and_denoise(scene, folder, frames, program_of(context), bidirectional=scene.limpid_bidirectional)
        except (Problem, OSError) as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        load_result(folder, frames)
        self.report({"INFO"}, f"Denoised {len(frames)} frames into {folder}")
        return {"FINISHED"}


class LIMPID_PT_panel(bpy.types.Panel):
    bl_label = "Limpid"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.engine == "CYCLES"

    def draw(self, context):
        self.layout.operator("limpid.enable_passes")
        self.layout.prop(context.scene, "limpid_bidirectional")
        self.layout.operator("limpid.denoise_sequence")


CLASSES = (LIMPID_Preferences, LIMPID_OT_enable_passes, LIMPID_OT_denoise_sequence, LIMPID_PT_panel)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Scene.limpid_bidirectional = bpy.props.BoolProperty(
        name="Both directions", default=True,
        description="Denoise forwards and backwards, so that the first frames are as clean as the others. Takes twice "
                    "as long")


def unregister():
    del bpy.types.Scene.limpid_bidirectional
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)


def frame_range(text):
    """Parses '5' or '1-16'."""
    match = re.fullmatch(r"(\d+)(?:-(\d+))?", text)
    if not match or int(match[2] or match[1]) < int(match[1]):
        raise argparse.ArgumentTypeError(f"'{text}' is not a range of frames such as 1-16")
    return range(int(match[1]), int(match[2] or match[1]) + 1)


def arguments(words):
    parser = argparse.ArgumentParser(prog="blender -b FILE -P limpid_denoise.py --",
                                     description="Render the scene with Cycles and denoise it with limpid.")
    parser.add_argument("--output", required=True, metavar="DIR",
                        help="folder of noisy.####.exr, cameras.json and clean.####.exr")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--frames", type=frame_range, metavar="FIRST-LAST",
                       help="frames to render; default: those of the scene")
    which.add_argument("--still", action="store_true", help="render only the current frame")
    parser.add_argument("--bidirectional", action="store_true",
                        help="denoise forwards and backwards, so that the first frames are as clean as the others")
    parser.add_argument("--limpid", metavar="PATH", default="limpid", help="program; default: limpid from PATH")
    return parser.parse_args(words)


def main(words):
    """Runs the command line. Returns the exit code."""
    given = arguments(words)
    scene = bpy.context.scene
    frames = given.frames or range(scene.frame_start, scene.frame_end + 1)
    if given.still:
        frames = range(scene.frame_current, scene.frame_current + 1)
    try:
        enable_passes(scene)
        render_and_denoise(scene, os.path.abspath(given.output), frames, given.limpid, given.still,
                           given.bidirectional)
    except (Problem, OSError) as problem:
        print(f"Error: {problem}", file=sys.stderr)
        return 1
    except Exception:  # pylint: disable=broad-except  # Blender would exit with 0
        traceback.print_exc()
        return 1
    return 0


if __name__ == "__main__":
    if "--" in sys.argv:
        sys.exit(main(sys.argv[sys.argv.index("--") + 1:]))
    register()
