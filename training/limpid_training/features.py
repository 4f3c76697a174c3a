"""Computes the networks' input from a frame, and the transform of light between radiance and network space: Bako et
al., "Kernel-Predicting Convolutional Networks for Denoising Monte Carlo Renderings", SIGGRAPH 2017, section 5. The
shader src/denoise/kpcn/shaders/kpcn_features.comp does the same.

One thing differs from the paper by default: the network's input is the logarithm of diffuse light, too, so that it is
bounded. The kernels still average diffuse light itself. With `diffuse_input` "linear", the network's input is diffuse
light itself, as in the paper.

A frame is a dict of float32 tensors (batch, channels, rows, columns): "diffuse", "specular", "albedo" and "normal" (3
channels), and "depth" (1 channel, 0 where the ray hit nothing). Each comes with the variance of its mean in one
channel, "diffuse.variance" and so on: of the luminance for colors, the mean over the components for normals."""

import torch

#: Added to albedo before light is divided by it, so that dark albedo does not amplify noise.
EPSILON = 0.00316

#: Radiance, albedo and normal have 10 channels each: 3, their gradients 2 x 3, variance 1. Depth has 4: 1 + 2 + 1.
INPUT_CHANNELS = 34

#: Which of the 34 channels a network uses. "gradients": light with its gradients and variance, but only the gradients
#: of albedo, normal and depth.
INPUTS = {"all": range(INPUT_CHANNELS), "gradients": (*range(10), *range(13, 19), *range(23, 29), 31, 32)}

SIDES = ("diffuse", "specular")

#: What the network for diffuse light sees: log(1 + light), or the light itself.
DIFFUSE_INPUTS = ("logarithmic", "linear")

#: The largest number in half precision. Inputs are stored so.
MAX_HALF = 65504.0


def gradients(image):
    """Returns the differences to the left neighbour, then those to the upper one; 0 in the first column and row."""
    across = torch.zeros_like(image)
    down = torch.zeros_like(image)
    across[..., :, 1:] = image[..., :, 1:] - image[..., :, :-1]
    down[..., 1:, :] = image[..., 1:, :] - image[..., :-1, :]
    return torch.cat([across, down], dim=1)


def luminance(color):
    red, green, blue = color.unbind(dim=1)
    return (0.2126 * red + 0.7152 * green + 0.0722 * blue).unsqueeze(1)


def to_network(side, light, albedo):
    """Transforms light to network space: diffuse light is divided by albedo, specular light becomes log(1 + x)."""
    return light / (albedo + EPSILON) if side == "diffuse" else torch.log1p(light.clamp(min=0.0))


def from_network(side, light, albedo):
    """Transforms light from network space back to radiance: the inverse of to_network()."""
    return light * (albedo + EPSILON) if side == "diffuse" else torch.expm1(light)


def recombined(sides, albedo):
    """Returns the picture without emission. `sides` maps "diffuse" and "specular" to their light in network space."""
    return sum(from_network(side, light, albedo) for side, light in sides.items())


def seen(side, frame, diffuse_input="logarithmic"):
    """Returns the light as the network's input has it, and the variance of that: to first order, the light's variance
    times the squared derivative of the transform. `diffuse_input` is one of DIFFUSE_INPUTS."""
    light, variance = frame[side].clamp(min=0.0), frame[side + ".variance"]
    if side == "diffuse":
        light = light / (frame["albedo"] + EPSILON)
        variance = variance / (luminance(frame["albedo"]) + EPSILON) ** 2
        if diffuse_input == "linear":
            return light.clamp(max=MAX_HALF), variance.clamp(max=MAX_HALF)
    return torch.log1p(light), variance / (1.0 + luminance(light)) ** 2


def faces(normal):
    """Returns 4 channels: the unit normal, and a flag that is 1 where there is no normal.

    The dot product of two such vectors is the cosine between the normals, 1 if neither pixel has a normal, and 0 if
    only one has."""
    length = normal.square().sum(dim=1, keepdim=True).sqrt()
    unit = torch.where(length > 0, normal / length.clamp(min=1e-30), torch.zeros_like(normal))
    return torch.cat([unit, (length == 0).to(normal.dtype)], dim=1)


def depth_scale(frame):
    """Returns 1 / the frame's largest distance; 1 if no ray hit anything."""
    largest = frame["depth"].amax(dim=(1, 2, 3), keepdim=True)
    return torch.where(largest > 0, 1.0 / largest.clamp(min=1e-30), torch.ones_like(largest))


def inputs(side, frame, diffuse_input="logarithmic"):
    """Returns the 34 input channels for `side`, "diffuse" or "specular". `diffuse_input` is as for seen()."""
    scale = depth_scale(frame)
    parts = []
    for image, variance in (
        seen(side, frame, diffuse_input),
        (frame["albedo"], frame["albedo.variance"]),
        (frame["normal"], frame["normal.variance"]),
        (frame["depth"] * scale, frame["depth.variance"] * scale**2),
    ):
        parts += [image, gradients(image), variance]
    return torch.cat(parts, dim=1)


def prepare(frame, diffuse_input="logarithmic"):
    """Returns what Kpcn needs: for each side "SIDE.input" and "SIDE.light" (the light that its kernels average), and
    "albedo" and "faces" for both. If the frame has "reference.SIDE", also "SIDE.target", the reference in network
    space, and "target", the reference picture without emission. `diffuse_input` is as for seen().

    Call this with whole frames and cut patches from the result: at the edges of a patch, gradients would be 0."""
    prepared = {"albedo": frame["albedo"], "faces": faces(frame["normal"])}
    for side in SIDES:
        prepared[side + ".input"] = inputs(side, frame, diffuse_input)
        prepared[side + ".light"] = to_network(side, frame[side], frame["albedo"])
        if "reference." + side in frame:
            prepared[side + ".target"] = to_network(side, frame["reference." + side], frame["albedo"])
    if "reference.diffuse" in frame:
        prepared["target"] = frame["reference.diffuse"] + frame["reference.specular"]
    return prepared
