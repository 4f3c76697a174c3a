"""Assembles the picture of all scenes. For each: Limpid, Cycles, and their difference times eight (grey: equal)."""

import numpy

# A bitmap font: 3x5 pixels per digit, one octal digit per row.
DIGITS = {"0": 0o75557, "1": 0o26227, "2": 0o71747, "3": 0o71717, "4": 0o55711,
          "5": 0o74717, "6": 0o74757, "7": 0o71111, "8": 0o75757, "9": 0o75717}


def encoded(linear):
    c = numpy.clip(linear, 0, 1)
    return numpy.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def tile(number, test, reference):
    """Returns the pictures of one scene side by side, with its number. The exposure is chosen for the reference."""
    exposure = 0.18 / max((reference @ [0.2126, 0.7152, 0.0722]).mean(), 1e-9)
    shown, wanted = encoded(test * exposure), encoded(reference * exposure)
    picture = numpy.concatenate([shown, wanted, numpy.clip(0.5 + 8 * (shown - wanted), 0, 1)], axis=1)
    write(picture, str(number))
    return picture


def write(picture, digits, scale=2):
    """Draws white digits on black into the upper left corner."""
    picture[: 7 * scale, : (4 * len(digits) + 1) * scale] = 0
    for i, digit in enumerate(digits):
        bits = numpy.array([int(b) for b in f"{DIGITS[digit]:015b}"]).reshape(5, 3)
        glyph = numpy.kron(bits, numpy.ones((scale, scale)))[..., None]
        left = (4 * i + 1) * scale
        picture[scale:6 * scale, left:left + 3 * scale] = glyph


def contact(tiles, columns=2, gap=4):
    """Arranges tiles in rows of `columns` on white. A row is as high as its highest tile."""
    rows = [tiles[i:i + columns] for i in range(0, len(tiles), columns)]
    heights = [max(picture.shape[0] for picture in row) + gap for row in rows]
    width = tiles[0].shape[1] + gap
    result = numpy.ones((sum(heights) - gap, columns * width - gap, 3))
    for row, height, bottom in zip(rows, heights, numpy.cumsum(heights)):
        for i, picture in enumerate(row):
            top, left = bottom - height, i * width
            result[top:top + picture.shape[0], left:left + picture.shape[1]] = picture
    return result
