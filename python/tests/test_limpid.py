"""Tests the package: shapes, errors, denoising; with the tests of test_limpid_rendering.py, which it runs, too.
LIMPID_TEST_DEVICE names the device (default: cpu)."""

import gc
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import unittest
from unittest import mock

import numpy as np

import limpid
from limpid import _arrays, _denoising, _devices
from fixture import device, mse
# In one process: importing takes longer than many of the tests.
from test_limpid_rendering import CameraTest, CompareTest, NetworkTest, RenderTest  # noqa: F401

WIDTH, HEIGHT, FRAMES, FOV = 64, 48, 12, 60.0


def wall(eye_x):
    """Returns the view from (eye_x, 0, 0) of a striped wall at z = -3 that ends at x = 2.5."""
    half = np.tan(np.radians(FOV / 2))
    x = (2 * (np.arange(WIDTH) + 0.5) / WIDTH - 1) * half * WIDTH / HEIGHT
    y = (1 - 2 * (np.arange(HEIGHT) + 0.5) / HEIGHT) * half
    x, y = np.meshgrid(x, y)
    seen = eye_x + 3 * x < 2.5
    depth = np.where(seen, 3 * np.sqrt(x * x + y * y + 1), 0.0)
    normal = np.broadcast_to((0.0, 0.0, 1.0), (HEIGHT, WIDTH, 3)).copy()
    stripes = np.where(np.floor(4 * (eye_x + 3 * x)) % 2 == 0, 0.8, 0.3)
    albedo = stripes[..., None] * (1.0, 0.8, 0.6)
    return depth, normal, albedo, seen[..., None] * albedo * 0.7


def wall_view(eye_x):
    return limpid.look_at((eye_x, 0, 0), (eye_x, 0, -1))


def gain(clean, noisy, truth):
    """Returns the gain of PSNR in dB."""
    return 10 * np.log10(mse(noisy, truth) / mse(clean, truth))


class Sequence:
    """Noisy frames of wall(), seen by a camera that moves to the right, and the noise-free ones."""

    def __init__(self, seed=1):
        random = np.random.default_rng(seed)
        self.frames = []
        for i in range(FRAMES):
            depth, normal, albedo, truth = wall(0.03 * i)
            noisy = truth * random.exponential(size=(HEIGHT, WIDTH, 1))
            inputs = {"radiance": noisy, "normal": normal, "depth": depth, "albedo": albedo,
                      "view": wall_view(0.03 * i), "projection": limpid.perspective(FOV, WIDTH / HEIGHT)}
            self.frames.append((inputs, truth))

    def run(self, denoiser, **more):
        """Denoises all frames and returns the gain of the last one."""
        for inputs, truth in self.frames:
            clean = denoiser.denoise(**{**inputs, **more})
        return gain(clean, inputs["radiance"], truth)


def still():
    """Returns the first frame as arguments of denoise(), without albedo and cameras."""
    inputs = Sequence().frames[0][0]
    return {name: inputs[name].astype(np.float32) for name in ("radiance", "normal", "depth")}


class DeviceTest(unittest.TestCase):
    def test_has_a_name_and_no_messages(self):
        self.assertTrue(device().name)
        self.assertEqual([m for m in device().messages() if m[0] == "error"], [])

    def test_unknown_device_lists_those_there_are(self):
        with self.assertRaises(limpid.Error) as caught:
            limpid.Device("no such device")
        self.assertEqual(caught.exception.code, "unsupported")
        self.assertIn("no such device", str(caught.exception))
        self.assertIsInstance(caught.exception, RuntimeError)

    def test_threads_share_a_device(self):
        made = []

        def make(text):
            time.sleep(0.02)
            made.append(text)
            return object()

        devices, found = _devices.SharedDevices(make), []
        threads = [threading.Thread(target=lambda: found.append(devices.get("cpu"))) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual((made, len(set(found)), len(found)), (["cpu"], 1, 3))

    def test_a_lost_device_is_opened_anew(self):
        both = [_devices.SharedDevices(lambda text: object()) for _ in range(2)]
        lost = [devices.get("cpu") for devices in both]
        for code, same in (("failed", True), ("device_lost", False)):
            with self.assertRaises(limpid.Error), _devices.watched():
                raise limpid.Error("no more", code)
            self.assertEqual([devices.get("cpu") is old for devices, old in zip(both, lost)], [same, same], code)

    def test_every_call_of_a_denoiser_may_lose_its_device(self):
        denoiser, devices = limpid.Denoiser(8, 8, device=device()), _devices.SharedDevices(lambda text: object())
        denoiser._handle = mock.Mock()
        for name, arguments in (("resize", (4, 4)), ("reset", ()), ("set", ("svgf.alpha", 0.5)), ("timings", ())):
            getattr(denoiser._handle, name).side_effect = limpid.Error("no more", "device_lost")
            lost = devices.get("cpu")
            self.assertRaises(limpid.Error, getattr(denoiser, name), *arguments)
            self.assertIsNot(devices.get("cpu"), lost, name)

    def test_other_modules_open_the_device_that_was_chosen(self):
        # By its name they would open the first of several that are alike.
        self.assertEqual(_denoising.text_of(device()), os.environ.get("LIMPID_TEST_DEVICE", "cpu"))

    @unittest.skipUnless(hasattr(os, "fork"), "needs fork")
    def test_a_forked_process_refuses_what_its_parent_opened(self):
        denoiser = limpid.Denoiser(8, 8, "temporal", device=device())
        uses = denoiser.reset, lambda: limpid.Denoiser(8, 8, device=device())
        child = os.fork()
        if child == 0:
            try:
                signal.alarm(60)
                refused = 0
                for use in uses:
                    try:
                        use()
                    except limpid.Error as error:
                        refused += "forked" in str(error)
                denoiser = uses = None
                gc.collect()  # destroying the denoiser would wait for ever
                os._exit(refused)
            finally:
                os._exit(99)
        self.assertEqual(os.waitpid(child, 0)[1], 2 << 8, "the exit status is 2")

    def test_pipeline_cache_comes_back(self):
        limpid.Denoiser(8, 8, "temporal", device=device())
        data = device().pipeline_cache()
        self.assertGreater(len(data), 8)  # more than a checksum; lavapipe's has a header and no pipelines
        other = limpid.Device(os.environ.get("LIMPID_TEST_DEVICE", "cpu"))
        other.load_pipeline_cache(data)
        self.assertGreaterEqual(len(other.pipeline_cache()), len(data))
        other.load_pipeline_cache(b"damaged")


class ShapeTest(unittest.TestCase):
    def setUp(self):
        self.denoiser = limpid.Denoiser(WIDTH, HEIGHT, "temporal", device=device())

    def assertNames(self, argument, function, *args, **kwargs):
        with self.assertRaises(ValueError) as caught:
            function(*args, **kwargs)
        self.assertTrue(str(caught.exception).startswith(argument + ":"), str(caught.exception))

    def test_result_is_height_width_3_float32(self):
        result = self.denoiser.denoise(**still())
        self.assertEqual((result.shape, result.dtype), ((HEIGHT, WIDTH, 3), np.float32))
        self.assertTrue(np.isfinite(result).all())

    def test_wrong_shapes_name_the_argument(self):
        flat = np.zeros((HEIGHT, WIDTH), np.float32)
        small = np.zeros((HEIGHT, WIDTH - 1, 3), np.float32)
        for name, value in (("radiance", flat), ("radiance", small), ("normal", flat), ("normal", small[..., :2]),
                            ("depth", small), ("depth", flat[:-1]), ("albedo", flat), ("motion", flat),
                            ("emission", small), ("previous_normal", flat), ("id", np.zeros((3, 3), np.uint32)),
                            ("view", np.eye(3)), ("projection", np.zeros(16)), ("previous_view", np.eye(3)),
                            ("jitter", 0.5)):
            with self.subTest(name, shape=np.shape(value)):
                self.assertNames(name, self.denoiser.denoise, **{**still(), name: value})

    def test_wrong_dtypes_name_the_argument(self):
        image = np.zeros((HEIGHT, WIDTH, 3))
        for name, value in (("radiance", image.astype(np.uint8)), ("normal", image.astype(np.int32)),
                            ("albedo", image.astype(bool)), ("emission", image.astype(complex)),
                            ("motion", image.astype("U1")), ("id", image[..., 0]), ("view", np.eye(4).astype(complex)),
                            ("id", np.full((HEIGHT, WIDTH), -1))):
            with self.subTest(name, dtype=value.dtype):
                self.assertNames(name, self.denoiser.denoise, **{**still(), name: value})

    def test_missing_inputs_name_the_argument(self):
        self.assertNames("radiance", self.denoiser.denoise, **{**still(), "radiance": None})
        self.assertNames("specular", self.denoiser.denoise, **still(), specular=still()["radiance"])
        self.assertNames("roughness", self.denoiser.denoise, **still(), hit_distance=still()["depth"])
        two = limpid.Denoiser(WIDTH, HEIGHT, device=device(), signals=2, samples=4)
        self.assertNames("specular", two.denoise, **still())
        light, depth = still()["radiance"], still()["depth"]
        self.assertNames("specular_variance", two.denoise, **still(), specular=light, radiance_variance=depth)
        self.assertNames("radiance_variance", two.denoise, **still(), specular=light, specular_variance=depth)
        self.assertNames("specular_variance", self.denoiser.denoise, **still(), specular_variance=depth)
        self.assertNames("radiance_variance", self.denoiser.denoise, **still(), radiance_variance=depth)
        with_buffer = limpid.Denoiser(WIDTH, HEIGHT, "temporal", device=device(), depth_encoding="device")
        self.assertNames("projection", with_buffer.denoise, **still())

    def test_wrong_options_name_the_argument(self):
        for name, value in (("method", "nlm"), ("signals", 3), ("normal_encoding", "rgb"), ("normal_space", "object"),
                            ("depth_encoding", "z"), ("far_depth", 0), ("motion_unit", "px"), ("motion_depth", "3d"),
                            ("motion_direction", "back"), ("clip_y", "left"), ("samples", 0)):
            with self.subTest(name):
                self.assertNames(name, limpid.Denoiser, WIDTH, HEIGHT, device=device(), **{name: value})
        self.assertNames("width", limpid.Denoiser, 0, HEIGHT, device=device())
        self.assertNames("height", self.denoiser.resize, WIDTH, 1.5)
        self.assertNames("outputs", self.denoiser.denoise, **still(), outputs="clean")

    def test_known_noise_decides_how_much_is_filtered(self):
        inputs = still()
        inputs["radiance"] = np.random.default_rng(1).uniform(0.4, 0.6, (HEIGHT, WIDTH, 3)).astype(np.float32)
        changes = []
        for variance in 0.0, 1.0:
            known = np.full((HEIGHT, WIDTH), variance)
            clean = limpid.denoise(**inputs, radiance_variance=known, samples=32, device=device())
            changes.append(np.abs(clean - inputs["radiance"])[inputs["depth"] > 0].mean())
        self.assertLess(changes[0], 0.5 * changes[1])

    def test_half_double_and_strided_arrays_give_the_same(self):
        inputs = {name: value.astype(np.float16).astype(np.float32) for name, value in still().items()}
        expected = self.denoiser.denoise(**inputs, reset=True)
        wide = np.full((2 * HEIGHT, WIDTH, 5), np.nan, np.float32)
        wide[::2, :, 1:4] = inputs["radiance"]
        flipped = np.ascontiguousarray(inputs["radiance"][::-1, ::-1, ::-1])[::-1, ::-1, ::-1]
        for radiance in (inputs["radiance"].astype(np.float16), inputs["radiance"].astype(np.float64),
                         inputs["radiance"].astype(">f4"), wide[::2, :, 1:4], flipped,
                         np.dstack([inputs["radiance"], np.ones((HEIGHT, WIDTH), np.float32)]),
                         inputs["radiance"].tolist()):
            result = self.denoiser.denoise(**{**inputs, "radiance": radiance}, reset=True)
            np.testing.assert_array_equal(result, expected)

    def test_broadcast_arrays_are_read(self):
        inputs = still()
        inputs["radiance"] = np.broadcast_to(np.float32(0.5), (HEIGHT, WIDTH, 3))
        inputs["normal"] = np.broadcast_to(np.array((0, 0, 1), np.float32), (HEIGHT, WIDTH, 3))
        np.testing.assert_allclose(self.denoiser.denoise(**inputs)[inputs["depth"] > 0], 0.5, atol=1e-3)

    def test_only_what_the_library_cannot_read_is_copied(self):
        depth = np.ones((4, 6), np.float32)
        for array in depth, depth[::2, 1:], np.ones((1, 6), np.float32):
            self.assertTrue(np.shares_memory(_arrays.image("depth", array, (1,)), array))
        for array in depth[::-1], np.broadcast_to(np.float32(1), (4, 6)):
            copied = _arrays.image("depth", array, (1,))
            self.assertTrue(copied.flags.c_contiguous)
            np.testing.assert_array_equal(copied[..., 0], array)

    def test_names_of_files_are_those_of_the_system(self):
        for name in b"\xff.exr", os.fsdecode(b"\xff.exr"), pathlib.Path(os.fsdecode(b"\xff.exr")):
            self.assertEqual(_arrays.path("scene", name), b"\xff.exr")
        self.assertEqual(_arrays.path("scene", None), b"")
        self.assertRaisesRegex(TypeError, "^scene: ", _arrays.path, "scene", 7)
        self.assertRaisesRegex(ValueError, "^scene: ", _arrays.path, "scene", "a\0b")

    def test_one_pixel_and_odd_sizes(self):
        for height, width in ((1, 1), (1, 7), (5, 1), (3, 13)):
            radiance = np.full((height, width, 3), 0.25, np.float32)
            normal = np.broadcast_to((0.0, 0.0, 1.0), radiance.shape)
            result = limpid.denoise(radiance, normal, np.ones((height, width)), device=device())
            self.assertEqual(result.shape, (height, width, 3))
            np.testing.assert_allclose(result, 0.25, atol=1e-3)

    def test_resize(self):
        self.denoiser.denoise(**still())
        self.denoiser.resize(8, 4)
        self.assertEqual((self.denoiser.width, self.denoiser.height), (8, 4))
        small = {name: value[:4, :8] for name, value in still().items()}
        self.assertEqual(self.denoiser.denoise(**small).shape, (4, 8, 3))
        self.assertNames("radiance", self.denoiser.denoise, **still())

    def test_library_errors_have_their_message(self):
        with self.assertRaises(limpid.Error) as caught:
            self.denoiser.denoise(**still(), view=np.zeros((4, 4)))
        self.assertIn("singular", str(caught.exception))
        with self.assertRaises(limpid.Error):
            self.denoiser.denoise(**still(), outputs=("radiance",))  # SVGF and what goes on from it only
        self.denoiser.denoise(**still())  # an error must not end the sequence


class ParameterTest(unittest.TestCase):
    def test_every_parameter_has_its_default_and_can_be_set(self):
        for method in ("svgf", "atrous", "temporal", "bilateral", "visibility", "nano", "film"):
            denoiser = limpid.Denoiser(8, 8, method, device=device())
            self.assertEqual(denoiser.parameters(), limpid.parameters(method))
            self.assertGreater(len(denoiser.parameters()), 3)
            for name, p in denoiser.parameters().items():
                self.assertEqual(p.name, name)
                self.assertTrue(p.help, name)
                self.assertIs(type(denoiser.get(name)), p.type, name)
                self.assertAlmostEqual(denoiser.get(name), p.default, places=5, msg=name)
                denoiser.set(name, p.minimum)
                self.assertAlmostEqual(denoiser.get(name), p.minimum, places=5, msg=name)

    def test_wrong_names_and_values_are_refused(self):
        denoiser = limpid.Denoiser(8, 8, device=device())
        for name, value in (("svgf.nothing", 1.0), ("svgf.alpha", 17.0), ("svgf.alpha", float("nan")),
                            ("svgf.levels", 2.5), ("svgf.wide", 0.5)):
            with self.assertRaises(limpid.Error) as caught:
                denoiser.set(name, value)
            self.assertEqual(caught.exception.code, "invalid_argument")
            self.assertIn(name, str(caught.exception))
        with self.assertRaises(limpid.Error):
            denoiser.get("svgf.nothing")
        with self.assertRaises(limpid.Error):
            limpid.Denoiser(8, 8, device=device(), parameters={"svgf.nothing": 1.0})

    def test_a_parameter_changes_the_picture(self):
        plain = limpid.denoise(**still(), device=device())
        changed = limpid.denoise(**still(), device=device(), parameters={"svgf.phi_color": 0.1})
        self.assertGreater(mse(plain, changed), 0.0)


class DenoiseTest(unittest.TestCase):
    def test_sequence_comes_closer_to_the_truth(self):
        for method in ("svgf", "atrous", "temporal", "nano", "film"):
            with self.subTest(method):
                self.assertGreater(Sequence().run(limpid.Denoiser(WIDTH, HEIGHT, method, device=device())), 6.0)

    def test_a_mask_comes_closer_to_the_truth(self):
        random = np.random.default_rng(1)
        depth, normal, _, _ = wall(0.0)
        truth = np.where(np.arange(WIDTH) < WIDTH // 2, 0.7, 0.2) * np.ones((HEIGHT, 1))
        denoiser = limpid.Denoiser(WIDTH, HEIGHT, "visibility", device=device())
        for _ in range(FRAMES):
            noisy = (random.uniform(size=truth.shape) < truth).astype(np.float32)
            clean = denoiser.denoise(noisy, normal, depth, view=wall_view(0.0),
                                     projection=limpid.perspective(FOV, WIDTH / HEIGHT))
        self.assertLess(mse(clean[depth > 0, 0], truth[depth > 0]), 0.05 * mse(noisy[depth > 0], truth[depth > 0]))
        self.assertEqual(limpid.denoise(noisy, normal, depth, method="visibility", device=device()).shape, clean.shape)

    def test_previous_camera_is_remembered(self):
        sequence = Sequence()
        remembering = limpid.Denoiser(WIDTH, HEIGHT, device=device())
        told = limpid.Denoiser(WIDTH, HEIGHT, device=device())
        before = None
        for inputs, _ in sequence.frames:
            before = before or inputs
            a = remembering.denoise(**inputs)
            b = told.denoise(**inputs, previous_view=before["view"], previous_projection=before["projection"])
            before = inputs
        np.testing.assert_array_equal(a, b)
        standing = limpid.Denoiser(WIDTH, HEIGHT, device=device())
        for inputs, truth in sequence.frames:
            c = standing.denoise(**inputs, previous_view=inputs["view"])
        self.assertGreater(mse(c, truth), mse(a, truth))

    def test_motion_does_as_well_as_the_camera(self):
        # When the camera moves right by 0.03, a wall at distance 3 appears to move left.
        pixels = 0.03 / 3 / np.tan(np.radians(FOV / 2)) * HEIGHT / 2
        motion = np.zeros((HEIGHT, WIDTH, 2))
        motion[..., 0] = pixels
        by_camera = Sequence().run(limpid.Denoiser(WIDTH, HEIGHT, device=device()))
        by_motion = Sequence().run(limpid.Denoiser(WIDTH, HEIGHT, device=device()), motion=motion)
        in_uv = Sequence().run(limpid.Denoiser(WIDTH, HEIGHT, device=device(), motion_unit="uv",
                                               motion_direction="from_previous"), motion=-motion / (WIDTH, HEIGHT))
        self.assertAlmostEqual(by_motion, by_camera, delta=0.5)
        self.assertAlmostEqual(in_uv, by_motion, delta=0.01)

    def test_encodings_mean_the_same(self):
        expected = limpid.denoise(**still(), device=device())
        images = still()
        unorm = dict(images, normal=0.5 * images["normal"] + 0.5)
        linear = dict(images, depth=np.where(images["depth"] > 0, 3.0, 0.0))
        octahedral = dict(images, normal=np.zeros((HEIGHT, WIDTH, 2)))
        for inputs, options in ((unorm, {"normal_encoding": "unorm"}), (linear, {"depth_encoding": "linear"}),
                                (octahedral, {"normal_encoding": "octahedral_signed"}),
                                (images, {"normal_space": "view"}), (images, {"clip_y": "up"})):
            with self.subTest(**options):
                np.testing.assert_allclose(limpid.denoise(**inputs, device=device(), **options), expected, atol=2e-3)

    def test_reset_forgets(self):
        sequence = Sequence()
        used = limpid.Denoiser(WIDTH, HEIGHT, device=device())
        sequence.run(used)
        used.reset()
        fresh = limpid.Denoiser(WIDTH, HEIGHT, device=device())
        first = sequence.frames[0][0]
        expected = fresh.denoise(**first)
        np.testing.assert_array_equal(used.denoise(**first), expected)
        np.testing.assert_array_equal(used.denoise(**first, reset=True), expected)

    def test_emission_is_added_and_not_filtered(self):
        emission = np.random.default_rng(3).random((HEIGHT, WIDTH, 3), np.float32)
        inputs = still()
        plain = limpid.denoise(**inputs, device=device(), method="atrous")
        lit = limpid.denoise(**inputs, emission=emission, device=device(), method="atrous")
        seen = inputs["depth"] > 0
        np.testing.assert_allclose((lit - plain)[seen], emission[seen], atol=2e-3)

    def test_outputs_of_two_signals_add_up(self):
        inputs = still()
        for method in ("svgf", "nano", "film"):
            results = limpid.denoise(**inputs, specular=0.5 * inputs["radiance"], demodulated=True, device=device(),
                                     method=method, outputs=("color", "radiance", "specular"))
            self.assertEqual(list(results), ["color", "radiance", "specular"])
            np.testing.assert_allclose(results["color"], results["radiance"] + results["specular"], atol=5e-3)

    def test_identifiers_part_surfaces(self):
        id = np.zeros((HEIGHT, WIDTH), np.uint8)
        id[:, WIDTH // 2:] = 7
        self.assertEqual(limpid.denoise(**still(), id=id, device=device()).shape, (HEIGHT, WIDTH, 3))

    def test_timings(self):
        denoiser = limpid.Denoiser(WIDTH, HEIGHT, device=device(), timings=True)
        for _ in range(3):
            denoiser.denoise(**still())
        timings = denoiser.timings()
        self.assertTrue(timings)
        self.assertTrue(all(isinstance(name, str) and time >= 0 for name, time in timings.items()))

    def test_threads_may_use_one_device_and_one_denoiser(self):
        shared = limpid.Denoiser(WIDTH, HEIGHT, device=device())
        expected = limpid.denoise(**still(), device=device())
        results = []

        def work():
            own = limpid.Denoiser(WIDTH, HEIGHT, device=device())
            for _ in range(3):
                results.append(own.denoise(**still(), reset=True))
                results.append(shared.denoise(**still(), reset=True))

        threads = [threading.Thread(target=work) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(results), 18)
        for result in results:
            np.testing.assert_array_equal(result, expected)

    def test_another_thread_may_resize(self):
        denoiser = limpid.Denoiser(WIDTH, HEIGHT, "temporal", device=device())
        small, large = {name: value[:4, :8] for name, value in still().items()}, still()
        done, successes = threading.Event(), 0

        def resize():
            while not done.wait(0.001):
                denoiser.resize(8, 4)
                denoiser.resize(WIDTH, HEIGHT)

        thread = threading.Thread(target=resize)
        thread.start()
        try:
            for inputs in 20 * [small, large]:
                try:
                    self.assertEqual(denoiser.denoise(**inputs).shape, inputs["radiance"].shape)
                    successes += 1
                except ValueError:
                    pass  # the denoiser had the other size
        finally:
            done.set()
            thread.join()
        self.assertGreater(successes, 0)
        denoiser.resize(WIDTH, HEIGHT)
        fresh = limpid.Denoiser(WIDTH, HEIGHT, "temporal", device=device())
        np.testing.assert_array_equal(denoiser.denoise(**large, reset=True), fresh.denoise(**large))

    def test_other_threads_run_meanwhile(self):
        # Counts while the device works; if the GIL were held, it would barely advance.
        denoiser = limpid.Denoiser(512, 512, device=device())
        shape = (512, 512, 3)
        normal = np.broadcast_to(np.array((0, 0, 1), np.float32), shape).copy()
        arguments = np.ones(shape, np.float32), normal, np.ones(shape[:2], np.float32)
        denoiser.denoise(*arguments)
        done, counts = threading.Event(), [0]

        def count():
            while not done.wait(0.001):
                counts[0] += 1

        thread = threading.Thread(target=count)
        thread.start()
        before = counts[0]
        for _ in range(5):
            denoiser.denoise(*arguments)
        during = counts[0] - before
        done.set()
        thread.join()
        self.assertGreater(during, 5)


class PackageTest(unittest.TestCase):
    def test_denoising_works_without_the_renderer(self):
        code = ("import sys; sys.modules['limpid._renderer'] = None\n"
                "import limpid\n"
                "try: limpid.render('builtin:cornell', 8, 8)\n"
                "except ImportError as error: print(error, limpid.__version__)\n")
        text = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout
        self.assertIn("limpid.render and limpid.compare are missing", text)
        self.assertIn(limpid.__version__, text)

    def test_denoising_works_without_the_network(self):
        code = ("import sys; sys.modules['limpid._neural'] = None\n"
                "import limpid\n"
                "try: limpid.Network()\n"
                "except ImportError as error: print(error)\n")
        text = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout
        self.assertIn("limpid.Network and the method 'kpcn' are missing", text)

    def test_version_has_three_numbers(self):
        self.assertEqual(len([int(part) for part in limpid.__version__.split(".")]), 3)


if __name__ == "__main__":
    unittest.main()
