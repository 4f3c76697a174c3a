"""Compares pictures of Limpid's `nano` and `film` with those that this package computes by PyTorch.

    python3 -m limpid_training.nano.compare ../build/release/limpid

The program makes small clips with `limpid dataset --denoiser`, which stores what the network sees in each frame, and
the program's picture. PyTorch computes the same picture with the weights in FILE: by default the shipped ones, which
the program must have been built with. Ends with 1 if they differ by more than rounding does."""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile

import torch

from .. import checkpoint
from . import clips, network, weights

#: The files of weights, by network.
SHIPPED = {name: os.path.join(os.path.dirname(__file__), "..", "..", "..", "weights", name + ".safetensors")
           for name in network.SHAPES}

#: With diffuse and specular light, and with edges beside which nothing is seen.
SCENES = ("builtin:still-life-2", "builtin:cornell-spheres", "builtin:lab-mirror")

#: From the first frame, which has no past, to one with a long history.
FRAMES = (0, 1, 2, 12, 32)

#: Largest squared difference of a picture, over that between SVGF's picture and the program's. The program keeps
#: channels and light in half precision, which gives 0.00002 to 0.0002.
TOLERANCE = 5e-4


def make_clips(path, denoiser, folder, scenes, frames, device, width, height):
    made = os.path.join(folder, "clips")
    named = [argument for scene in scenes for argument in ("--scene", scene)]
    command = [os.path.abspath(shutil.which(path) or path), "dataset", "-o", made, "--rooms", 0, *named,
               "--samples", 1, "--sequence", ",".join(map(str, frames)), "--reference-samples", 2,
               "--denoiser", denoiser, "--width", width, "--height", height, "--device", device]
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if result.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{result.stderr}")
    return made


def difference(picture, other, brightness):
    return ((picture - other).square() / (brightness.square() + 0.01)).mean().item()


@torch.no_grad()
def compare(path, net, device="cpu", scenes=SCENES, frames=FRAMES, width=100, height=60):
    """Yields the scene, the number of the frame, and by how much pictures differ from the program's by the same
    network: that of `net`, and that of SVGF. `path`: the program's. The size is best no multiple of net.multiple, so
    that padding is compared, too."""
    with tempfile.TemporaryDirectory() as folder:
        made = make_clips(path, network.name_of(net.shape), folder, scenes, frames, device, width, height)
        names = {example["name"]: example["scene"]
                 for file in clips.manifest_of(made)["files"] for example in file["examples"]}
        for stored in clips.load(made):
            frame = clips.Frame(stored.channels[None])
            ours = frame.compose(network.denoise(net, frame).light)
            yield (names[stored.clip], stored.number, difference(ours, frame.picture, frame.picture),
                   difference(frame.svgf, frame.picture, frame.picture))


def main():
    parser = argparse.ArgumentParser(prog="limpid_training.nano.compare", description=__doc__.split("\n")[0])
    parser.add_argument("program", help="`limpid`")
    parser.add_argument("--network", choices=list(SHIPPED), default="nano")
    parser.add_argument("--weights", metavar="FILE", help="those of --network, if not the shipped ones")
    parser.add_argument("--device", default="cpu", help="on which the program renders")
    chosen = parser.parse_args()
    net = weights.network_in(chosen.weights or SHIPPED[chosen.network])
    if network.name_of(net.shape) != chosen.network:
        checkpoint.end(f"{chosen.weights}: has no weights of '{chosen.network}'", checkpoint.USAGE)
    wrong = False
    for scene, number, ours, svgf in compare(chosen.program, net, chosen.device):
        differs = not ours <= TOLERANCE * svgf
        wrong |= differs
        print(f"{scene}, frame {number}: {ours:.2e}, SVGF's picture {svgf:.2e}" + ": DIFFERS" * differs, flush=True)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
