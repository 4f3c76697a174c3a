#!/usr/bin/python3
"""Writes the terrains of docs/benchmarks.md: a .glb of N x N quads with waves, which are 2 N N triangles.

    bench/terrain.py N FILE
"""
import json
import struct
import sys

import numpy

WAVES = 8
GLB_MAGIC, JSON_CHUNK, BIN_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942


def positions(n):
    along = numpy.arange(n + 1, dtype=numpy.float32) / n
    x, z = numpy.meshgrid(along, along)
    y = numpy.zeros_like(x)
    random = numpy.random.default_rng(1)
    for k in range(1, WAVES + 1):
        a, b = random.uniform(-2**k, 2**k, 2)
        phase = random.uniform(0, 6.28)
        y += (0.3 / 2**k * numpy.sin(6.28 * (a * x + b * z) + phase)).astype(numpy.float32)
    y += random.uniform(0, 0.3 / n, y.shape).astype(numpy.float32)
    return numpy.stack([x, y, z], -1).reshape(-1, 3).astype(numpy.float32)


def indices(n):
    first = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)[None, :]).reshape(-1).astype(numpy.uint32)
    corners = [first, first + n + 1, first + 1, first + 1, first + n + 1, first + n + 2]
    return numpy.stack(corners, -1).reshape(-1).astype(numpy.uint32)


def scene(points, corners):
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
             "min": points.min(0).tolist(), "max": points.max(0).tolist()},
            {"bufferView": 1, "componentType": 5125, "count": len(corners), "type": "SCALAR"}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes},
            {"buffer": 0, "byteOffset": points.nbytes, "byteLength": corners.nbytes}],
        "buffers": [{"byteLength": points.nbytes + corners.nbytes}]}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    n = int(sys.argv[1])
    points, corners = positions(n), indices(n)
    text = json.dumps(scene(points, corners)).encode()
    text += b" " * (-len(text) % 4)
    binary = points.nbytes + corners.nbytes
    with open(sys.argv[2], "wb") as file:
        file.write(struct.pack("<III", GLB_MAGIC, 2, 12 + 8 + len(text) + 8 + binary))
        file.write(struct.pack("<II", len(text), JSON_CHUNK) + text)
        file.write(struct.pack("<II", binary, BIN_CHUNK))
        points.tofile(file)
        corners.tofile(file)


main()
