"""Clips for the tests of limpid_training.nano: a checkerboard under smooth light."""

import json
import os

import torch

from limpid_training import tensor_file
from limpid_training.nano import clips

#: Channels in files, where they are more than the network uses.
STORED = {"diffuse.first": 4, "specular.first": 4, "diffuse.svgf": 4, "specular.svgf": 4, "svgf": 4}

#: A camera that looks along the world's x axis; up is z, and right is minus y.
CAMERA = torch.tensor([[0.0, -1.0, 0.0], [0.0, 0.0, 2.0], [1.0, 0.0, 0.0], [7.0, 8.0, 9.0]])


def make_frame(rows, columns, generator):
    """Returns the layers of a frame. SVGF's light is a fifth too dark, and the accumulated light is right but for its
    noise, so that there is something to learn. Nothing is seen in the first row."""

    def noise(channels=3, scale=1.0):
        return scale * (2 * torch.rand(channels, rows, columns, generator=generator) - 1)

    y, x = torch.meshgrid(torch.arange(float(rows)), torch.arange(float(columns)), indexing="ij")
    albedo = (0.2 + 0.6 * ((x // 4 + y // 4) % 2)).expand(3, -1, -1)
    seen = (y > 0).float()
    light = {"diffuse": 0.3 + 0.2 * torch.sin(0.2 * x), "specular": 0.1 + 0.05 * torch.cos(0.1 * y)}
    layers = {"albedo": seen * albedo, "albedoSpecular": seen * torch.full((3, rows, columns), 0.5)}
    for signal, clean in light.items():
        clean = seen * clean.expand(3, -1, -1)
        deviation = torch.where(seen > 0, torch.full((1, rows, columns), 0.03), -torch.ones(1, rows, columns))
        layers[signal] = torch.cat([clean * (1 + noise(scale=0.2)), deviation])
        layers[signal + ".first"] = torch.cat([clean * (1 + noise(scale=0.1)), deviation])
        layers[signal + ".svgf"] = torch.cat([0.8 * clean, deviation])
        layers[signal + ".past"] = 0.8 * clean
        layers[signal + ".frames"] = seen[None] * 3
        light[signal] = clean
    clean = layers["albedo"] * light["diffuse"] + layers["albedoSpecular"] * light["specular"]
    layers["svgf"] = torch.cat([0.8 * clean, torch.ones(1, rows, columns)])
    layers["emission"] = torch.zeros(3, rows, columns)
    layers["normal"] = -seen * CAMERA[2][:, None, None]
    layers["depth"] = seen[None] * (2 + 0.01 * x + 0.1 * y)
    layers["roughness"] = seen[None] * 0.5
    layers["motion"] = torch.where(seen[None] > 0, torch.tensor([0.5, -1.0])[:, None, None], torch.tensor(65504.0))
    layers["reference"], layers["reference2"] = clean + noise(scale=0.02), clean + noise(scale=0.02)
    return layers


def make_clips(folder, files=2, rows=40, columns=36, numbers=(1, 10), sequence=True):
    """Writes a data set in the format of `limpid dataset --sequence`, one clip to a file."""
    os.makedirs(folder)
    generator = torch.Generator().manual_seed(6)
    listed = []
    for file in range(files):
        clip, tensors = f"{file:06}", {}
        for number in numbers:
            for name, image in make_frame(rows, columns, generator).items():
                assert len(image) == STORED.get(name, clips.LAYERS[name]), name
                tensors[f"{clip}/{number}/{name}"] = image.half().contiguous()
            tensors[f"{clip}/{number}/camera"] = CAMERA
        name = f"examples.{file:05}.safetensors"
        tensor_file.write(os.path.join(folder, name), tensors)
        listed.append({"name": name, "examples": [{"name": clip, "scene": "builtin:room-" + clip}]})
    dataset = {"seed": 0, **({"sequence": list(numbers)} if sequence else {})}
    with open(os.path.join(folder, "manifest.json"), "w") as stream:
        json.dump({"dataset": dataset, "files": listed}, stream)
    return folder


def make_batch(rows=32, columns=32, count=2, seed=3):
    """Returns the channels (batch, clips.CHANNELS, rows, columns) of some frames, as floats."""
    generator = torch.Generator().manual_seed(seed)
    frames = [make_frame(rows, columns, generator) for _ in range(count)]
    return torch.stack([torch.cat([frame[name][:channels] for name, channels in clips.LAYERS.items()])
                        for frame in frames])
