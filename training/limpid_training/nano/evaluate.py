"""Measures how far pictures are from clean ones, clip by clip, beside SVGF's.

    python3 -m limpid_training.nano.evaluate RUN CLIPS [--pictures FOLDER]

RUN is the output folder of limpid_training.nano.train, or a file of weights."""

import argparse
import math
import os

import torch
from torch.nn import functional

from .. import checkpoint, pictures
from . import clips, loss, network, weights

#: What is measured, and how. The first three are unbiased however noisy the references are (loss.py); the others have
#: the references' noise in them.
ERRORS = {
    "square": "squared differences in linearised sRGB",
    "relative": "squared differences over the squared luminance around",
    "blocks": "squared differences of means over 8x8 pixels, in linearised sRGB: blotches",
    "absolute": "absolute differences of sRGB",
    "blurred": "absolute differences of means over 5x5 pixels, in linearised sRGB",
}


def errors_of(picture, frame):
    """Returns the errors of a picture of a clips.Frame, by name."""
    scale = loss.weights_of(frame)
    mean = 0.5 * (frame.references[0] + frame.references[1])
    plain = loss.product(picture, frame.references, torch.ones_like(scale))
    blocks = [functional.avg_pool2d((picture - reference) * scale, 8) for reference in frame.references]
    numbers = {
        # Limits: a firefly of a reference would otherwise decide. They are far above what pictures' errors are.
        "square": (plain * scale * scale).clamp(-1, 1),
        "relative": (plain.mean(1, keepdim=True) / loss.squared_brightness(frame)).clamp(-4, 4),
        "blocks": blocks[0] * blocks[1],
        "absolute": (loss.srgb(picture) - loss.srgb(mean)).abs(),
        "blurred": (loss.blurred(picture - mean, 2) * scale).abs(),
    }
    return {name: numbers[name].mean().item() for name in ERRORS}


@torch.no_grad()
def evaluate(net, frames):
    """Returns for each of these clips.Stored a dict: the clip, the frame's number, the errors of the network's picture,
    of SVGF's, and of the accumulated light, and the noise of the mean of both references (as "absolute")."""
    results = []
    for stored in frames:
        frame = clips.Frame(stored.channels[None])
        made = {"network": frame.compose(network.denoise(net, frame).light), "svgf": frame.svgf,
                "accumulated": frame.compose(frame.accumulated)}
        result = {name: errors_of(picture, frame) for name, picture in made.items()}
        first, second = frame.references
        result["noise"] = 0.5 * (loss.srgb(first) - loss.srgb(second)).abs().mean().item()
        results.append({"clip": stored.clip, "frame": stored.number, **result})
    return results


def mean_of(results, name):
    """Returns the mean errors of the picture of this name."""
    return {error: sum(result[name][error] for result in results) / len(results) for error in ERRORS}


def by(results, key):
    """Groups results by "clip" or "frame"."""
    groups = {}
    for result in results:
        groups.setdefault(result[key], []).append(result)
    return groups


def ratios(results):
    """Returns the errors over those of SVGF: of each clip, and over the clips the geometric mean. Each clip then counts
    alike; in means of errors, the noisiest decides."""
    sums = dict.fromkeys(ERRORS, 0.0)
    groups = by(results, "clip").values()
    for group in groups:
        ours, svgf = mean_of(group, "network"), mean_of(group, "svgf")
        for error in ERRORS:
            # Unbiased estimates of errors that are about 0 can be negative.
            sums[error] += math.log(max(ours[error], 1e-9) / max(svgf[error], 1e-9))
    return {error: math.exp(value / len(groups)) for error, value in sums.items()}


def line(results):
    """Returns the mean errors as text: the network's, SVGF's, and by how much they differ."""
    ours, svgf = mean_of(results, "network"), mean_of(results, "svgf")
    return "  ".join(f"{error} {ours[error]:.6f}/{svgf[error]:.6f} ({100 * (ours[error] / svgf[error] - 1):+.1f} %)"
                     if svgf[error] else f"{error} {ours[error]:.6f}/0" for error in ERRORS)


@torch.no_grad()
def row(net, stored):
    """Returns four pictures side by side, for display: accumulated light, SVGF's, the network's, and the reference."""
    frame = clips.Frame(stored.channels[None])
    mean = 0.5 * (frame.references[0] + frame.references[1])
    made = [frame.compose(frame.accumulated), frame.svgf, frame.compose(network.denoise(net, frame).light), mean]
    return loss.srgb(torch.cat(made, 3)[0]).cpu()


def main():
    parser = argparse.ArgumentParser(prog="limpid_training.nano.evaluate", description=__doc__.split("\n")[0])
    parser.add_argument("run", help="output folder of limpid_training.nano.train, or a file of weights")
    parser.add_argument("clips", help="output folder of `limpid dataset --sequence`, of another --seed than the "
                        "training's")
    parser.add_argument("--pictures", help="folder for pictures of the last frame of each clip: accumulated light, "
                        "SVGF's, the network's, reference")
    parser.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    chosen = parser.parse_args()
    net = weights.network_in(chosen.run).to(chosen.device)
    try:
        frames = clips.load(chosen.clips, chosen.device)
    except (OSError, ValueError) as fault:
        checkpoint.end(str(fault), checkpoint.UNREADABLE)
    results = evaluate(net, frames)
    for name, text in ERRORS.items():
        print(f"{name}: {text}")
    print("network / SVGF (difference)")
    for key in ("clip", "frame"):
        for name, group in by(results, key).items():
            print(f"{key} {name}: {line(group)}")
    print(f"mean: {line(results)}")
    print("clips' geometric mean over SVGF's: " + "  ".join(f"{k} {v:.4f}" for k, v in ratios(results).items()))
    noise = sum(result["noise"] for result in results) / len(results)
    print(f"noise of the references in 'absolute': {noise:.6f}")
    if chosen.pictures:
        os.makedirs(chosen.pictures, exist_ok=True)
        for stored in {frame.clip: frame for frame in frames}.values():
            pictures.write_png(os.path.join(chosen.pictures, stored.clip + ".png"), row(net, stored))


if __name__ == "__main__":
    main()
