"""The networks of `nano` and `film`, and the filter whose weights they predict. src/denoise/methods/nano computes the
same.

The network works on several levels: the picture, and pictures of half, a quarter ... of its size. At each level it
predicts how a pixel's light is averaged from the pixels around and from the filtered coarser level, and at the finest
level also what share of SVGF's result to replace by that."""

import collections
import contextlib

import torch
from torch import nn
from torch.nn import functional

from . import clips, features

SIGNALS = len(clips.SIGNALS)

#: The pixels of the coarser level that are nearest to a pixel.
COARSE_TAPS = 4

#: What an activation keeps of negative numbers.
LEAK = 0.1

#: Weights in the means of the next coarser level are between e^-10 and e^10, which half precision can hold.
LARGEST_POOL_LOGIT = 10

#: Logits that are smaller than a pixel's largest one by more than this count as so much smaller: e^-60 is not 0 in
#: single precision, which matters where only such taps see anything.
LEAST_LOGIT = -60

#: Standard deviation of the last layers' weights at the beginning: all pixels around then count almost alike.
FIRST_SPREAD = 0.02

#: The logit of SVGF's result at the beginning, where the filter's own is about 0: SVGF's share is e / (1 + e) = 0.73.
FIRST_SVGF = 1.0

#: Level by level, from the finest on: channels, convolutions of 3x3 on the way down, width of the kernels in pixels.
Shape = collections.namedtuple("Shape", ("widths", "depths", "kernels"))

#: The networks that Limpid computes.
SHAPES = {
    "nano": Shape((16, 32, 48, 64, 64), (0, 1, 2, 2, 2), (5, 3, 3, 3, 3)),
    "film": Shape((48, 96, 128, 128, 128), (1, 2, 2, 2, 2), (5, 3, 3, 3, 3)),
}

#: What apply() computes: light (batch, signals, 3, rows, columns) mixed from SVGF's and its own, its own light, and
#: the share of that (batch, signals, 1, rows, columns).
Filtered = collections.namedtuple("Filtered", ("light", "own", "share"))


def convolution(inputs, outputs, width):
    return nn.Conv2d(inputs, outputs, width, padding=width // 2)


class Net(nn.Module):
    """Predicts logits: maps features (batch, features.COUNT, rows, columns) to one tensor (batch, outputs, rows,
    columns) for each level. Rows and columns are multiples of `multiple`. Checkpoints have the names of the layers.

    The outputs are those of the first signal, then those of the second. A signal's logits are, in this order: one for
    each pixel of the kernel, row by row; at all but the coarsest level COARSE_TAPS for the coarser level's pixels; at
    the finest level one for the filter's own result, and one for SVGF's; at all but the coarsest level the logarithm of
    the pixel's weight in the mean that becomes the coarser level's light."""

    def __init__(self, shape=SHAPES["nano"]):
        super().__init__()
        self.shape = shape
        widths = shape.widths
        last = len(widths) - 1
        self.inp = convolution(features.COUNT, widths[0], 1)
        self.enc = nn.ModuleList([nn.ModuleList([convolution(width, width, 3) for _ in range(depth)])
                                  for width, depth in zip(widths, shape.depths)])
        self.down = nn.ModuleList([nn.Conv2d(widths[i], widths[i + 1], 2, stride=2) for i in range(last)])
        self.mix = nn.ModuleList([convolution(widths[i] + widths[i + 1], widths[i], 1) for i in range(last)])
        self.dec = nn.ModuleList([convolution(widths[i], widths[i], 3) for i in range(last)])
        self.heads = nn.ModuleList([self.head(level) for level in range(last + 1)])

    def head(self, level):
        head = convolution(self.shape.widths[level], SIGNALS * self.logits(level), 1)
        nn.init.zeros_(head.bias)
        nn.init.normal_(head.weight, std=FIRST_SPREAD)
        if level == 0:
            with torch.no_grad():
                head.bias.view(SIGNALS, -1)[:, self.kernel_logits(0) + 1] = FIRST_SVGF
        return head

    @property
    def multiple(self):
        return 2 ** (len(self.shape.widths) - 1)

    def kernel_logits(self, level):
        """The number of a signal's logits that are of the kernel and of the coarser level's pixels."""
        return self.shape.kernels[level] ** 2 + (COARSE_TAPS if level + 1 < len(self.shape.widths) else 0)

    def logits(self, level):
        """The number of a signal's logits."""
        return self.kernel_logits(level) + (2 if level == 0 else 0) + (1 if level + 1 < len(self.shape.widths) else 0)

    def forward(self, x):
        def activated(x):
            return functional.leaky_relu(x, LEAK)

        x = activated(self.inp(x))
        levels = []
        for level, layers in enumerate(self.enc):
            if level > 0:
                x = activated(self.down[level - 1](x))
            for layer in layers:
                x = activated(layer(x))
            levels.append(x)
        for level in reversed(range(len(self.mix))):
            coarser = functional.interpolate(levels[level + 1], scale_factor=2, mode="nearest")
            x = activated(self.mix[level](torch.cat([levels[level], coarser], 1)))
            levels[level] = activated(self.dec[level](x))
        return [head(x).float() for head, x in zip(self.heads, levels)]

    def multiplications(self):
        """The number of multiplications for each pixel of the picture."""
        total = 0.0
        for name, layer in self.named_modules():
            if isinstance(layer, nn.Conv2d):
                part, *number = name.split(".")[:2]
                level = int(number[0]) + (part == "down") if number and number[0].isdigit() else 0
                total += layer.weight.numel() / 4**level
        return total


def shape_of(weights):
    """Returns the shape of the network that has these weights, as its state_dict() returns them."""
    levels = sum(name.startswith("heads.") and name.endswith(".bias") for name in weights)
    widths = [weights["inp.bias" if level == 0 else f"down.{level - 1}.bias"].numel() for level in range(levels)]
    depths = [sum(name.startswith(f"enc.{level}.") and name.endswith(".bias") for name in weights)
              for level in range(levels)]
    kernels = []
    for level in range(levels):
        others = (COARSE_TAPS + 1 if level + 1 < levels else 0) + (2 if level == 0 else 0)
        kernels.append(round((weights[f"heads.{level}.bias"].numel() / SIGNALS - others) ** 0.5))
    return Shape(tuple(widths), tuple(depths), tuple(kernels))


def name_of(shape):
    """Returns the name of the network that Limpid computes in this shape, or None."""
    return next((name for name, known in SHAPES.items() if known == shape), None)


def names():
    """Returns the names of the networks, as text for messages."""
    return " or ".join(f"'{name}'" for name in SHAPES)


def network_of(weights):
    """Returns the network that has these weights."""
    net = Net(shape_of(weights))
    net.load_state_dict({name: weight.float() for name, weight in weights.items()})
    return net


def pooled(light, seen, logits):
    """Returns the light of the next coarser level: means of 2x2 pixels, weighted by the exponential of the logits
    (batch, signals, 1, rows, columns). Light counts where something is seen; elsewhere the mean is 0."""
    batch, signals, channels, rows, columns = light.shape
    weights = torch.exp(logits.clamp(-LARGEST_POOL_LOGIT, LARGEST_POOL_LOGIT)) * seen.unsqueeze(1)

    def mean(image):
        return functional.avg_pool2d(image.flatten(1, 2), 2).view(batch, signals, -1, rows // 2, columns // 2)

    return mean(light * weights) / mean(weights).clamp(min=1e-12)


def taps_around(image, width):
    """Returns (batch, channels, width^2, rows, columns): the pixels around each pixel, row by row. Beyond the picture's
    edges lie the pixels at its edges."""
    batch, channels, rows, columns = image.shape
    around = functional.pad(image, (width // 2,) * 4, mode="replicate")
    return functional.unfold(around, width).view(batch, channels, width * width, rows, columns)


def taps_of_coarser(coarser):
    """Returns (batch, channels, COARSE_TAPS, rows, columns): for each pixel of a level, the four nearest ones of the
    coarser level, row by row. For the pixel in row 2 y + a they are in the rows y - 1 + a and y + a; columns
    likewise."""
    batch, channels, rows, columns = coarser.shape
    around = functional.pad(coarser, (1, 1, 1, 1), mode="replicate")
    taps = []
    for down in (0, 1):
        for right in (0, 1):
            of_rows = []
            for a in (0, 1):
                of_columns = [around[:, :, a + down : a + down + rows, b + right : b + right + columns]
                              for b in (0, 1)]
                of_rows.append(torch.stack(of_columns, -1))
            both = torch.stack(of_rows, -2)  # (batch, channels, y, x, a, b)
            taps.append(both.permute(0, 1, 2, 4, 3, 5).reshape(batch, channels, 2 * rows, 2 * columns))
    return torch.stack(taps, 2)


def softmax(logits, seen):
    """Returns the weights of taps (batch, signals, taps, rows, columns), whose sum is 1. Taps that see nothing have no
    weight; if none sees anything, all are 0."""
    most = logits.amax(2, keepdim=True).detach()
    # The largest logit may be that of a tap that sees nothing, and the others much smaller.
    weights = torch.exp((logits - most).clamp(min=LEAST_LOGIT)) * seen
    return weights / weights.sum(2, keepdim=True).clamp(min=1e-30)


def apply(net, logits, accumulated, svgf, seen):
    """Applies the weights that Net has predicted. `accumulated` and `svgf` are light (batch, signals, 3, rows,
    columns), before and after SVGF's filter; `seen` (batch, 1, rows, columns) is 1 where something is seen, else 0.

    Filtered light counts as seen if any of its taps is. So a pixel of a coarser level that sees nothing itself can
    still give light to pixels of the finer level: that of its neighbours."""
    levels = []
    light = accumulated
    for level, each in enumerate(logits):
        each = each.view(each.shape[0], SIGNALS, -1, *each.shape[2:])
        levels.append((light, seen, each))
        if level + 1 < len(logits):
            light, seen = pooled(light, seen, each[:, :, -1:]), functional.max_pool2d(seen, 2)
    own = own_seen = None
    for level, (light, seen, each) in reversed(list(enumerate(levels))):
        # The last channel is `seen`, so that it has the same taps as light.
        taps = taps_around(torch.cat([light.flatten(1, 2), seen], 1), net.shape.kernels[level])
        if own is not None:
            taps = torch.cat([taps, taps_of_coarser(torch.cat([own.flatten(1, 2), own_seen], 1))], 2)
        weights = softmax(each[:, :, : taps.shape[2]], taps[:, None, -1])
        own = (taps[:, :-1].view(*light.shape[:3], *taps.shape[2:]) * weights.unsqueeze(2)).sum(3)
        own_seen = taps[:, -1:].amax(2)
    finest, place = levels[0][2], net.kernel_logits(0)
    of_own, of_svgf = finest[:, :, place], finest[:, :, place + 1]
    share = torch.sigmoid(of_own - of_svgf).unsqueeze(2)
    return Filtered(svgf + share * (own - svgf), own, share)


def half_precision(device):
    """The precision in which the network is computed on this device."""
    return torch.autocast("cuda", dtype=torch.bfloat16) if device.type == "cuda" else contextlib.nullcontext()


def padded(image, multiple):
    """Repeats the last row and column until both numbers are multiples."""
    rows, columns = image.shape[-2:]
    if rows % multiple == 0 and columns % multiple == 0:
        return image
    flat = image.flatten(1, -3)  # pictures can be padded, stacks of them cannot
    flat = functional.pad(flat, (0, -columns % multiple, 0, -rows % multiple), mode="replicate")
    return flat.view(*image.shape[:-2], *flat.shape[2:])


def denoise(net, frame, predictor=None):
    """Filters a clips.Frame of any size. Returns Filtered. `predictor`: `net` itself, or a wrapper of it."""
    rows, columns = frame.depth.shape[2:]
    # The features are padded, not what they are computed from: the library, too, repeats those of pixels at the edge.
    x = padded(features.of_frame(frame), net.multiple)
    with half_precision(x.device):
        logits = (predictor or net)(x)
    images = (padded(image, net.multiple) for image in (frame.accumulated, frame.filtered, frame.seen))
    return Filtered(*(image[..., :rows, :columns] for image in apply(net, logits, *images)))
