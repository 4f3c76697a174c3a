"""Pictures for people, without further libraries: PNG files, and curves as SVG."""

import struct
import zlib

import torch


def shown(light):
    """(3, rows, columns) of radiance as a screen shows it: exposed by its own median, clamped, sRGB."""
    positive = light[light > 0]
    x = (light * (0.18 / positive.median()) if positive.numel() else light).clamp(0, 1)
    return torch.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def write_png(path, image):
    """(3, rows, columns), 0 to 1."""
    texels = (image.clamp(0, 1) * 255 + 0.5).to(torch.uint8).permute(1, 2, 0).contiguous()
    rows, columns = texels.shape[:2]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + row.numpy().tobytes() for row in texels)
    with open(path, "wb") as stream:
        stream.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0)))
        stream.write(chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def write_curves(path, curves):
    """`curves`: names to lists of numbers above 0, one an epoch; on a logarithmic axis."""
    colors = ("#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b")
    values = [v for curve in curves.values() for v in curve if v > 0]
    if not values:
        return
    low, high = min(values), max(values)
    width, height, longest = 720, 360, max(len(curve) for curve in curves.values())

    def point(i, value):
        across = 60 + (width - 80) * i / max(longest - 1, 1)
        share = torch.log(torch.tensor(max(value, low) / low)) / max(torch.log(torch.tensor(high / low)).item(), 1e-9)
        return f"{across:.1f},{height - 30 - (height - 60) * share:.1f}"

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">']
    parts.append(f'<rect width="{width}" height="{height}" fill="white"/>')
    parts.append(f'<text x="4" y="{height - 26}">{low:.3g}</text><text x="4" y="34">{high:.3g}</text>')
    for k, (name, curve) in enumerate(curves.items()):
        color = colors[k % len(colors)]
        line = " ".join(point(i, value) for i, value in enumerate(curve))
        parts.append(f'<polyline fill="none" stroke="{color}" points="{line}"/>')
        parts.append(f'<text x="{70 + 150 * (k % 4)}" y="{16 + 16 * (k // 4)}" fill="{color}">{name}</text>')
    with open(path, "w") as stream:
        stream.write("\n".join(parts) + "\n</svg>\n")
