"""Writes the expected results with which the C++ tests compare their inference.

    python3 -m limpid_training.fixture ../tests/data

kpcn_small.safetensors is a small network with random weights. kpcn_cases.safetensors holds frames ("CASE/LAYER", as in
a data set but in single precision) and what the networks compute from them: "CASE/clean" (the denoised picture without
emission), "CASE/SIDE.clean" (denoised light of each side, in network space) and its standard error,
"CASE/SIDE.deviation"."""

import argparse
import json
import math
import os

import torch
from torch.nn import functional

from . import features, tensor_file
from .network import ANY_FACING, Kpcn

#: name: rows, columns
CASES = {"small": (37, 45), "shipped": (23, 30), "anywhere": (19, 26), "linear": (21, 24)}
SMALL = {"hidden": 2, "channels": 20, "width": 7}


def frame(rows, columns, generator):
    """Returns a synthetic frame: a disc in front of a background, with noisy light and some pixels without a hit."""

    def random(channels):
        return torch.rand(1, channels, rows, columns, generator=generator)

    y, x = torch.meshgrid(torch.arange(float(rows)), torch.arange(float(columns)), indexing="ij")
    near = ((x - columns / 2) ** 2 + (y - rows / 2) ** 2 < (rows / 4) ** 2)[None, None]
    nothing = (x + y < rows / 3)[None, None]
    albedo = torch.where(near, 0.1 + 0.8 * (x % 7) / 7, 0.5 - 0.4 * (y % 5) / 5).expand(1, 3, -1, -1).clone()
    # The disc has vertical bands. The normals of the second and third are 56 and 64 degrees from the first band's:
    # just inside and just outside the limit of 60 degrees (network.FACING). The fourth has the opposite normal. Some
    # lengths differ from 1, since the normal of an edge pixel is a mean.
    normal = torch.tensor([1.0, 0.0, 0.0])[:, None, None]
    for band, (degrees, length) in enumerate([(53, 0.4), (109, 1.0), (117, 2.0), (233, 1.0)]):
        turned = torch.tensor([0.0, math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])[:, None, None]
        normal = torch.where(near & (x // 3 % 4 == band)[None, None], length * turned, normal)
    layers = {"diffuse": albedo * (0.2 + random(3) ** 4), "specular": 3 * random(3) ** 8}
    layers.update(albedo=albedo, normal=normal)
    layers["depth"] = torch.where(near, 2.0 + 0.01 * x, 5.0 + 0.1 * y)
    for name in list(layers):
        layers[name] = torch.where(nothing, torch.zeros(1), layers[name])
        scale = 0.02 if name in ("diffuse", "specular") else 0.001
        layers[name + ".variance"] = torch.where(nothing, torch.zeros(1), scale * random(1))
    return {name: image.contiguous() for name, image in layers.items()}


def small_network():
    torch.manual_seed(20)
    net = Kpcn(**SMALL)
    with torch.no_grad():
        for name, parameter in net.named_parameters():
            if name.endswith("bias"):
                parameter.uniform_(-0.2, 0.2)
            if "output.weight" in name:
                parameter.mul_(8.0)  # makes the kernels less flat
    return net


def load(path):
    weights, metadata = tensor_file.read(path)
    net = Kpcn(**json.loads(metadata["limpid.shape"]))
    net.load_state_dict({name: weight.float() for name, weight in weights.items()})
    return net


def deviation(logits, variance, normal, facing):
    """Returns the standard error of the means that apply_kernel() computes, for light with this `variance` whose noise
    is independent from pixel to pixel. Written independently of apply_kernel(), with all taps at once."""
    width = round(logits.shape[1] ** 0.5)
    rows, columns = variance.shape[2:]

    def taps(image):
        return functional.unfold(image, width, padding=width // 2).view(1, width * width, rows, columns)

    length = normal.norm(dim=1, keepdim=True)
    unit = normal / torch.where(length > 0, length, torch.ones_like(length))
    cosine = sum(taps(unit[:, c : c + 1]) * unit[:, c : c + 1] for c in range(3))
    nothing = (length == 0).to(normal.dtype)
    alike = (cosine >= facing) | (taps(nothing) * nothing > 0)
    weights = torch.softmax(logits.masked_fill(~alike | (taps(torch.ones_like(variance)) == 0), -torch.inf), dim=1)
    return (weights**2 * taps(variance)).sum(dim=1, keepdim=True).sqrt()


def variances(layers):
    """Returns the variance of each side's light in network space (features.to_network()), to first order."""
    diffuse = layers["diffuse.variance"] / (features.luminance(layers["albedo"]) + features.EPSILON) ** 2
    return {"diffuse": diffuse, "specular": features.seen("specular", layers)[1]}


@torch.no_grad()
def cases(networks):
    """Returns the tensors of kpcn_cases.safetensors by name. They are computed in double precision."""
    generator = torch.Generator().manual_seed(7)
    result = {}
    for name, (rows, columns) in CASES.items():
        layers = frame(rows, columns, generator)
        exact = {layer: image.double() for layer, image in layers.items()}
        prepared, variance = networks[name].prepare(exact), variances(exact)
        net = networks[name].double()
        clean = {}
        for side in features.SIDES:
            clean[side + ".clean"], logits = net.side_and_logits(side, prepared)
            clean[side + ".deviation"] = deviation(logits.double(), variance[side], exact["normal"], net.facing)
        clean["clean"] = net(prepared)
        for layer, image in {**layers, **clean}.items():
            result[f"{name}/{layer}"] = image[0].float()
    return result


def networks(data, weights):
    """Returns the network of each case. "anywhere" is "small" without the condition on normals, and
    "linear" is "small" with diffuse light itself as its input."""
    small = os.path.join(data, "kpcn_small.safetensors")
    result = {"small": load(small), "shipped": load(weights), "anywhere": load(small), "linear": load(small)}
    result["anywhere"].facing = ANY_FACING
    result["linear"].diffuse_input = "linear"
    return result


SHIPPED = os.path.join(os.path.dirname(__file__), "..", "..", "weights", "kpcn.safetensors")


def main():
    parser = argparse.ArgumentParser(prog="limpid_training.fixture", description=__doc__.split("\n")[0])
    parser.add_argument("output", help="folder to write to")
    folder = parser.parse_args().output
    small = os.path.join(folder, "kpcn_small.safetensors")
    metadata = {"limpid.network": "kpcn", "limpid.shape": json.dumps(SMALL)}
    tensor_file.write(small, dict(small_network().state_dict()), metadata)
    tensor_file.write(os.path.join(folder, "kpcn_cases.safetensors"), cases(networks(folder, SHIPPED)))


if __name__ == "__main__":
    main()
