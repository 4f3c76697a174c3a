"""What the network sees of a pixel: COUNT numbers of a clips.Frame. The shader
src/denoise/methods/nano/shaders/nano_features.comp computes the same."""

import torch
from torch.nn import functional

#: 14 of light, 4 of albedo, 3 of the normal, 3 of distance and roughness.
COUNT = 24

LUMINANCE = (0.2126, 0.7152, 0.0722)

#: Added to luminances and distances before their logarithm is taken, which is then finite: darker light looks black.
DARKEST = 0.01

#: Added to a luminance before differences are divided by it.
SOFTENING = 0.02


def luminance(colour, dim=1):
    """Returns the luminance of colours, whose components lie along `dim`; its size is 1 then."""
    shape = [1] * colour.dim()
    shape[dim] = 3
    return (colour * torch.tensor(LUMINANCE).to(colour).view(shape)).sum(dim, keepdim=True)


def logarithm(light):
    return torch.log2(light + DARKEST) * 0.2


def bend(distance):
    """Returns how far each pixel is from the mean of its four neighbours, which shows edges and curved surfaces. Beyond
    the picture's edges lie the pixels at its edges."""
    around = functional.pad(distance, (1, 1, 1, 1), mode="replicate")
    left, right = around[:, :, 1:-1, :-2], around[:, :, 1:-1, 2:]
    above, below = around[:, :, :-2, 1:-1], around[:, :, 2:, 1:-1]
    return (4 * distance - left - right - above - below).clamp(-1, 1)


def of_frame(frame):
    """Returns (batch, COUNT, rows, columns). Each line of light has one number for each signal."""

    def seen(light):
        return luminance(light, 2)[:, :, 0]

    distance = torch.log2(frame.depth + DARKEST)
    accumulated, filtered = seen(frame.accumulated), seen(frame.filtered)
    relative = frame.deviation[:, :, 0] / (filtered + SOFTENING)
    return torch.cat([
        logarithm(accumulated),
        logarithm(filtered),
        logarithm(seen(frame.first)),
        logarithm(seen(frame.past)),
        ((accumulated - filtered) / (filtered + SOFTENING)).clamp(-2, 2),
        relative.clamp(max=4) * 0.5,
        1 / frame.frames.clamp(min=1),
        frame.albedo[:, 0].clamp(0, 1),
        luminance(frame.albedo[:, 1]).clamp(0, 1),
        frame.normal,
        distance * 0.25,
        bend(distance) * 4,
        frame.roughness,
    ], 1)
