"""What the networks see of a frame, and how their light is transformed: Bako et al., "Kernel-Predicting Convolutional
Networks for Denoising Monte Carlo Renderings", SIGGRAPH 2017, section 5. src/denoise/kpcn does the same. One thing is not the paper's: the
network sees the logarithm of diffuse light too (and averages the light itself). What it sees is bounded then, so that halves hold it.

A frame is a dict of float32 tensors (batch, channels, rows, columns): diffuse, specular, albedo, normal (3 channels) and depth
(1; 0: nothing is seen), and of each the variance of the mean, of its luminance or of its only or all components,
as "diffuse.variance" (1 channel) and so on."""

import torch

#: Prevents dark albedo from amplifying the little light it reflects.
EPSILON = 0.00316

#: radiance, albedo, normal: 3 + 2 x 3 + 1 each; depth: 1 + 2 + 1.
INPUT_CHANNELS = 34

#: The channels that a network sees. "gradients": light, its gradients and its variance, and only the gradients of
#: albedo, normal and depth.
INPUTS = {"all": range(INPUT_CHANNELS), "gradients": (*range(10), *range(13, 19), *range(23, 29), 31, 32)}

SIDES = ("diffuse", "specular")


def gradients(image):
    """Differences from the pixel to the left and from the one above; 0 in the first column and row."""
    across = torch.zeros_like(image)
    down = torch.zeros_like(image)
    across[..., :, 1:] = image[..., :, 1:] - image[..., :, :-1]
    down[..., 1:, :] = image[..., 1:, :] - image[..., :-1, :]
    return torch.cat([across, down], dim=1)


def luminance(color):
    red, green, blue = color.unbind(dim=1)
    return (0.2126 * red + 0.7152 * green + 0.0722 * blue).unsqueeze(1)


def to_network(side, light, albedo):
    """Diffuse light without its albedo; specular light as a logarithm."""
    return light / (albedo + EPSILON) if side == "diffuse" else torch.log1p(light.clamp(min=0.0))


def from_network(side, light, albedo):
    """The inverse."""
    return light * (albedo + EPSILON) if side == "diffuse" else torch.expm1(light)


def recombined(sides, albedo):
    """The picture without emission, from both sides as the network has them."""
    return sum(from_network(side, light, albedo) for side, light in sides.items())


def seen(side, frame):
    """The light as the network sees it, and its variance to first order: the variance times the squared slope."""
    light, variance = frame[side].clamp(min=0.0), frame[side + ".variance"]
    if side == "diffuse":
        light = light / (frame["albedo"] + EPSILON)
        variance = variance / (luminance(frame["albedo"]) + EPSILON) ** 2
    return torch.log1p(light), variance / (1.0 + luminance(light)) ** 2


def faces(normal):
    """Normals of length 1, and 1 where there is none: 4 channels. The dot product of two is the cosine between the normals, 1 if
    neither has one, and 0 if one of them has."""
    length = normal.square().sum(dim=1, keepdim=True).sqrt()
    unit = torch.where(length > 0, normal / length.clamp(min=1e-30), torch.zeros_like(normal))
    return torch.cat([unit, (length == 0).to(normal.dtype)], dim=1)


def depth_scale(frame):
    """One over the frame's largest distance; 1 if nothing is seen."""
    largest = frame["depth"].amax(dim=(1, 2, 3), keepdim=True)
    return torch.where(largest > 0, 1.0 / largest.clamp(min=1e-30), torch.ones_like(largest))


def inputs(side, frame):
    """The 34 channels for `side`, "diffuse" or "specular"."""
    scale = depth_scale(frame)
    parts = []
    for image, variance in (
        seen(side, frame),
        (frame["albedo"], frame["albedo.variance"]),
        (frame["normal"], frame["normal.variance"]),
        (frame["depth"] * scale, frame["depth.variance"] * scale**2),
    ):
        parts += [image, gradients(image), variance]
    return torch.cat(parts, dim=1)


def prepare(frame):
    """What the network takes: of each side "SIDE.input" and "SIDE.light"; "albedo"; "faces". Where the frame has "reference.SIDE",
    also "SIDE.target", the same transform of it, and "target", the picture without emission. Of a whole frame: patches are
    cut afterwards, or their gradients would end at their edges."""
    prepared = {"albedo": frame["albedo"], "faces": faces(frame["normal"])}
    for side in SIDES:
        prepared[side + ".input"] = inputs(side, frame)
        prepared[side + ".light"] = to_network(side, frame[side], frame["albedo"])
        if "reference." + side in frame:
            prepared[side + ".target"] = to_network(side, frame["reference." + side], frame["albedo"])
    if "reference.diffuse" in frame:
        prepared["target"] = frame["reference.diffuse"] + frame["reference.specular"]
    return prepared
