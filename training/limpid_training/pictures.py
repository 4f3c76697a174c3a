"""Writes PNG and PFM files and SVG plots, without further libraries."""

import html
import math
import struct
import zlib

import torch


def shown(light):
    """Tone-maps radiance (3, rows, columns) for display: scales the median to 0.18, clamps, encodes as sRGB."""
    positive = light[light > 0]
    x = (light * (0.18 / positive.median()) if positive.numel() else light).clamp(0, 1)
    return torch.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def write_png(path, image):
    """Writes an image (3, rows, columns) with values from 0 to 1."""
    texels = (image.clamp(0, 1) * 255 + 0.5).to(torch.uint8).permute(1, 2, 0).contiguous()
    rows, columns = texels.shape[:2]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + row.numpy().tobytes() for row in texels)
    with open(path, "wb") as stream:
        stream.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0)))
        stream.write(chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def write_pfm(path, image):
    """Writes an image (3, rows, columns) with all its bits."""
    texels = image.float().flip(1).permute(1, 2, 0).contiguous()  # the bottom row first
    rows, columns = texels.shape[:2]
    with open(path, "wb") as stream:
        stream.write(b"PF\n%d %d\n-1.0\n" % (columns, rows) + texels.numpy().tobytes())


COLORS = ("#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b")


def ticks(low, high):
    """Returns the axis ticks from `low` to `high`: 1, 2 and 5 times powers of ten."""
    powers = range(math.floor(math.log10(low)) - 1, math.ceil(math.log10(high)) + 1)
    return [m * 10.0**e for e in powers for m in (1, 2, 5) if low <= m * 10.0**e <= high]


def panel(left, width, height, title, across, curves):
    """Returns the SVG elements of one plot. `curves` maps names to (xs, ys). The y axis is logarithmic; points with y
    <= 0 or infinite y are left out. `across` is the label of the x axis."""
    points = [(x, y) for xs, ys in curves.values() for x, y in zip(xs, ys) if 0 < y < math.inf]
    if not points:
        return []
    low, high = min(y for _, y in points) / 1.1, max(y for _, y in points) * 1.1
    begin, end = min(x for x, _ in points), max(x for x, _ in points)
    begin, end = (0.0, end) if begin < end else (begin - 1, begin + 1)
    top, bottom, inner = 60, height - 40, width - 70

    def place(x, y):
        share = math.log(max(y, low) / low) / math.log(high / low)
        return left + 55 + inner * (x - begin) / (end - begin), bottom - (bottom - top) * share

    parts = [f'<text x="{left + 55}" y="20" font-weight="bold">{title}</text>']
    for value in ticks(low, high):
        y = place(begin, value)[1]
        parts.append(f'<line x1="{left + 55}" x2="{left + 55 + inner}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>')
        parts.append(f'<text x="{left + 50}" y="{y + 4:.1f}" text-anchor="end">{value:g}</text>')
    step = max(10 ** math.floor(math.log10((end - begin) / 2)), 1)
    for value in range(0, math.floor(end) + 1, max(step * (2 if (end - begin) / step > 8 else 1), 1)):
        parts.append(f'<text x="{place(value, low)[0]:.1f}" y="{bottom + 16}" text-anchor="middle">{value}</text>')
    parts.append(f'<text x="{left + 55 + inner / 2}" y="{height - 6}" text-anchor="middle">{across}</text>')
    for k, (name, (xs, ys)) in enumerate(curves.items()):
        color = COLORS[k % len(COLORS)]
        line = " ".join("{:.1f},{:.1f}".format(*place(x, y)) for x, y in zip(xs, ys) if 0 < y < math.inf)
        parts.append(f'<polyline fill="none" stroke="{color}" stroke-width="1.5" points="{line}"/>')
        x, y, label = left + 60 + inner / 2 * (k % 2), 36 + 14 * (k // 2), html.escape(name, quote=False)
        parts.append(f'<text x="{x}" y="{y}" fill="{color}">{label}</text>')
    return parts


def write_plots(path, plots, width=460, height=340):
    """Writes an SVG file with `plots` side by side. Each plot is (title, label of the x axis, {name: (xs, ys)}). The
    background is white, so that the plots are readable on dark pages, too."""
    whole = width * len(plots)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {whole} {height}" font-family="sans-serif" '
             'font-size="12">',
             f'<rect width="{whole}" height="{height}" fill="white"/>']
    for i, (title, across, curves) in enumerate(plots):
        parts += panel(i * width, width, height, title, across, curves)
    with open(path, "w") as stream:
        stream.write("\n".join(parts) + "\n</svg>\n")


def write_curves(path, curves, phases=()):
    """Plots losses over epochs. `curves` maps names to lists of positive numbers, one per epoch. Curves named in
    `phases` belong to a later phase of the training: they begin after the longest of the other curves, not counting
    "validation", which covers all epochs."""
    first = max((len(y) for name, y in curves.items() if name not in phases and name != "validation"), default=0)

    def epochs(name, ys):
        begin = first if name in phases else 0
        return [begin + i + 1 for i in range(len(ys))]

    write_plots(path, [("Loss, and relMSE over the noisy picture's (validation)", "epoch",
                        {name: (epochs(name, ys), ys) for name, ys in curves.items()})], width=720)
