"""Compares pictures of Limpid's `nano` with those that this package computes by PyTorch from the same frames.

    python3 -m limpid_training.nano.compare ../build/release/limpid

The program makes small clips, in which `limpid dataset` stores what the network sees of SVGF's work, and renders the
same frames again with `--denoiser nano`. Its pictures are compared with those that the weights in FILE give by PyTorch:
by default the shipped ones, which the program must have been built with. Ends with 1 if they differ by more than
rounding does.

Only the first frames are compared. Later ones see pictures of the frames before, and those of `nano` are others than
SVGF's, which are in the clips."""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile

import torch

from .. import pictures
from . import clips, network, weights

SHIPPED = os.path.join(os.path.dirname(__file__), "..", "..", "..", "weights", "nano.safetensors")

#: With diffuse and specular light, and with edges beside which nothing is seen.
SCENES = ("builtin:still-life-2", "builtin:cornell-spheres", "builtin:lab-mirror")

#: Largest difference of a picture, over that between SVGF's picture and the program's. The program keeps channels and
#: light in half precision, which gives 0.00002 to 0.00015.
TOLERANCE = 5e-4

#: `limpid render` computes the same frame as `limpid dataset`, but for rounding: a dataset scales the camera's field of
#: view, and be it by 1. This is the largest difference of SVGF's picture, in which only that matters.
SAME_FRAME = 1e-5

LAST_64_BITS, LAST_32_BITS = (1 << 64) - 1, (1 << 32) - 1


def hash_of(text):
    """Hash64 of src/base/hash.h."""
    state, data = 0xCBF29CE484222325, text.encode()
    data += bytes(8 - len(data) % 8)
    words = [int.from_bytes(data[i : i + 8], "little") for i in range(0, len(data), 8)]
    for word in (*words, len(text)):
        state = (state ^ word) * 0x100000001B3 & LAST_64_BITS
        state ^= state >> 32
    return state


def drawn(purpose, example, seed):
    """numberFrom() of apps/lab/dataset/dataset.cpp: what a data set of this seed draws for an example."""
    x = hash_of(f"{purpose} {seed} {example}")
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9 & LAST_64_BITS
    x = (x ^ x >> 27) * 0x94D049BB133111EB & LAST_64_BITS
    return (x ^ x >> 31) & LAST_32_BITS


class Program:
    """Runs `limpid` in a folder."""

    def __init__(self, path, folder, device, width, height):
        self.path, self.folder = os.path.abspath(shutil.which(path) or path), folder
        self.common = ["--width", width, "--height", height, "--device", device]

    def run(self, *arguments):
        command = [self.path, *map(str, arguments)]
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        if result.returncode:
            raise SystemExit(f"{' '.join(command)}\n{result.stderr}")
        return result.stdout

    def make_clips(self, scenes):
        named = [argument for scene in scenes for argument in ("--scene", scene)]
        self.run("dataset", "-o", "clips", "--rooms", 0, *named, "--samples", 1, "--sequence", 0,
                 "--reference-samples", 1, *self.common)
        return os.path.join(self.folder, "clips")

    def render(self, example, seed, denoiser):
        """Renders an example of a manifest again. Returns the name of the picture."""
        name = f"{example['name']}.{denoiser}.exr"
        self.run("render", example["scene"], "-o", name, "--denoiser", denoiser, "--float", "--spp", 1, "--jitter",
                 "off", "--seed", seed, "--frames", 1, "--camera-path", example["camera_path"], "--fps",
                 repr(example["frames_per_second"]), "--time", repr(example["start"]), *self.common)
        return name

    def difference(self, image, rendered):
        """The relMSE (docs/metrics.md) of an image (3, rows, columns) against a rendered one."""
        pictures.write_pfm(os.path.join(self.folder, "image.pfm"), image)
        return json.loads(self.run("compare", "image.pfm", rendered, "--json"))["relmse"]


@torch.no_grad()
def compare(path, net, device="cpu", scenes=SCENES, width=100, height=60):
    """Yields the scene, and how much pictures differ from the program's by `nano`: that of `net`, and that of SVGF.
    `path`: the program's. The size is best no multiple of net.multiple, so that padding is compared, too.

    Ends the program if `limpid render` does not compute the frames of the clips."""
    with tempfile.TemporaryDirectory() as folder:
        program = Program(path, folder, device, width, height)
        made = program.make_clips(scenes)
        manifest = clips.manifest_of(made)
        examples = [example for file in manifest["files"] for example in file["examples"]]
        for number, (example, stored) in enumerate(zip(examples, clips.load(made))):
            seed = drawn("samples", number, manifest["dataset"]["seed"])  # the manifest does not have it
            frame, scene = clips.Frame(stored.channels[None]), example["scene"]
            off = program.difference(frame.svgf[0], program.render(example, seed, "svgf"))
            if not off <= SAME_FRAME:
                raise SystemExit(f"{scene}: limpid render computes another frame than limpid dataset (relMSE {off:g})")
            theirs = program.render(example, seed, "nano")
            ours = frame.compose(network.denoise(net, frame).light)
            yield scene, program.difference(ours[0], theirs), program.difference(frame.svgf[0], theirs)


def main():
    parser = argparse.ArgumentParser(prog="limpid_training.nano.compare", description=__doc__.split("\n")[0])
    parser.add_argument("program", help="`limpid`")
    parser.add_argument("--weights", metavar="FILE", default=SHIPPED)
    parser.add_argument("--device", default="cpu", help="on which the program renders")
    chosen = parser.parse_args()
    wrong = False
    for scene, ours, svgf in compare(chosen.program, weights.network_in(chosen.weights), chosen.device):
        differs = not ours <= TOLERANCE * svgf
        wrong |= differs
        print(f"{scene}: relMSE {ours:.2e}, of SVGF's picture {svgf:.2e}" + ": DIFFERS" * differs, flush=True)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
