"""What training minimises, and how errors are measured although references are noisy.

Errors are squares of differences times weights. The weights are the slope of sRGB at the picture's brightness, so that
the differences are about those of pixels on a screen: sRGB, linearised. Nothing but a square allows noisy references:

- Minimising. The reference is R = T + n, with the true picture T and noise n of mean 0 that is independent of the
  picture x. The mean of (x - R)^2 is that of (x - T)^2 plus the variance of n. No network can change that variance, so
  the gradient is on average that of a reference without noise. The mean of |x - R|, or of a square of sRGB itself, has
  another minimum: the median, or the mean of a curve.
- Measuring. There the variance matters: beside it, the errors of good pictures vanish. With two references A and B
  whose noise a and b is independent, the mean of (x - A)(x - B) is that of (x - T)^2 - (x - T)(a + b) + a b. The last
  two have the mean 0. So the product is an unbiased estimate of (x - T)^2. A single one can be negative.

The loss of a change is such a square, too: of the error's change from a frame to the next one. Both references' noise
only adds to it.

For all, the weights must not depend on the references' noise. They are computed from SVGF's picture."""

import torch
from torch.nn import functional

from . import features, warp

#: Differences of about a third of the range from black to white, and larger ones, count by their absolute value:
#: fireflies of the references would otherwise decide the gradient.
LARGEST_SQUARE = 0.3

#: Added to the squared error by which a frame's loss is divided: frames without an error would otherwise decide. About
#: that error at 16 samples, which is a tenth of that at one. A larger number than most errors would make frames of many
#: samples count little; those of 64 count less already.
LEAST_ERROR = 3e-5

#: Of losses. It matters only to train.LARGEST_GRADIENT and to Adam's epsilon: Adam divides by the gradient's size.
SCALE = 2e-3

#: Where the slope stops growing; below it, sRGB is a line.
DARKEST = 0.004

#: A single estimate of a frame's error counts as no more than this when errors are summed.
MOST_ERROR = 1000


def srgb(light):
    light = light.clamp(0, 1)
    return torch.where(light < 0.0031308, 12.92 * light, 1.055 * light.clamp(min=1e-4) ** (1 / 2.4) - 0.055)


def slope(light):
    """Returns the derivative of sRGB. Light above 1 is white on a screen. It keeps a weight, which falls by the square
    of the light, so that relative errors count less the brighter it is."""
    derivative = 0.4396 * light.clamp(DARKEST, 1) ** (-0.5833)
    return torch.where(light > 1, derivative / light.clamp(min=1) ** 2, derivative)


def blurred(image, radius=1):
    return functional.avg_pool2d(functional.pad(image, (radius,) * 4, mode="replicate"), 2 * radius + 1, 1)


def squared_brightness(frame):
    """Returns what squared differences are divided by to be relative, much like relMSE (docs/metrics.md)."""
    return blurred(features.luminance(frame.svgf), 2) ** 2 + 0.01


def weights_of(frame, relative=0.0):
    """Returns the weights of differences from a clips.Frame's references. `relative`: weight of relative differences
    beside those of sRGB. SVGF's picture is blurred, because the weights of its own errors would otherwise favour one
    sign."""
    weights = slope(blurred(frame.svgf).clamp(min=0))
    return (weights**2 + relative**2 / squared_brightness(frame)).sqrt() if relative else weights


def product(picture, references, weights):
    """Returns an unbiased estimate of the squared weighted error of each number."""
    first, second = references
    return (picture - first) * (picture - second) * weights * weights


class Judge:
    """Compares pictures of a batch with its references. All frames count alike, whether SVGF's error in them is large
    or small: differences of means over 5x5 pixels, where little of the references' noise is left, tell how large."""

    def __init__(self, frame, relative=0.0):
        self.references, self.motion, self.frames = frame.references, frame.motion, frame.frames
        self.weights = weights_of(frame, relative)
        self.mean = 0.5 * (self.references[0] + self.references[1])
        off = blurred((frame.svgf - self.mean) * self.weights, 2)
        self.scale = 1 / ((off * off).mean((1, 2, 3), keepdim=True) + LEAST_ERROR)

    def loss(self, picture):
        difference = functional.huber_loss(picture * self.weights, self.mean * self.weights, delta=LARGEST_SQUARE,
                                           reduction="none")
        return (difference * SCALE * self.scale).mean()

    def change(self, picture):
        """Returns the loss of the errors' change from frame to frame: the first half of the batch are the frames
        before those of the second half. Surfaces are followed; those that have just appeared do not count."""
        before, after = (picture - self.mean).chunk(2)
        before, valid = warp.carried(before, self.motion.chunk(2)[1])
        valid = valid & (self.frames.chunk(2)[1].amin(1, keepdim=True) > 1)
        weights, scale = self.weights.chunk(2)[1], self.scale.chunk(2)[1]
        difference = torch.where(valid, (after - before) * weights, 0 * after)
        return (functional.huber_loss(difference, 0 * difference, delta=LARGEST_SQUARE, reduction="none") * SCALE *
                scale).mean()

    def error(self, picture):
        """Returns an unbiased estimate of the error, but for outliers."""
        error = product(picture, self.references, self.weights) * self.scale
        return error.clamp(-MOST_ERROR, MOST_ERROR).mean()
