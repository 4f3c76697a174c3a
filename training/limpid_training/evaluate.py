"""Measures the error of a trained network on each example of a data set.

    python3 -m limpid_training.evaluate RUN DATA

Prints the relMSE (docs/metrics.md) of the noisy and of the denoised picture, and their ratio. Pictures are diffuse
plus specular light, without emission."""

import argparse

import torch

from . import checkpoint, data
from .network import network_of


def rel_mse(image, reference):
    return ((image - reference) ** 2 / (reference**2 + 0.01)).mean().item()


@torch.no_grad()
def evaluate(run, folder, device="cpu"):
    """Yields (scene, relMSE of the noisy picture, relMSE of the denoised picture) for every example of the data
    set."""
    state = checkpoint.load(run, device)
    options = state["options"]
    net = network_of(options).to(device)
    net.load_state_dict(state["net"])
    examples = data.Dataset(folder, options["samples"], device)
    for index in range(len(examples)):
        frame = examples[index]
        prepared = net.prepare(frame)
        noisy = rel_mse(frame["diffuse"] + frame["specular"], prepared["target"])
        yield examples.examples[index][2], noisy, rel_mse(net(prepared), prepared["target"])


def main():
    parser = argparse.ArgumentParser(prog="limpid_training.evaluate", description=__doc__.split("\n")[0])
    parser.add_argument("run", help="output folder of limpid_training.train")
    parser.add_argument("data", help="output folder of `limpid dataset`; its scenes should not be those of the run")
    parser.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    chosen = parser.parse_args()
    ratios, known = [], 0
    learnt = set(checkpoint.load(chosen.run).get("learnt", ()))
    print(f"{'scene':<32}{'noisy':>10}{'denoised':>10}{'ratio':>8}")
    for scene, noisy, denoised in evaluate(chosen.run, chosen.data, chosen.device):
        ratios.append(denoised / max(noisy, 1e-12))
        known += scene in learnt
        print(f"{scene:<32}{noisy:>10.5f}{denoised:>10.5f}{ratios[-1]:>8.3f}")
    print(f"mean ratio {sum(ratios) / len(ratios):.3f}")
    if known:
        print(f"{known} of the {len(ratios)} scenes were trained on; take a data set of another --seed")


if __name__ == "__main__":
    main()
