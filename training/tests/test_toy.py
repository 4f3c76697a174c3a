import json
import os
import subprocess
import tempfile
import unittest

from limpid_training import export, train

PROGRAM = os.environ.get("LIMPID_PROGRAM")


@unittest.skipUnless(PROGRAM, "LIMPID_PROGRAM does not name the program `limpid`")
class ToyTest(unittest.TestCase):
    """Runs docs/kpcn.md, "Try it on a CPU", at a smaller size: from the training data to a denoised frame."""

    def limpid(self, *arguments):
        command = [PROGRAM, *arguments, "--device", "cpu"]
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def rel_mse(self, test):
        command = [PROGRAM, "compare", test, "truth.exr", "--json"]
        return json.loads(subprocess.run(command, cwd=self.folder, capture_output=True, check=True).stdout)["relmse"]

    def test_a_toy_network_denoises_what_it_has_not_seen(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        size = ("--width", "48", "--height", "48")
        self.limpid("dataset", "-o", "data", "--rooms", "6", *size, "--samples", "4", "--reference-samples", "128")

        run = os.path.join(self.folder, "run")
        shape = "--samples 4 --hidden 1 --channels 12 --width 7 --patch 32 --epochs 12 --tuning-epochs 2 --device cpu"
        rates = "--rate-diffuse 2e-3 --rate-specular 2e-3 --rate-tuning 5e-4"
        train.Trainer(train.parse([os.path.join(self.folder, "data"), "-o", run, *shape.split(), *rates.split()])).run()
        export.export(run, os.path.join(self.folder, "toy.safetensors"))

        view = ("render", "builtin:cornell", *size, "--jitter", "off", "--float")
        self.limpid(*view, "-o", "noisy.exr", "--spp", "4", "--aov", "all")
        self.limpid(*view, "-o", "truth.exr", "--spp", "512", "--seed", "1")
        self.limpid("denoise", "noisy.exr", "-o", "clean.exr", "--denoiser", "kpcn", "--weights", "toy.safetensors")
        self.assertLess(self.rel_mse("clean.exr"), 0.5 * self.rel_mse("noisy.exr"))


if __name__ == "__main__":
    unittest.main()
