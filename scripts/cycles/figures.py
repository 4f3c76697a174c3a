"""Statistics of the difference between two renderers' pictures. Needs only numpy.

Each renderer renders a scene twice, with two seeds. The means of the two pictures are compared. The difference of the
two is noise, and shows how large a deviation noise alone would cause.

Pictures are height x width x 3, linear.
"""

import dataclasses
import json

import numpy


@dataclasses.dataclass
class Ratio:
    """The ratio of the test's mean to the reference's, and its standard error due to noise."""

    value: float
    error: float

    def deviates(self, tolerance=0.01):
        """Returns whether the ratio differs from 1 by more than the tolerance plus three standard errors."""
        return abs(self.value - 1) > tolerance and abs(self.value - 1) > tolerance + 3 * self.error


def mean_pictures(test, reference):
    """Returns the mean picture of each renderer. `test` and `reference` are pairs of pictures."""
    return (test[0] + test[1]) / 2, (reference[0] + reference[1]) / 2


def noise_pictures(test, reference):
    """Returns two pictures whose difference has the same noise as that of mean_pictures(), but no systematic part."""
    return (test[0] + reference[0]) / 2, (test[1] + reference[1]) / 2


def ratio(test, reference):
    """Returns the Ratio of two pairs of pictures. Assumes that pixels are independent, but not the components of
    one."""
    mean_test, mean_reference = mean_pictures(test, reference)
    noise_a, noise_b = noise_pictures(test, reference)
    denominator = mean_reference.sum()
    per_pixel = (noise_a - noise_b).sum(axis=2)
    return Ratio(mean_test.sum() / denominator, numpy.sqrt((per_pixel**2).sum()) / denominator)


def strips(picture, count):
    """Cuts a picture into `count` vertical strips of equal width, from left to right."""
    edges = [round(picture.shape[1] * i / count) for i in range(count + 1)]
    return [picture[:, a:b] for a, b in zip(edges, edges[1:])]


def strip_ratios(test, reference, count):
    """Returns the ratio() of each strip."""
    cut = [strips(picture, count) for picture in (*test, *reference)]
    return [ratio((a, b), (c, d)) for a, b, c, d in zip(*cut)]


@dataclasses.dataclass
class Result:
    """The result of one scene. The fields ending in _noise are the same metrics of noise_pictures()."""

    name: str
    samples: int
    mean: Ratio
    relmse: float
    relmse_noise: float
    flip: float
    flip_noise: float
    strips: dict  # name -> Ratio

    def deviates(self):
        return self.mean.deviates() or any(strip.deviates() for strip in self.strips.values())

    def save(self, path):
        with open(path, "w", encoding="utf-8") as file:
            json.dump(dataclasses.asdict(self), file, indent=1)

    @staticmethod
    def load(path):
        with open(path, encoding="utf-8") as file:
            result = Result(**json.load(file))
        result.mean = Ratio(**result.mean)
        result.strips = {name: Ratio(**strip) for name, strip in result.strips.items()}
        return result


def line(number, result):
    """Returns a row of the Markdown table."""
    off = abs(result.mean.value - 1) > 0.01
    mean = f"**{result.mean.value:.4f}**" if off else f"{result.mean.value:.4f}"
    return (f"| {number} | `{result.name}` | {result.samples} | {mean} ± {result.mean.error:.4f} | "
            f"{result.relmse:.5f} ({result.relmse_noise:.5f}) | {result.flip:.3f} ({result.flip_noise:.3f}) |")


def strip_line(result):
    strips = [f"{name}: {strip.value:.3f} ± {strip.error:.3f}" for name, strip in result.strips.items()]
    return f"- `{result.name}`: {', '.join(strips)}"


def table(results):
    """Returns numbered results as Markdown: the table, then a line for each scene with strips."""
    lines = ["| # | scene | samples | mean ratio | relMSE (of noise) | FLIP (of noise) |", "|---|---|---|---|---|---|"]
    lines += [line(number, result) for number, result in results] + [""]
    lines += [strip_line(result) for _, result in results if result.strips]
    return "\n".join(lines) + "\n"
