"""Tests the add-on with a stub instead of the program limpid.

    blender -b --factory-startup --python-exit-code 1 -P tools/blender/test_limpid_denoise.py
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import addon_utils
import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
ADDON = os.path.join(HERE, "limpid_denoise.py")

# Records its arguments and folder, fails if the file `fail` exists beside it, else copies noisy.* to clean.*.
STUB = """#!/bin/sh
here=$(dirname "$0")
pwd > "$here/folder"
printf '%s\\n' "$@" > "$here/arguments"
if [ -e "$here/fail" ]; then echo "no such device" >&2; exit 3; fi
for noisy in noisy.*.exr; do cp "$noisy" "clean.${noisy#noisy.}"; done
"""

ANGLE = 0.9
SETTINGS = {"frame_start": 3, "frame_end": 4, "frame_step": 2}
RENDER = {"use_file_extension": False, "use_compositing": True, "use_sequencer": True, "use_motion_blur": True,
          "use_overwrite": False, "use_placeholder": True}
IMAGE = {"file_format": "JPEG", "color_mode": "BW", "quality": 77}


def build_scene(output):
    """A turned cube; the camera moves along X and looks along +Y, tilted down by 30 degrees."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.light_add(type="SUN")
    data = bpy.data.cameras.new("camera")
    data.angle, data.shift_x, data.shift_y = ANGLE, 0.1, -0.05
    camera = scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(camera)
    camera.rotation_euler = (math.radians(60), 0, 0)
    camera.scale = (2, 3, 4)
    for frame in (3, 4):
        camera.location = (frame, -5, 3)
        camera.keyframe_insert("location", frame=frame)
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.cycles.use_denoising = True
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    scene.render.resolution_percentage = 50
    scene.render.filepath = output
    for owner, values in ((scene, SETTINGS), (scene.render, RENDER), (scene.render.image_settings, IMAGE)):
        for name, value in values.items():
            setattr(owner, name, value)
    scene.frame_set(4)
    return scene


def read(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


def write_stub(folder):
    path = os.path.join(folder, "limpid")
    with open(path, "w", encoding="utf-8") as file:
        file.write(STUB)
    os.chmod(path, 0o755)
    return path


class AddonTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = os.path.realpath(self.temporary.name)
        self.results = os.path.join(self.folder, "100% out", "limpid")
        self.scene = build_scene(os.path.join(self.folder, "100% out", "picture"))
        sys.path.insert(0, HERE)
        self.addon = addon_utils.enable("limpid_denoise", default_set=True)
        sys.path.remove(HERE)
        self.stub = write_stub(self.folder)
        bpy.context.preferences.addons["limpid_denoise"].preferences.program = self.stub

    def tearDown(self):
        addon_utils.disable("limpid_denoise", default_set=True)
        self.temporary.cleanup()

    def denoise(self):
        bpy.ops.limpid.enable_passes()
        return bpy.ops.limpid.denoise_sequence()

    def assert_near(self, values, expected):
        self.assertEqual(len(values), len(expected))
        for value, wanted in zip(values, expected):
            self.assertAlmostEqual(value, wanted, places=5)

    def assert_settings_restored(self):
        scene = self.scene
        for owner, values in ((scene, SETTINGS), (scene.render, RENDER), (scene.render.image_settings, IMAGE)):
            for name, value in values.items():
                self.assertEqual(getattr(owner, name), value, name)
        self.assertEqual(scene.render.filepath, os.path.join(self.folder, "100% out", "picture"))
        self.assertEqual(scene.frame_current, 4)
        self.assertTrue(scene.cycles.use_denoising)
        self.assertFalse(scene.cycles.use_animated_seed)

    def cameras(self):
        return json.loads(read(self.results, "cameras.json"))["frames"]

    def test_enables_passes_of_all_view_layers(self):
        self.scene.view_layers.new("second")
        self.assertEqual(bpy.ops.limpid.enable_passes(), {"FINISHED"})
        for layer in self.scene.view_layers:
            for name in self.addon.PASSES:
                self.assertTrue(getattr(layer, name), name)
            for name in self.addon.CYCLES_PASSES:
                self.assertTrue(getattr(layer.cycles, name), name)

    def test_denoises_the_sequence(self):
        self.assertEqual(self.denoise(), {"FINISHED"})
        names = [f"{kind}.{frame:04d}.exr" for kind in ("clean", "noisy") for frame in (3, 4)]
        self.assertEqual(sorted(os.listdir(self.results)), sorted(names + ["cameras.json"]))
        self.assertEqual(read(self.folder, "folder").strip(), self.results)
        self.assertEqual(read(self.folder, "arguments").split("\n")[:-1],
                         ["denoise", "noisy.%04d.exr", "-o", "clean.%04d.exr", "--camera", "cameras.json",
                          "--bidirectional"])
        self.assert_settings_restored()
        self.scene.limpid_bidirectional = False
        self.assertEqual(self.denoise(), {"FINISHED"})
        self.assertNotIn("--bidirectional", read(self.folder, "arguments"))

    def is_seed_changed_while_rendering(self):
        seen = []

        def look(scene, *_):
            seen.append(scene.cycles.use_animated_seed)

        bpy.app.handlers.render_pre.append(look)
        try:
            self.denoise()
        finally:
            bpy.app.handlers.render_pre.remove(look)
        self.assertEqual(len(seen), 2)
        self.assert_settings_restored()
        return all(seen)

    def test_changes_the_seed_with_the_frame(self):
        self.assertTrue(self.is_seed_changed_while_rendering())

    def test_leaves_an_animated_seed_alone(self):
        self.scene.driver_add("cycles.seed").driver.expression = "frame"
        self.assertFalse(self.is_seed_changed_while_rendering())
        self.scene.driver_remove("cycles.seed")
        self.scene.keyframe_insert("cycles.seed", frame=3)
        self.assertFalse(self.is_seed_changed_while_rendering())

    def test_takes_no_frames_of_an_earlier_render(self):
        self.denoise()
        with unittest.mock.patch.object(self.addon, "bpy"):  # its render does nothing, as if it was cancelled
            with self.assertRaisesRegex(self.addon.Problem, "cancelled or failed"):
                self.addon.render_frames(self.scene, range(3, 5), self.results)
        self.assertFalse([name for name in os.listdir(self.results) if name.startswith("noisy.")])

    def test_renders_multilayer_pictures_with_all_passes(self):
        self.denoise()
        with open(os.path.join(self.results, "noisy.0003.exr"), "rb") as file:
            header = file.read(8192)
        for name in ("Combined.R", "Depth.Z", "Normal.X", "Position.X", "Vector.W", "IndexOB.X", "DiffCol.R",
                     "GlossInd.R", "TransDir.R", "Emit.R", "Env.R", "VolumeDir.R", "Denoising Albedo.R",
                     "Denoising Normal.X", "Denoising Depth.Z"):
            self.assertIn(f".{name}\0".encode(), header)

    def test_loads_the_result(self):
        self.denoise()
        self.denoise()
        images = [image for image in bpy.data.images if image.name.startswith("Limpid")]
        self.assertEqual(len(images), 1)
        self.assertEqual(images[0].source, "SEQUENCE")
        self.assertEqual(images[0].filepath, os.path.join(self.results, "clean.0003.exr"))

    def test_writes_cameras(self):
        self.denoise()
        frames = self.cameras()
        self.assertEqual(list(frames), ["3", "4"])
        for number, camera in frames.items():
            self.assert_near(camera["eye"], [int(number), -5, 3])
            self.assert_near(camera["forward"], [0, math.sqrt(3) / 2, -0.5])
            self.assert_near(camera["up"], [0, 0.5, math.sqrt(3) / 2])
            self.assert_near([camera["fov_y"]], [math.degrees(2 * math.atan(9 / 16 * math.tan(ANGLE / 2)))])
            self.assertIsNone(camera["orthographic_height"])
            self.assert_near(camera["shift"], [0.1, -0.05])

    def test_respects_the_sensor_fit(self):
        self.scene.camera.data.sensor_fit = "VERTICAL"
        self.scene.camera.data.sensor_height = 20
        self.scene.camera.data.lens = 40
        self.denoise()
        self.assert_near([self.cameras()["3"]["fov_y"]], [math.degrees(2 * math.atan(10 / 40))])

    def test_writes_orthographic_cameras(self):
        self.scene.camera.data.type = "ORTHO"
        self.scene.camera.data.ortho_scale = 8
        self.denoise()
        camera = self.cameras()["3"]
        self.assertIsNone(camera["fov_y"])
        self.assert_near([camera["orthographic_height"]], [8 * 9 / 16])

    def test_reports_errors_of_the_program(self):
        open(os.path.join(self.folder, "fail"), "w", encoding="utf-8").close()
        with self.assertRaisesRegex(RuntimeError, "exit code 3:\nno such device"):
            self.denoise()
        self.assert_settings_restored()

    def test_restores_settings_if_rendering_fails(self):
        os.makedirs(os.path.join(self.results, "noisy.0003.exr"))  # a folder, so that Blender cannot write the file
        with self.assertRaises(RuntimeError):
            self.denoise()
        self.assert_settings_restored()

    def test_refuses_before_rendering(self):
        def refused(text):
            with self.assertRaisesRegex(RuntimeError, text):
                bpy.ops.limpid.denoise_sequence()
            self.assertFalse(os.path.exists(self.results) and
                             any(name.startswith("noisy.000") for name in os.listdir(self.results)))
        refused("Enable passes")
        bpy.ops.limpid.enable_passes()
        preferences = bpy.context.preferences.addons["limpid_denoise"].preferences
        preferences.program = "there-is-no-such-program"
        refused("'there-is-no-such-program' was not found")
        preferences.program = self.stub
        self.scene.camera.data.type = "PANO"
        refused("panoramic")
        self.scene.camera = None
        refused("no camera")
        self.scene.render.engine = "BLENDER_WORKBENCH"
        refused("not Cycles")
        self.scene.render.filepath = "//picture"
        refused("save that file first")

    def test_refuses_frames_of_other_renders(self):
        os.makedirs(self.results)
        open(os.path.join(self.results, "noisy.0007.exr"), "w", encoding="utf-8").close()
        with self.assertRaisesRegex(RuntimeError, "not among the frames 3 to 4"):
            self.denoise()


class CommandLineTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = self.temporary.name
        self.stub = write_stub(self.folder)
        build_scene(os.path.join(self.folder, "picture"))
        self.blend = os.path.join(self.folder, "scene.blend")
        bpy.ops.wm.save_as_mainfile(filepath=self.blend)
        self.results = os.path.join(self.folder, "results")

    def tearDown(self):
        self.temporary.cleanup()

    def run_addon(self, *words, path=None):
        command = [bpy.app.binary_path, "-b", "--factory-startup", self.blend, "-P", ADDON, "--",
                   "--output", self.results, *words]
        return subprocess.run(command, capture_output=True, text=True, env={**os.environ, **(path or {})})

    def test_denoises_a_range_with_the_program_from_path(self):
        result = self.run_addon("--frames", "3-4", path={"PATH": self.folder + os.pathsep + os.environ["PATH"]})
        self.assertEqual(result.returncode, 0, result.stderr)
        names = ["cameras.json", "clean.0003.exr", "clean.0004.exr", "noisy.0003.exr", "noisy.0004.exr"]
        self.assertEqual(sorted(os.listdir(self.results)), names)
        self.assertNotIn("--bidirectional", read(self.folder, "arguments"))

    def test_denoises_in_both_directions(self):
        result = self.run_addon("--limpid", self.stub, "--bidirectional")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("--bidirectional", read(self.folder, "arguments"))

    def test_denoises_a_still(self):
        result = self.run_addon("--still", "--limpid", self.stub)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(os.listdir(self.results)), ["cameras.json", "clean.0004.exr", "noisy.0004.exr"])
        self.assertEqual(read(self.folder, "arguments").split("\n")[:-1],
                         ["denoise", "noisy.0004.exr", "-o", "clean.0004.exr", "--camera", "cameras.json"])

    def test_fails_with_the_program(self):
        open(os.path.join(self.folder, "fail"), "w", encoding="utf-8").close()
        result = self.run_addon("--still", "--limpid", self.stub)
        self.assertEqual(result.returncode, 1)
        self.assertIn("no such device", result.stderr)

    def test_fails_without_the_program(self):
        result = self.run_addon("--limpid", os.path.join(self.folder, "missing"))
        self.assertEqual(result.returncode, 1)
        self.assertIn("was not found", result.stderr)

    def test_refuses_a_wrong_range(self):
        result = self.run_addon("--frames", "4-3")
        self.assertEqual(result.returncode, 2)
        self.assertIn("is not a range of frames", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=["test_limpid_denoise.py"] + (sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []))
