"""Tests denoise_shot() and explain_shot() on frames by Blender: the same files as the program writes, bit for bit.
LIMPID_TEST_DEVICE names the device (default: cpu); LIMPID_PROGRAM is the program."""

import os
import shutil
import subprocess
import tempfile
import unittest
import warnings

import limpid

SHOTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tests", "data", "shots")
DEVICE = os.environ.get("LIMPID_TEST_DEVICE", "cpu")
PROGRAM = os.environ.get("LIMPID_PROGRAM")


def contents(path):
    with open(path, "rb") as file:
        return file.read()


class ShotTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.shot = os.path.join(SHOTS, "camera.%04d.exr")
        self.first, self.last = 13, 14

    def path(self, name):
        return os.path.join(self.folder, name)

    def program(self, *arguments):
        if not PROGRAM:
            self.skipTest("LIMPID_PROGRAM is not set")
        return subprocess.run([PROGRAM, "denoise", self.shot, *arguments], check=True, capture_output=True,
                              text=True).stdout

    def test_writes_the_same_bits_as_the_program(self):
        options = ["--device", DEVICE, "--bidirectional", "--strength", "0.75", "--preserve", "0.3",
                   "--set", "svgf.levels=3"]
        self.program("-o", self.path("a.%04d.exr"), *options)
        calls = []
        summary = limpid.denoise_shot(self.shot, self.path("b.%04d.exr"), device=DEVICE, bidirectional=True,
                                      strength=0.75, preserve=0.3, parameters={"svgf.levels": 3.0},
                                      progress=lambda done, total: calls.append((done, total)))
        self.assertEqual(calls, [(0, 2), (0, 2), (1, 2), (2, 2)], "backwards, then forwards")
        self.assertEqual((summary["frames"], summary["skipped"], summary["cuts"]), (2, 0, 0))
        for frame in (self.first, self.last):
            self.assertEqual(contents(self.path(f"a.{frame:04d}.exr")), contents(self.path(f"b.{frame:04d}.exr")))

    def test_explains_as_the_program(self):
        lines = limpid.explain_shot(self.shot)
        self.assertIn("layers of Cycles", lines)
        self.assertEqual(lines, self.program("--explain"))
        self.assertIn("albedo          ViewLayer.Normal", limpid.explain_shot(
            self.shot, map={"albedo": "ViewLayer.Normal.XYZ"}, frames=self.first))

    def test_an_exception_in_progress_stops_the_run(self):
        def stop(done, total):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            limpid.denoise_shot(self.shot, self.path("c.%04d.exr"), device=DEVICE, progress=stop)
        # What was written before is complete.
        self.assertEqual(os.listdir(self.folder), [f"c.{self.first:04d}.exr"])

    def test_progress_stops_backward_runs(self):
        class Stop(Exception):
            pass

        def stop(done, total):
            raise Stop

        with self.assertRaises(Stop):
            limpid.denoise_shot(self.shot, self.path("c.%04d.exr"), device=DEVICE, bidirectional=True, progress=stop)
        self.assertEqual(os.listdir(self.folder), [])

    def test_errors_have_codes(self):
        cases = [("invalid_argument", {"denoiser": "none such"}), ("unreadable", {"map": {"albedo": "No.RGB"}}),
                 ("unreadable", {"cameras": self.path("missing.json")}), ("unreadable", {"frames": (1, 99)})]
        for code, options in cases:
            with self.subTest(options), self.assertRaises(limpid.Error) as caught:
                limpid.denoise_shot(self.shot, self.path("d.%04d.exr"), device=DEVICE, **options)
            self.assertEqual(caught.exception.code, code, caught.exception)

    def test_warns_of_damaged_frames(self):
        for frame in (self.first, self.last):
            data = contents(self.shot % frame)
            with open(self.path(f"e.{frame:04d}.exr"), "wb") as file:
                file.write(data if frame == self.first else data[:len(data) // 2])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            summary = limpid.denoise_shot(self.path("e.%04d.exr"), self.path("f.%04d.png"), device=DEVICE,
                                          skip_unreadable=True)
        self.assertEqual((summary["frames"], summary["skipped"]), (1, 1))
        self.assertTrue(any("e.0014.exr" in str(w.message) for w in caught), [str(w.message) for w in caught])

    def damage_all(self):
        """Writes two frames that are skipped, so that none is left. A single one would be an error at once."""
        for frame in (self.first, self.last):
            with open(self.path(f"e.{frame:04d}.exr"), "wb") as file:
                file.write(contents(self.shot % frame)[:5000])

    def test_warns_also_if_it_fails(self):
        self.damage_all()
        with self.assertWarnsRegex(UserWarning, "e.0014.exr"), self.assertRaises(limpid.Error):
            limpid.denoise_shot(self.path("e.%04d.exr"), self.path("f.%04d.exr"), device=DEVICE, skip_unreadable=True)

    def test_warnings_as_errors_do_not_replace_a_failure(self):
        self.damage_all()
        with warnings.catch_warnings(), self.assertRaises(limpid.Error):
            warnings.simplefilter("error")
            limpid.denoise_shot(self.path("e.%04d.exr"), self.path("f.%04d.exr"), device=DEVICE, skip_unreadable=True)

    def test_names_of_files_need_not_be_utf_8(self):
        folder = os.fsencode(self.folder)
        source, output = os.path.join(folder, b"\xff.exr"), os.path.join(folder, b"\xfe.exr")
        shutil.copyfile(self.shot % self.first, source)
        self.assertIn("\\xff.exr", limpid.explain_shot(source))
        for name in os.fsdecode, lambda file: file:
            limpid.denoise_shot(name(source), name(output), device=DEVICE)
            os.unlink(output)
        with self.assertRaisesRegex(limpid.Error, r"no \\xff\.exr"):
            limpid.denoise_shot(os.path.join(folder, b"no \xff.exr"), output, device=DEVICE)


if __name__ == "__main__":
    unittest.main()
