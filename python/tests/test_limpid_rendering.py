"""Tests the package: networks, cameras, comparing, rendering. test_limpid.py runs these tests, too. LIMPID_TEST_DEVICE
names the device (default: cpu)."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import weakref

import numpy as np

import limpid
from fixture import device, mse


WEIGHTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "weights", "kpcn.safetensors")


class Stop(Exception):
    """Raised by a signal's handler, as KeyboardInterrupt is by Ctrl+C."""


def stop_after(test, seconds):
    """Raises Stop in the main thread after so many seconds."""
    def stop(number, frame):
        raise Stop

    test.addCleanup(signal.signal, signal.SIGALRM, signal.signal(signal.SIGALRM, stop))
    test.addCleanup(signal.setitimer, signal.ITIMER_REAL, 0)
    signal.setitimer(signal.ITIMER_REAL, seconds)


def seconds_of(call):
    began = time.monotonic()
    call()
    return time.monotonic() - began


class NetworkTest(unittest.TestCase):
    DEVICE = os.environ.get("LIMPID_TEST_DEVICE", "cpu")

    @classmethod
    def setUpClass(cls):
        cls.noisy = limpid.render("builtin:cornell", 24, 16, spp=16, device=device())
        names = ("diffuse", "specular", "emission", "albedo", "normal", "depth", "diffuse_variance",
                 "specular_variance", "albedo_variance", "normal_variance", "depth_variance")
        cls.inputs = {name: cls.noisy[name] for name in names}
        cls.inputs["samples"] = 16
        try:
            cls.network = limpid.Network(device=cls.DEVICE)
        except ImportError as error:  # built without oneDNN
            raise unittest.SkipTest(str(error))

    @classmethod
    def tearDownClass(cls):
        cls.network = None

    def test_is_what_render_does_itself(self):
        clean = self.network.denoise(**self.inputs)
        self.assertEqual((clean.shape, clean.dtype), ((16, 24, 3), np.float32))
        for weights in WEIGHTS, None:
            own = limpid.render("builtin:cornell", 24, 16, spp=16, device=device(), denoiser="kpcn", weights=weights)
            np.testing.assert_allclose(clean, own["color"], rtol=2e-3, atol=1e-4)

    def test_weights_of_the_packages_own_prefix_are_found(self):
        with tempfile.TemporaryDirectory() as prefix:
            packages, share = (os.path.join(prefix, *path.split("/")) for path in ("lib/python3/site", "share/limpid"))
            shutil.copytree(os.path.dirname(limpid.__file__), os.path.join(packages, "limpid"))
            os.makedirs(share)
            os.symlink(os.path.realpath(WEIGHTS), os.path.join(share, "kpcn.safetensors"))
            code = f"limpid.render('builtin:cornell', 8, 8, spp=8, denoiser='kpcn', device={self.DEVICE!r})"
            paths = os.pathsep.join([packages, os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
            subprocess.run([sys.executable, "-c", "import limpid; " + code], check=True, cwd=prefix,
                           env=dict(os.environ, PYTHONPATH=paths))

    @unittest.skipUnless(DEVICE == "cpu", "the frames of GPUs are too short")
    def test_signals_are_handled_meanwhile(self):
        side, whole = 64, 0.0
        while whole < 1.0:
            white = np.ones((side, side, 3), np.float32)
            inputs = {"diffuse": white, "normal": white, "depth": white[..., 0], "diffuse_variance": white[..., 0]}
            expected = self.network.denoise(**inputs)  # the first frame of a size takes longer
            whole = seconds_of(lambda: self.network.denoise(**inputs))
            side = int(side * min(max((1.2 / whole) ** 0.5, 1.2), 4.0))
        stop_after(self, 0.05)
        began = time.monotonic()
        with self.assertRaises(Stop):
            self.network.denoise(**inputs)
        self.assertLess(time.monotonic() - began, 0.5 * whole)
        np.testing.assert_array_equal(self.network.denoise(**inputs), expected)

    @unittest.skipUnless(DEVICE == "cpu", "the frames of GPUs are too short")
    def test_what_a_signal_left_is_given_back(self):
        white = np.ones((128, 128, 3), np.float32)
        depth, given_back = np.ones((128, 128), np.float32), threading.Event()
        weakref.finalize(depth, given_back.set)
        stop_after(self, 0.01)
        with self.assertRaises(Stop):
            for _ in range(1000):
                self.network.denoise(white, white, depth, diffuse_variance=white[..., 0])
        del depth
        for _ in range(100):
            self.network.get("kpcn.tile")  # waits for the frame
            if given_back.wait(0.01):
                return
        self.fail("the array is kept")

    def test_denoise_has_it_as_a_method(self):
        inputs = dict(self.inputs)
        light = inputs.pop("diffuse")
        clean = limpid.denoise(light, **inputs, method="kpcn", device=device(), parameters={"kpcn.levels": 0},
                               view=self.noisy["view"], projection=self.noisy["projection"])
        self.network.set("kpcn.levels", 0)
        np.testing.assert_array_equal(clean, self.network.denoise(**self.inputs))
        self.network.set("kpcn.levels", self.network.parameters()["kpcn.levels"].default)
        self.assertGreater(mse(clean, self.network.denoise(**self.inputs)), 0.0)
        with self.assertRaises(ValueError):
            limpid.denoise(light, **inputs, method="kpcn", device=device(), outputs=("color",))

    def test_parameters_are_the_networks(self):
        self.assertEqual(limpid.parameters("kpcn"), self.network.parameters())
        self.assertEqual(self.network.get("kpcn.tile"), 512)
        for name, value in (("svgf.alpha", 0.5), ("kpcn.tile", 0), ("kpcn.errors", float("nan"))):
            with self.assertRaises(limpid.Error) as caught:
                self.network.set(name, value)
            self.assertEqual(caught.exception.code, "invalid_argument")
            self.assertIn(name, str(caught.exception))

    def test_wrong_arguments_are_named(self):
        flat = self.inputs["depth"]
        for name, value in (("diffuse", flat), ("normal", flat), ("depth", self.inputs["normal"]), ("normal", None),
                            ("specular_variance", None), ("diffuse_variance", flat[1:]), ("samples", 0)):
            with self.subTest(name), self.assertRaises(ValueError) as caught:
                self.network.denoise(**{**self.inputs, name: value})
            self.assertTrue(str(caught.exception).startswith(name + ":"), str(caught.exception))
        with self.assertRaises(limpid.Error) as caught:
            self.network.denoise(**{**self.inputs, "diffuse": np.full_like(self.inputs["diffuse"], np.nan)})
        self.assertEqual(caught.exception.code, "invalid_argument")

    def test_weights_that_are_missing_are_named(self):
        with self.assertRaises(limpid.Error) as caught:
            limpid.Network("there is no such file", device=self.DEVICE)
        self.assertIn("there is no such file", str(caught.exception))


class CameraTest(unittest.TestCase):
    def test_look_at_puts_the_target_in_front(self):
        view = limpid.look_at((1, 2, 3), (1, 2, -1))
        np.testing.assert_allclose(view @ (1, 2, 3, 1), (0, 0, 0, 1), atol=1e-12)
        np.testing.assert_allclose(view @ (2, 3, -1, 1), (1, 1, -4, 1), atol=1e-12)

    def test_look_at_refuses_what_is_no_view(self):
        aslant = np.array((0.1, 0.7, 0.3), np.float32)
        for arguments, text in ((((1, 2, 3), (1, 2, 3)), "the same point"), (((0, 0, 0), (0, 1, 0)), "along the view"),
                                ((aslant, 3 * aslant, 7 * aslant), "along the view"),
                                (((0, 0, 0), (0, 0, 1), (0, 0, 0)), "up is 0"),
                                (((np.nan, 0, 0), (0, 0, 1)), "eye: needs three finite numbers"),
                                (((0, 0, 0), (0, 0, np.inf)), "target: needs"),
                                (((0, 0, 0), (0, 0, 1), (0, np.nan, 0)), "up: needs"),
                                (((0, 0), (0, 1)), "eye: needs"),
                                (((1e308, 0, 0), (-1e308, 0, 0)), "along the view")):
            with self.assertRaisesRegex(ValueError, text), np.errstate(all="ignore"):
                limpid.look_at(*arguments)
        np.testing.assert_allclose(limpid.look_at((0, 0, 0), (0, 0, -1e200)), np.eye(4), atol=1e-12)

    def test_perspective_is_vulkans(self):
        for far in (100.0, np.inf):
            projection = limpid.perspective(90, 2, near=0.5, far=far)
            near = projection @ (1, 0.5, -0.5, 1)
            np.testing.assert_allclose(near / near[3], (1, -1, 0, 1), atol=1e-12)
            end = projection @ (0, 0, -min(far, 1e12), 1)
            self.assertAlmostEqual(end[2] / end[3], 1, places=9)
        self.assertGreater(limpid.perspective(90, 1, clip_y="up")[1, 1], 0)
        with self.assertRaises(ValueError):
            limpid.perspective(180, 1)


class CompareTest(unittest.TestCase):
    def setUp(self):
        self.picture = np.random.default_rng(5).random((32, 40, 3), np.float32)

    def test_equal_pictures(self):
        result = limpid.compare(self.picture, self.picture)
        self.assertEqual(result["psnr"], np.inf)
        self.assertAlmostEqual(result["ssim"], 1.0, places=6)
        self.assertEqual((result["flip"], result["relmse"], result["invalid_pixels"]), (0.0, 0.0, 0))

    def test_known_answers(self):
        black, grey = np.zeros((16, 16, 3)), np.full((16, 16, 3), 0.5)
        result = limpid.compare(grey, black, exposure=0)
        shown = 1.055 * 0.5 ** (1 / 2.4) - 0.055  # sRGB
        self.assertAlmostEqual(result["psnr"], -20 * np.log10(shown), places=4)
        self.assertAlmostEqual(result["relmse"], 0.25 / 0.01, places=3)
        green, blue = black + (0, 1, 0), black + (0, 0, 1)
        self.assertAlmostEqual(limpid.compare(green, blue, exposure=0)["flip"], 1.0, places=3)

    def test_wrong_arguments(self):
        for test, reference, word in ((self.picture[1:], self.picture, "test:"), (self.picture, self.picture[..., 0],
                                                                                  "reference:"),
                                      (self.picture.astype(np.uint8), self.picture, "test:")):
            with self.assertRaises(ValueError) as caught:
                limpid.compare(test, reference)
            self.assertTrue(str(caught.exception).startswith(word), str(caught.exception))
        with self.assertRaises(ValueError):
            limpid.compare(self.picture, self.picture, exposure=100)
        invalid = self.picture.copy()
        invalid[0, 0, 0] = np.nan
        self.assertEqual(limpid.compare(invalid, self.picture)["invalid_pixels"], 1)
        with self.assertRaises(limpid.Error):
            limpid.compare(self.picture, invalid)


class RenderTest(unittest.TestCase):
    def render(self, **more):
        return limpid.render("builtin:cornell", 32, 32, **{"spp": 4, "device": device(), **more})

    def test_layers_have_their_keys_shapes_and_types(self):
        layers = self.render()
        self.assertTrue(layers["color"].flags.writeable)
        three = {"color", "diffuse", "specular", "emission", "albedo", "albedo_specular", "normal", "previous_normal",
                 "motion", "reflection_motion"}
        one = {"depth", "id", "roughness", "hit_distance", "diffuse_variance", "specular_variance", "albedo_variance",
               "normal_variance", "depth_variance"}
        self.assertEqual(set(layers), three | one | {"view", "projection"})
        for name, value in layers.items():
            shape = (4, 4) if name in ("view", "projection") else (32, 32, 3) if name in three else (32, 32)
            self.assertEqual(value.shape, shape, name)
        self.assertEqual((layers["id"].dtype, layers["color"].dtype), (np.uint32, np.float32))
        np.testing.assert_allclose(layers["color"], layers["diffuse"] + layers["specular"] + layers["emission"],
                                   rtol=1e-5, atol=1e-6)
        self.assertGreater(layers["color"].mean(), 0)

    def test_a_seed_decides_the_noise(self):
        first, again, other = self.render(seed=3), self.render(seed=3), self.render(seed=4)
        for name in first:
            np.testing.assert_array_equal(first[name], again[name], err_msg=name)
        self.assertGreater(mse(first["color"], other["color"]), 0)

    def test_matrices_are_the_cameras(self):
        # Reprojecting the pixels with depth must give their positions back.
        layers = self.render(spp=1)
        to_world = np.linalg.inv(layers["projection"] @ layers["view"])
        eye = np.linalg.inv(layers["view"])[:3, 3]
        x, y = np.meshgrid(2 * (np.arange(32) + 0.5) / 32 - 1, 2 * (np.arange(32) + 0.5) / 32 - 1)
        points = np.stack([x, y, np.full_like(x, 0.5), np.ones_like(x)], axis=2) @ to_world.T
        ray = points[..., :3] / points[..., 3:] - eye
        ray /= np.linalg.norm(ray, axis=2, keepdims=True)
        hits = eye + layers["depth"][..., None] * ray
        floor = (layers["normal"][..., 1] > 0.99) & (y > 0.8)
        self.assertGreater(floor.sum(), 10)
        np.testing.assert_allclose(hits[floor][:, 1], 0, atol=2e-3)

    def test_options_reach_the_renderer(self):
        dark = self.render(parameters={"pathtrace.max_depth": np.float64(0), "svgf.wide": np.False_})
        self.assertLess(dark["color"].mean(), self.render()["color"].mean())
        clean = self.render(denoiser="svgf", spp=1)
        self.assertLess(np.abs(np.diff(clean["color"] - clean["emission"], axis=0)).mean(),
                        np.abs(np.diff(clean["diffuse"] + clean["specular"], axis=0)).mean())
        aside = self.render(eye=(0.2, 0.27, 0.5), target=(0.27, 0.27, 0), fov=50, spp=1)
        np.testing.assert_allclose(np.linalg.inv(aside["view"])[:3, 3], (0.2, 0.27, 0.5), atol=1e-5)

    def test_wrong_arguments(self):
        for more, code in (({"denoiser": "nlm"}, "invalid_argument"), ({"camera": "nobody"}, "invalid_argument"),
                           ({"parameters": {"pathtrace.no": 1}}, "invalid_argument"),
                           ({"environment": "no-such-file.hdr"}, "unreadable"),
                           ({"jitter": "some"}, "invalid_argument")):
            with self.assertRaises(limpid.Error, msg=str(more)) as caught:
                self.render(**more)
            self.assertEqual(caught.exception.code, code)
        with self.assertRaises(limpid.Error) as caught:
            limpid.render("no-such-file.glb", 8, 8, device=device())
        self.assertIn("no-such-file.glb", str(caught.exception))
        for name, value in (("spp", 0), ("spp", 1.5), ("seed", -1), ("seed", 2**32), ("seed", "1"),
                            ("eye", (np.nan, 0, 0)), ("target", (0, 0)), ("target", (1e39, 0, 0)),
                            ("environment", "a\0b")):
            with self.subTest(name, value=value), self.assertRaises(ValueError) as caught:
                self.render(**{name: value})
            self.assertTrue(str(caught.exception).startswith(name + ":"), str(caught.exception))
        with self.assertRaises(ValueError):
            limpid.render_sequence("builtin:cornell", 8, 8, frames=2, first=-1, device=device())
        with self.assertRaises(TypeError):
            self.render(samples=4)

    def test_rendered_sequence_is_denoised(self):
        arguments = "builtin:cornell-moving", 48, 48
        truth = list(limpid.render_sequence(*arguments, frames=6, spp=128, device=device(), seed=9))[-1]["color"]
        denoiser = limpid.Denoiser(48, 48, device=device(), signals=2, motion_depth="distance")
        for f in limpid.render_sequence(*arguments, frames=6, device=device()):
            clean = denoiser.denoise(
                f["diffuse"], f["normal"], f["depth"], specular=f["specular"], emission=f["emission"],
                albedo=f["albedo"], albedo_specular=f["albedo_specular"], motion=f["motion"],
                previous_normal=f["previous_normal"], id=f["id"], view=f["view"], projection=f["projection"])
        self.assertTrue(np.isfinite(f["motion"]).all())
        self.assertLess(np.abs(f["motion"][..., :2]).min(), 48)
        before, after = limpid.compare(f["color"], truth), limpid.compare(clean, truth)
        self.assertGreater(after["psnr"], before["psnr"] + 6, (before, after))
        self.assertLess(after["flip"], before["flip"])

    def test_an_open_shutter_blurs_what_moves(self):
        def frame(**options):
            return next(limpid.render_sequence("builtin:cornell-moving", 48, 48, frames=2, first=1, fps=4, spp=8,
                                               device=device(), jitter="off", **options))

        sharp, blurred, short = frame(), frame(shutter=1), frame(shutter=1e-6)
        np.testing.assert_allclose(short["normal"], sharp["normal"], atol=1e-3)
        change = np.abs(blurred["normal"] - sharp["normal"]).max(axis=-1)
        moving = np.abs(sharp["motion"][..., :2]).max(axis=-1) > 1
        self.assertGreater(moving.sum(), 20)
        self.assertGreater(change[moving].mean(), 0.05)
        self.assertLess(change[~moving].mean(), 0.02)
        self.assertGreater(np.abs(frame(shutter=1, shutter_position="end")["normal"] - blurred["normal"]).max(), 0.05)
        for options in {"denoiser": "svgf"}, {"shutter": -1}, {"shutter_position": "middle"}:
            with self.subTest(options), self.assertRaises(limpid.Error) as caught:
                frame(**{"shutter": 1, **options})
            self.assertEqual(caught.exception.code, "invalid_argument")

    def test_a_still_takes_no_options_of_sequences(self):
        for options in {"shutter": 1}, {"animation": "all"}, {"fps": 24}:
            with self.subTest(options), self.assertRaisesRegex(TypeError, "render_sequence"):
                limpid.render("builtin:cornell", 8, 8, 1, device=device(), **options)

    def test_names_of_scenes_need_not_be_utf_8(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = os.path.join(os.fsencode(folder), b"\xff.obj")
            with open(scene, "w") as file:
                file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
            for name in scene, os.fsdecode(scene):
                self.assertEqual(limpid.render(name, 4, 4, spp=1, device=device())["id"].max(), 1)
        with self.assertRaisesRegex(limpid.Error, r"\\xff\.obj"):
            limpid.render(scene, 4, 4, device=device())

    def test_signals_are_handled_meanwhile(self):
        stop_after(self, 0.2)
        with self.assertRaises(Stop):
            self.render(spp=1 << 24)  # takes minutes

    @unittest.skipUnless(NetworkTest.DEVICE == "cpu", "the frames of GPUs are too short")
    def test_signals_are_handled_within_a_frame(self):
        def frames(spp):
            return limpid.render_sequence("builtin:cornell", 32, 32, frames=1, spp=spp, denoiser="svgf",
                                          device=device())

        next(frames(1))  # compiles
        spp, short = 64, 0.0
        while short < 0.4 and spp < 16384:
            spp *= 4
            short = seconds_of(lambda frame=frames(spp): next(frame))
        most = min(10 * spp, 65536)
        frame, expected = frames(most), short * most / spp
        stop_after(self, 0.2)
        began = time.monotonic()
        with self.assertRaises(Stop):
            next(frame)
        self.assertLess(time.monotonic() - began, 0.5 * expected)

    def test_other_threads_run_while_a_renderer_waits(self):
        # Renderers of a device take turns, and so do those that are no longer needed.
        busy = limpid.render_sequence("builtin:cornell", 32, 32, frames=1, spp=512, device=device())
        waiting = limpid.render_sequence("builtin:cornell", 8, 8, frames=1, device=device())
        done, counts = threading.Event(), [0]

        def count():
            while not done.wait(0.001):
                counts[0] += 1

        threads = [threading.Thread(target=count), threading.Thread(target=next, args=(busy,))]
        for thread in threads:
            thread.start()
        time.sleep(0.05)
        before, began = counts[0], time.monotonic()
        del waiting
        during, seconds = counts[0] - before, time.monotonic() - began
        done.set()
        for thread in threads:
            thread.join()
        self.assertGreaterEqual(during, 20 * seconds)

    def test_builtin_scenes(self):
        self.assertIn("builtin:cornell", limpid.builtin_scenes())


if __name__ == "__main__":
    unittest.main()
