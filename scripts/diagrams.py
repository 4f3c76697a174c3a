#!/usr/bin/env python3
"""Draws the documentation's diagrams as SVG. The background is white, so that they are readable on dark pages, too.

    scripts/diagrams.py docs/images"""

import os
import sys

INK, LINE = "#1b1f24", "#57606a"
FILLS = {"image": "#dbeafe", "pass": "#fde9c9", "history": "#dcf5e3", "result": "#f3d9ea", "plain": "#eef0f2"}


class Sheet:
    def __init__(self, width, height):
        self.width, self.height, self.parts = width, height, []

    def text(self, x, y, words, size=13, anchor="middle", weight="normal", fill=INK):
        self.parts.append(f'<text x="{x}" y="{y}" font-size="{size}" text-anchor="{anchor}" font-weight="{weight}" '
                          f'fill="{fill}">{words}</text>')

    def box(self, x, y, width, height, kind, *lines):
        """Draws a box with lines of text; the first one is bold."""
        radius = 14 if kind in ("image", "history") else 3
        self.parts.append(f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="{radius}" fill="{FILLS[kind]}" '
                          f'stroke="{LINE}"/>')
        middle = y + height / 2 - 8 * (len(lines) - 1) + 4.5
        for i, line in enumerate(lines):
            self.text(x + width / 2, middle + 16 * i, line, 13 if i == 0 else 11, weight="bold" if i == 0 else "normal")

    def line(self, *points, dashed=False, end=""):
        path = "M" + "L".join(f"{x} {y}" for x, y in points)
        dash = ' stroke-dasharray="5 4"' if dashed else ""
        self.parts.append(f'<path d="{path}" fill="none" stroke="{LINE}" stroke-width="1.5"{end}{dash}/>')

    def arrow(self, *points, dashed=False):
        self.line(*points, dashed=dashed, end=' marker-end="url(#tip)"')

    def write(self, path):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" '
                'font-family="sans-serif"><defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" '
                f'markerHeight="7" orient="auto"><path d="M0 0L8 4L0 8z" fill="{LINE}"/></marker></defs>'
                f'<rect width="{self.width}" height="{self.height}" rx="8" fill="#fff"/>')
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(head + "\n" + "\n".join(self.parts) + "\n</svg>\n")


def frame():
    """Draws one frame with SVGF: what each pass reads and writes, and what is kept for the next frame."""
    s = Sheet(984, 462)
    s.text(24, 30, "One frame with SVGF", 16, "start", "bold")
    s.box(24, 60, 154, 56, "plain", "scene", "moved by deform")
    s.box(24, 150, 154, 56, "plain", "camera", "now and one frame ago")
    s.box(222, 100, 150, 66, "pass", "path tracer", "1 sample per pixel")
    s.box(420, 54, 156, 50, "image", "diffuse, specular", "noisy light")
    s.box(420, 114, 156, 50, "image", "guides", "albedo, normal, depth, id")
    s.box(420, 174, 156, 50, "image", "motion", "where it was")
    s.box(420, 234, 156, 40, "image", "emission")
    for y in (79, 139, 199, 254):
        s.arrow((372, 133), (396, 133), (396, y), (419, y))
    s.arrow((178, 88), (200, 88), (200, 126), (221, 126))
    s.arrow((178, 178), (200, 178), (200, 142), (221, 142))
    s.box(620, 74, 152, 56, "pass", "reproject", "follow each surface,", "mean and moments")
    s.box(620, 156, 152, 44, "pass", "anti-lag", "drop what changed")
    s.box(620, 226, 152, 44, "pass", "variance", "moments or neighbours")
    s.box(620, 296, 152, 72, "pass", "4 levels", "a-trous filter of", "step 1, 2, 4, 8;", "the last one stabilises")
    for y in (79, 139, 199):
        s.arrow((576, y), (598, y), (598, 102), (619, 102))
    for top, bottom in ((130, 155), (200, 225), (270, 295)):
        s.arrow((696, top), (696, bottom))
    s.box(400, 294, 176, 72, "history", "histories", "mean before the levels,", "moments, count,",
          "last frame's guides")
    s.box(400, 386, 176, 44, "history", "stable light", "after the last level")
    s.arrow((620, 254), (606, 254), (606, 330), (577, 330), dashed=True)
    s.arrow((696, 368), (696, 408), (577, 408), dashed=True)
    s.line((400, 408), (384, 408), dashed=True)
    s.arrow((400, 330), (384, 330), (384, 446), (808, 446), (808, 92), (773, 92), dashed=True)
    s.text(696, 438, "read by the next frame", 11)
    s.box(824, 226, 136, 44, "pass", "compose", "× albedo, + emission")
    s.box(824, 302, 136, 44, "result", "clean frame")
    s.arrow((772, 332), (790, 332), (790, 248), (823, 248))
    s.arrow((892, 270), (892, 301))
    s.arrow((576, 262), (588, 262), (588, 213), (892, 213), (892, 225))
    return s


def atrous():
    """Draws which pixels the taps of each level of the a-trous filter read, along one row."""
    s = Sheet(940, 330)
    s.text(24, 30, "The levels of the a-trous filter: 5 taps along each axis, ever further apart", 16, "start", "bold")
    middle, unit = 512, 10.5
    for level in range(5):
        step, y = 2**level, 78 + 46 * level
        s.text(24, y + 4, f"level {level + 1}", 13, "start", "bold")
        s.text(84, y + 4, f"step {step}", 12, "start")
        for pixel in range(-32, 33):
            x = middle + unit * pixel
            s.parts.append(f'<rect x="{x - 4:.1f}" y="{y - 6}" width="8" height="12" fill="{FILLS["plain"]}"/>')
        for tap, weight in zip(range(-2, 3), (1, 4, 6, 4, 1)):
            x = middle + unit * step * tap
            s.parts.append(f'<rect x="{x - 4:.1f}" y="{y - 6}" width="8" height="12" fill="#2f6db3" '
                           f'fill-opacity="{0.35 + 0.65 * weight / 6:.2f}" stroke="{INK}"/>')
            if step > 2:
                s.text(f"{x:.1f}", y - 12, f"{weight}/16", 10)
        s.text(926, y + 4, f"reach {2 * (2 ** (level + 1) - 1)}", 12, "end")
    s.text(24, 312, "Each level reads what the level before it wrote: 25 taps of a 2D level reach as far as a kernel of 125 × 125 "
           "pixels after five.", 12, "start")
    return s


def networks():
    """Draws KPCN: the networks for both sides, and the steps after them."""
    s = Sheet(948, 392)
    s.text(24, 30, "KPCN: one network for each kind of light", 16, "start", "bold")
    for side, top in (("diffuse", 60), ("specular", 200)):
        divided = "÷ (albedo + 0.00316)" if side == "diffuse" else "log(1 + x)"
        back = "× (albedo + 0.00316)" if side == "diffuse" else "exp(x) − 1"
        s.box(24, top, 96, 56, "image", side, "32 samples")
        s.box(138, top, 144, 56, "pass", "transform", divided)
        s.box(300, top - 8, 162, 72, "plain", "34 channels", "light, albedo, normal,",
              "depth; the gradients", "and variance of each")
        s.box(480, top, 130, 56, "pass", "8 convolutions", "5×5, 100 channels,", "ReLU")
        s.box(628, top, 126, 56, "pass", "convolution", "5×5, 441 channels,", "softmax")
        s.box(628, top + 76, 126, 40, "pass", "21×21 kernel", "weighted mean")
        s.box(772, top + 68, 144, 56, "pass", "transform back", back)
        for x, end in ((120, 137), (282, 299), (462, 479), (610, 627)):
            s.arrow((x, top + 28), (end, top + 28))
        s.arrow((691, top + 56), (691, top + 75))
        s.arrow((210, top + 56), (210, top + 96), (627, top + 96))
        s.text(420, top + 90, "the light itself", 11)
        s.arrow((754, top + 96), (771, top + 96))
    s.box(660, 344, 256, 34, "result", "sum + emission = clean frame")
    s.arrow((916, 156), (930, 156), (930, 361), (917, 361))
    s.arrow((844, 324), (844, 343))
    return s


def main(folder):
    for name, sheet in (("diagram-frame", frame()), ("diagram-atrous", atrous()), ("diagram-kpcn", networks())):
        sheet.write(os.path.join(folder, name + ".svg"))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
