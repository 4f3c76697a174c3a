"""Reads the training data that `limpid dataset` renders, and cuts patches from it. Format: docs/kpcn.md, "Data"."""

import json
import os

import torch
from torch.nn import functional

from . import features, tensor_file

LAYERS = ("diffuse", "specular", "albedo", "normal", "depth")


class Dataset:
    """The examples of a data set. Each is a dict of tensors (1, channels, rows, columns): the layers, their variances
    ("diffuse.variance" and so on), and the targets "reference.diffuse" and "reference.specular".

    Files are mapped on first use, so that all workers of a machine share one copy. A GPU keeps examples in half
    precision while they take less than half of its free memory."""

    def __init__(self, folder, samples, device="cpu"):
        with open(os.path.join(folder, "manifest.json")) as stream:
            self.manifest = json.load(stream)
        if "sequence" in self.manifest["dataset"]:
            raise ValueError(f"{folder} has clips (limpid dataset --sequence), no stills")
        if samples not in self.manifest["dataset"]["samples"]:
            there = self.manifest["dataset"]["samples"]
            raise ValueError(f"{folder} has pictures of {there} samples, none of {samples}")
        self.folder, self.device = folder, torch.device(device)
        self.examples = [
            (file["name"], example["name"], example["scene"])
            for file in self.manifest["files"]
            for example in file["examples"]
        ]
        self.names = {f"{samples}/{layer}{kind}": layer + kind for layer in LAYERS for kind in ("", ".variance")}
        self.names |= {"reference/" + side: "reference." + side for side in features.SIDES}
        self.files, self.kept = {}, {}
        self.room = torch.cuda.mem_get_info(self.device)[0] // 2 if self.device.type == "cuda" else 0

    def __len__(self):
        return len(self.examples)

    def on_device(self, file, name):
        if name in self.kept:
            return self.kept[name]
        if file not in self.files:
            self.files[file] = tensor_file.read(os.path.join(self.folder, file))[0]
        tensors = {
            known: self.files[file][f"{name}/{stored}"].unsqueeze(0).to(self.device)
            for stored, known in self.names.items()
        }
        size = sum(tensor.numel() * tensor.element_size() for tensor in tensors.values())
        if size <= self.room:
            self.room -= size
            self.kept[name] = tensors
        return tensors

    def __getitem__(self, index):
        file, name, _ = self.examples[index]
        return {known: tensor.float() for known, tensor in self.on_device(file, name).items()}


def importance(frame):
    """Returns a sampling weight per pixel, (rows, columns), by which patches() chooses the centres of patches.

    The weight is large where the network has most to learn: at noise, shadows and edges. It is the relative standard
    deviation of the luminance plus the standard deviation of the normals, both over 11x11 pixels (Bako et al. 2017,
    section 6)."""

    def mean(image):
        return functional.avg_pool2d(image, 11, stride=1, padding=5, count_include_pad=False)

    light = features.luminance(frame["diffuse"] + frame["specular"])
    average = mean(light)
    spread = (mean(light**2) - average**2).clamp(min=0).sqrt() / (average + 1e-3)
    normal = (mean(frame["normal"] ** 2) - mean(frame["normal"]) ** 2).clamp(min=0).sum(dim=1, keepdim=True).sqrt()
    return (spread.clamp(max=4.0) / 4.0 + normal + 0.05)[0, 0]


def varied(frame, generator):
    """Data augmentation: mirrors and transposes the frame, permutes its color channels and scales its light, at
    random.

    The result is still a valid frame. Only the variances are slightly off: they are of the luminance, which changes
    when color channels are permuted."""
    draws = torch.rand(4, generator=generator).tolist()
    flips = [dim for dim, draw in ((2, draws[0]), (3, draws[1])) if draw < 0.5]
    colors = torch.randperm(3, generator=generator).tolist()
    brightness = 2.0 ** (2.0 * draws[2] - 1.0)
    result = {}
    for name, image in frame.items():
        image = image.flip(flips)
        if draws[3] < 0.5:
            image = image.transpose(2, 3)
        if name.split(".")[-1] in ("diffuse", "specular"):
            image = image * brightness
        elif name in ("diffuse.variance", "specular.variance"):
            image = image * brightness**2
        if image.shape[1] == 3 and name != "normal":
            image = image[:, colors]
        result[name] = image
    return result


def patches(prepared, frame, size, count, generator):
    """Yields `count` random patches of Kpcn.prepare(frame), with centres drawn by importance(). They have `size` x
    `size` pixels, or fewer if the picture is smaller."""
    rows, columns = frame["depth"].shape[2:]
    height, width = min(size, rows), min(size, columns)
    centres = importance(frame).cpu()[height // 2 : rows - (height - 1) // 2, width // 2 : columns - (width - 1) // 2]
    chosen = torch.multinomial(centres.flatten(), count, replacement=True, generator=generator)
    for place in chosen.tolist():
        top, left = divmod(place, centres.shape[1])
        yield {name: image[:, :, top : top + height, left : left + width] for name, image in prepared.items()}


def batch_of(items):
    """Stacks patches along the batch dimension."""
    return {name: torch.cat([item[name] for item in items]) for name in items[0]}


def shuffled(items, order):
    return [items[i] for i in order.tolist()]
