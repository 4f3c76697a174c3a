"""The kernel-predicting network: Bako et al. 2017 (see features.py). src/denoise/kpcn has the same layers by the same names."""

import torch
from torch import nn
from torch.nn import functional

from . import features


def convolve(layer, x):
    """The layer; in half precision with as many channels of zeros as tensor cores want, which all that follows keeps."""
    if not torch.is_autocast_enabled():
        return layer(x)
    inputs = x.shape[1] + -x.shape[1] % 8
    more = -layer.out_channels % 8
    x = functional.pad(x, (0, 0, 0, 0, 0, inputs - x.shape[1]))
    weight = functional.pad(layer.weight, (0, 0, 0, 0, 0, inputs - layer.in_channels, 0, more))
    return functional.conv2d(x, weight, functional.pad(layer.bias, (0, more)), padding=2)


class KernelPredictor(nn.Module):
    """From (batch, 34, rows, columns) to the weights of a kernel for each pixel (batch, width^2, rows, columns), not
    yet normalised; or, if `direct`, to colours (batch, 3, rows, columns). `hidden` convolutions of `channels` channels
    with ReLU, and one more; all of 5x5 taps, with zeros around the picture. `inputs`: a key of features.INPUTS; the other
    channels are taken as 0."""

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
#: No limit: kernels as in the paper.
ANY_FACING = -2.0


def apply_kernel(logits, light, faces, facing=FACING):
    """The mean of the pixels around each, by the softmax of `logits` (batch, width^2, rows, columns; rows of the kernel from
    the top) over those that lie in the picture and whose normal's cosine with the pixel's own is at least `facing`. `light`:
    (batch, channels, rows, columns), `faces`: likewise, from features.faces()."""
    width = round(logits.shape[1] ** 0.5)
    radius = width // 2
    rows, columns = light.shape[2:]
    padded = functional.pad(light, [radius] * 4)
    around = functional.pad(faces, [radius] * 4)
    outside = functional.pad(torch.zeros_like(light[:, :1]), [radius] * 4, value=-8.0)  # below any cosine

    def row_of_taps(image, top):
        """(batch, channels, rows, taps, columns), without a copy."""
        return image[:, :, top : top + rows].unfold(3, columns, 1)

    def exponents(top):
        taps = logits[:, top * width : (top + 1) * width].permute(0, 2, 1, 3).unsqueeze(1)
        cosine = (row_of_taps(around, top) * faces.unsqueeze(3)).sum(dim=1, keepdim=True)
        return taps.masked_fill(cosine + row_of_taps(outside, top) < facing, -torch.inf)

    # One kernel row at a time, since all at once would take the memory of width^2 pictures.
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
    """Both sides, and the denoised picture without emission. `direct`: the network predicts colours instead of kernels,
    for comparison only; Limpid cannot denoise with that."""

    def __init__(self, hidden=8, channels=100, width=21, facing=FACING, inputs="all", direct=False):
        super().__init__()
        self.facing, self.direct = facing, direct
        self.diffuse = KernelPredictor(hidden, channels, width, direct, inputs)
        self.specular = KernelPredictor(hidden, channels, width, direct, inputs)

    def side(self, side, prepared):
        """Denoised light of one side, as to_network() has it: what each is trained by alone. `prepared`: features.prepare()."""
        return self.side_and_logits(side, prepared)[0]

    def side_and_logits(self, side, prepared):
        """And the kernels' weights before their softmax; zeros where there are no kernels."""
        result = getattr(self, side)(prepared[side + ".input"]).float()
        if self.direct:
            return result, torch.zeros_like(result)
        return apply_kernel(result, prepared[side + ".light"], prepared["faces"], self.facing), result

    def forward(self, prepared):
        return features.recombined({side: self.side(side, prepared) for side in features.SIDES}, prepared["albedo"])


def network_of(options):
    """The network that a run's options describe."""
    return Kpcn(**{name: options[name] for name in ("hidden", "channels", "width", "facing", "inputs", "direct")})
