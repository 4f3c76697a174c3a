"""The kernel-predicting network of Bako et al. 2017 (reference in features.py). The weights that src/denoise/kpcn
reads have the same layer names."""

import torch
from torch import nn
from torch.nn import functional

from . import features


def convolve(layer, x):
    """Applies a convolution. In half precision, pads inputs and outputs with zero channels to a multiple of 8, which
    tensor cores need to be fast. The result keeps the additional channels."""
    if not torch.is_autocast_enabled():
        return layer(x)
    inputs = x.shape[1] + -x.shape[1] % 8
    more = -layer.out_channels % 8
    x = functional.pad(x, (0, 0, 0, 0, 0, inputs - x.shape[1]))
    weight = functional.pad(layer.weight, (0, 0, 0, 0, 0, inputs - layer.in_channels, 0, more))
    return functional.conv2d(x, weight, functional.pad(layer.bias, (0, more)), padding=2)


class KernelPredictor(nn.Module):
    """Predicts a kernel for each pixel: maps (batch, 34, rows, columns) to logits (batch, width^2, rows, columns),
    whose softmax is the kernel's weights. If `direct`, predicts colours (batch, 3, rows, columns) instead.

    There are `hidden` convolutions to `channels` channels with ReLU, and one more without. All have 5x5 taps and zero
    padding. `inputs` is a key of features.INPUTS; channels that it does not name are replaced by 0."""

    def __init__(self, hidden=8, channels=100, width=21, direct=False, inputs="all"):
        super().__init__()
        if width % 2 != 1:
            raise ValueError(f"a kernel {width} pixels wide has no centre")
        self.outputs = 3 if direct else width * width
        seen = torch.zeros(1, features.INPUT_CHANNELS, 1, 1)
        seen[:, list(features.INPUTS[inputs])] = 1.0
        self.register_buffer("seen", seen, persistent=False)
        before = features.INPUT_CHANNELS
        self.hidden = nn.ModuleList()
        for _ in range(hidden):
            self.hidden.append(nn.Conv2d(before, channels, 5, padding=2))
            before = channels
        self.output = nn.Conv2d(before, self.outputs, 5, padding=2)
        for layer in [*self.hidden, self.output]:
            nn.init.xavier_uniform_(layer.weight)
            nn.init.zeros_(layer.bias)

    def forward(self, x):
        x = x * self.seen
        for layer in self.hidden:
            x = functional.relu(convolve(layer, x))
        return convolve(self.output, x)[:, : self.outputs]


#: Minimum cosine between a pixel's normal and those of the pixels in its kernel (KpcnWeights::facing).
FACING = 0.5
#: No condition on normals, as in the paper.
ANY_FACING = -2.0


def apply_kernel(logits, light, faces, facing=FACING):
    """Averages the width x width pixels around each pixel, weighted by the softmax of `logits` (batch, width^2, rows,
    columns; taps row by row from the top left).

    The softmax covers only taps that lie in the picture and whose normal has a cosine of at least `facing` with the
    centre pixel's. `light` has the shape (batch, channels, rows, columns), and so has `faces`, which comes from
    features.faces()."""
    width = round(logits.shape[1] ** 0.5)
    radius = width // 2
    rows, columns = light.shape[2:]
    padded = functional.pad(light, [radius] * 4)
    around = functional.pad(faces, [radius] * 4)
    outside = functional.pad(torch.zeros_like(light[:, :1]), [radius] * 4, value=-8.0)  # below any cosine

    def row_of_taps(image, top):
        """Returns a view (batch, channels, rows, taps, columns) of the pixels under kernel row `top`."""
        return image[:, :, top : top + rows].unfold(3, columns, 1)

    def exponents(top):
        taps = logits[:, top * width : (top + 1) * width].permute(0, 2, 1, 3).unsqueeze(1)
        cosine = (row_of_taps(around, top) * faces.unsqueeze(3)).sum(dim=1, keepdim=True)
        return taps.masked_fill(cosine + row_of_taps(outside, top) < facing, -torch.inf)

    # One kernel row at a time: all at once would need the memory of width^2 pictures.
    with torch.no_grad():
        largest = torch.stack([exponents(top).amax(dim=3) for top in range(width)]).amax(dim=0)
    total = torch.zeros_like(light)
    weights = torch.zeros_like(light[:, :1])
    for top in range(width):
        weight = torch.exp(exponents(top) - largest.unsqueeze(3))
        total = total + (weight * row_of_taps(padded, top)).sum(dim=3)
        weights = weights + weight.sum(dim=3)
    return total / weights


class Kpcn(nn.Module):
    """The networks of both sides; computes the denoised picture without emission. If `direct`, the networks predict
    colours instead of kernels. This is only for comparison: Limpid's denoiser cannot use such a network."""

    def __init__(self, hidden=8, channels=100, width=21, facing=FACING, inputs="all", direct=False,
                 diffuse_input="logarithmic"):
        super().__init__()
        if diffuse_input not in features.DIFFUSE_INPUTS:
            raise ValueError(f"diffuse_input is '{diffuse_input}', not one of {', '.join(features.DIFFUSE_INPUTS)}")
        self.facing, self.direct, self.diffuse_input = facing, direct, diffuse_input
        self.diffuse = KernelPredictor(hidden, channels, width, direct, inputs)
        self.specular = KernelPredictor(hidden, channels, width, direct, inputs)

    def prepare(self, frame):
        """Returns features.prepare() of a frame with the inputs that this network takes."""
        return features.prepare(frame, self.diffuse_input)

    def side(self, side, prepared):
        """Returns the denoised light of one side in network space (features.to_network()). `prepared` comes from
        prepare()."""
        return self.side_and_logits(side, prepared)[0]

    def side_and_logits(self, side, prepared, predictor=None):
        """Returns side(), and the logits of the kernels; zeros if the network predicts colours. `predictor`: this
        network's own, or a wrapper of it."""
        result = (predictor or getattr(self, side))(prepared[side + ".input"]).float()
        if self.direct:
            return result, torch.zeros_like(result)
        return apply_kernel(result, prepared[side + ".light"], prepared["faces"], self.facing), result

    def forward(self, prepared):
        return features.recombined({side: self.side(side, prepared) for side in features.SIDES}, prepared["albedo"])


def network_of(options):
    """Creates the network that a training run's options describe."""
    names = ("hidden", "channels", "width", "facing", "inputs", "direct", "diffuse_input")
    return Kpcn(**{name: options[name] for name in names})
