"""Reads the clips that `limpid dataset --sequence` renders, and cuts varied crops from their frames.

apps/lab/dataset/dataset_clip.h describes the files."""

import collections
import json
import os
from concurrent.futures import ThreadPoolExecutor

import torch

from .. import tensor_file

SIGNALS = ("diffuse", "specular")

#: The tensors of a frame, and how many of their channels are used, from the first one on.
LAYERS = {
    "diffuse": 4, "specular": 4, "diffuse.first": 3, "specular.first": 3, "diffuse.svgf": 3, "specular.svgf": 3,
    "diffuse.past": 3, "specular.past": 3, "diffuse.frames": 1, "specular.frames": 1, "albedo": 3,
    "albedoSpecular": 3, "emission": 3, "normal": 3, "depth": 1, "roughness": 1, "motion": 2, "svgf": 3,
    "reference": 3, "reference2": 3}

#: The layers that grow with the brightness of the scene's lights.
LIGHT = [name for name in LAYERS if name.split(".")[0] in SIGNALS and not name.endswith("frames")]
LIGHT += ["emission", "svgf", "reference", "reference2"]

#: Each layer's channels among all channels of a frame.
PLACES = {}
for _name, _count in LAYERS.items():
    _first = max((place.stop for place in PLACES.values()), default=0)
    PLACES[_name] = slice(_first, _first + _count)
CHANNELS = sum(LAYERS.values())

#: Light is divided by albedo of at least this much (docs/denoising.md), and so multiplied by no less.
LEAST_ALBEDO = 0.01

#: Longer motion than this, in pixels, is none.
MOST_MOTION = 1000

#: A frame in memory. `channels`: halves (CHANNELS, rows, columns).
Stored = collections.namedtuple("Stored", ("clip", "number", "channels"))


def in_view(normal, camera):
    """Turns normals (3, rows, columns) of the world into those that the camera sees: right, up, and towards it. Only
    so can pictures be mirrored and turned. `camera`: the vectors right, up and forward, and the origin."""
    axes = torch.stack([axis / axis.norm() for axis in (camera[0], camera[1], -camera[2])])
    return torch.einsum("ij,jhw->ihw", axes, normal.float()).half()


def read(path):
    """Returns the frames of a file, clip by clip."""
    tensors, _ = tensor_file.read(path)
    frames = []
    for clip, number in sorted({(name.split("/")[0], int(name.split("/")[1])) for name in tensors}):
        of_frame = f"{clip}/{number}/"
        missing = [name for name in LAYERS if of_frame + name not in tensors]
        if missing:
            raise ValueError(f"{path}: has no '{of_frame + missing[0]}'; make the clips with this version of Limpid")
        parts = {name: tensors[of_frame + name][:count] for name, count in LAYERS.items()}
        parts["normal"] = in_view(parts["normal"], tensors[of_frame + "camera"])
        frames.append(Stored(clip, number, torch.cat(list(parts.values()))))
    return frames


def manifest_of(folder):
    """Returns what `limpid dataset` has written about its files. Raises ValueError if these are no clips."""
    with open(os.path.join(folder, "manifest.json")) as stream:
        manifest = json.load(stream)
    if "sequence" not in manifest["dataset"]:
        raise ValueError(f"{folder} has stills; make clips with limpid dataset --sequence")
    return manifest


def load(folder, device="cpu", number=0, count=1):
    """Returns all frames of a data set; of `count` workers, those of the files of worker `number`.

    They all stay in the device's memory: as halves, a frame of 256x256 pixels takes 7 MB."""
    names = [file["name"] for file in manifest_of(folder)["files"]]
    if len(names) < count:
        raise ValueError(f"{folder}: {count} processes cannot share {len(names)} files; --per-file 1 makes more")
    paths = [os.path.join(folder, name) for name in names[number::count]]
    with ThreadPoolExecutor() as pool:
        return [frame._replace(channels=frame.channels.to(device)) for part in pool.map(read, paths) for frame in part]


def smallest_edge(frames):
    return min(min(frame.channels.shape[1:]) for frame in frames)


def pairs_of(frames):
    """Returns a list of each frame of a folder whose next one is stored, too, and that next one. They are in the order
    of load(). Clips of different folders have the same names, so each folder has its own pairs."""
    return [(frame, after) for frame, after in zip(frames, frames[1:])
            if frame.clip == after.clip and frame.number + 1 == after.number]


def crops(groups, count, edge, generator):
    """Returns (frames of a group, count, CHANNELS, edge, edge): of randomly chosen groups of frames squares that are
    in the same place. They begin at even rows and columns, as the 2x2 pixels do that the network's next level
    joins."""
    chosen = []
    for _ in range(count):
        group = groups[int(torch.randint(len(groups), (1,), generator=generator))]
        top, left = (2 * int(torch.randint((size - edge) // 2 + 1, (1,), generator=generator))
                     for size in group[0].channels.shape[1:])
        chosen.append(torch.stack([frame.channels[:, top : top + edge, left : left + edge] for frame in group]))
    return torch.stack(chosen, 1)


def varied(channels, generator):
    """Data augmentation: mirrors and transposes a batch (frames of a group, batch, CHANNELS, rows, columns), permutes
    its colours, all of it in the same way, and scales the light of each group by its own factor from 1/4 to 4.
    Returns floats (frames of a group * batch, CHANNELS, rows, columns).

    The result is still a valid batch. Only the deviations of light are slightly off: they are of the luminance, which
    changes when colours are permuted."""
    draws = torch.rand(3, generator=generator).tolist()
    colours = torch.randperm(3, generator=generator).tolist()
    frames, count = channels.shape[:2]
    brightness = torch.exp2(4 * torch.rand(count, 1, 1, 1, generator=generator) - 2).to(channels.device)
    brightness = brightness.repeat(frames, 1, 1, 1)
    channels = channels.flatten(0, 1)
    sources, signs = list(range(CHANNELS)), torch.ones(CHANNELS, device=channels.device)
    for name in LIGHT + ["albedo", "albedoSpecular"]:
        first = PLACES[name].start
        sources[first : first + 3] = [first + colour for colour in colours]
    right, up = PLACES["normal"].start, PLACES["normal"].start + 1
    x, y = PLACES["motion"].start, PLACES["motion"].start + 1
    if draws[0] < 0.5:
        channels = channels.flip(3)
        signs[[right, x]] *= -1
    if draws[1] < 0.5:
        channels = channels.flip(2)
        signs[[up, y]] *= -1
    if draws[2] < 0.5:
        # What pointed down then points to the right, and what pointed to the right points down: minus up.
        channels = channels.transpose(2, 3)
        sources[right], sources[up] = up, right
        signs[right], signs[up] = -signs[up].item(), -signs[right].item()
        sources[x], sources[y] = y, x
        signs[x], signs[y] = signs[y].item(), signs[x].item()
    light = torch.zeros(CHANNELS, device=channels.device)
    for name in LIGHT:
        light[PLACES[name]] = 1
    scale = signs.view(1, -1, 1, 1) * (1 + (brightness - 1) * light.view(1, -1, 1, 1))
    return channels[:, sources].float() * scale


class Frame:
    """A batch of frames (batch, CHANNELS, rows, columns), layer by layer, as floats. What both signals have is in
    tensors (batch, signals, channels, rows, columns)."""

    def __init__(self, channels):
        channels = channels.float()

        def layer(name):
            return channels[:, PLACES[name]]

        def both(ending="", part=slice(0, 3)):
            return torch.stack([layer(signal + ending)[:, part] for signal in SIGNALS], 1)

        #: Light without albedo: SVGF's mean over time, that after its first level, its result, and the frame before's.
        self.accumulated = both().clamp(min=0)
        self.first = both(".first").clamp(min=0)
        self.filtered = both(".svgf").clamp(min=0)
        self.past = both(".past").clamp(min=0)
        #: The expected deviation of the accumulated light's luminance.
        self.deviation = both("", slice(3, 4)).clamp(min=0)
        #: The number of frames in the mean: (batch, signals, rows, columns).
        self.frames = torch.cat([layer(signal + ".frames") for signal in SIGNALS], 1)
        self.albedo = torch.stack([layer("albedo"), layer("albedoSpecular")], 1)
        self.emission, self.normal, self.roughness = layer("emission"), layer("normal"), layer("roughness")
        self.depth = layer("depth")
        #: The position in the frame before, minus this one: columns and rows; above MOST_MOTION if there is none.
        self.motion = layer("motion")
        #: 1 where a surface is seen, else 0.
        self.seen = (self.depth > 0).float()
        self.picture = layer("svgf")
        #: SVGF's picture. That of the clip is the same, unless another method filtered the clip.
        self.svgf = self.compose(self.filtered)
        #: Clean pictures whose noise is independent.
        self.references = (layer("reference"), layer("reference2"))

    def compose(self, light):
        """Returns the picture (batch, 3, rows, columns) with this light of both signals."""
        picture = (light * self.albedo.clamp(min=LEAST_ALBEDO)).sum(1) + self.emission
        return torch.where(self.seen > 0, picture, self.picture)
