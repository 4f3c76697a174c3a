#!/usr/bin/env python3
"""Efficiency of a cluster at 8, 64 and 1,024 devices: a model from measured times (docs/cluster.md).

    tools/cluster/efficiency.py             # the table
    tools/cluster/efficiency.py --block 2   # with other figures; --help lists them

The time with N devices is that of the start, of the pieces, of waiting for the last ones (or for the file system), and
of what process 0 does alone. Efficiency is the time of the pieces on one device, over N times the time with N devices.
"""
import argparse
import math

DEVICES = (8, 64, 1024)


def still(f, devices):
    """Pieces are blocks. At the end process 0 takes the sums of all, one after the other."""
    pieces = math.ceil(f.samples / f.block_samples)
    makers = min(devices, pieces)
    rounds = math.ceil(pieces / devices) * f.block
    gather = (makers - 1) * f.pixels * f.bytes_per_pixel * (1 / f.network + 1 / f.add_rate)
    alone = f.write
    return pieces * f.block, {"start": f.start, "pieces": rounds, "gather": gather, "write": alone}


def shot(f, devices):
    """Pieces are windows, each with a run-up."""
    windows = math.ceil(f.frames / f.window)
    frame = max(f.frame, f.frame_bytes * min(devices, windows) / f.file_rate)
    rounds = math.ceil(windows / devices)
    parts = {"start": f.start, "pieces": rounds * f.window * frame, "run-ups": rounds * f.run_up * frame}
    return f.frames * f.frame, parts


def dataset(f, devices):
    """Pieces are files of examples."""
    pieces = math.ceil(f.examples / f.per_file)
    example = max(f.example, f.example_bytes * min(devices, pieces) / f.file_rate)
    rounds = math.ceil(pieces / devices) * f.per_file * example
    manifest = f.examples * f.example_bytes / f.read_rate
    return f.examples * f.example, {"start": f.start, "pieces": rounds, "manifest": manifest}


def figures():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)

    def add(name, value, text):
        parser.add_argument(f"--{name}", type=float, default=value, help=f"{text} ({value:g})")

    add("start", 1.5, "seconds until the first piece: MPI, scene, pipelines")
    add("network", 10e9, "bytes a second into process 0")
    add("file-rate", 5e9, "bytes a second that the file system takes from all")
    add("read-rate", 1e9, "bytes a second at which process 0 reads and checks files of a dataset")
    add("pixels", 1920 * 1080, "of a still")
    add("bytes-per-pixel", 64, "of a still's sums: 64 for the beauty, 520 with all layers")
    add("samples", 65536, "per pixel of a still")
    add("block-samples", 256, "per pixel of a block")
    add("block", 256 * 6.09e-3, "seconds of a block")
    add("add-rate", 1.3e9, "bytes of sums a second that process 0 adds")
    add("write", 0.5, "seconds for a still's checkpoint and file")
    add("frames", 2400, "of a shot")
    add("window", 32, "frames of a window")
    add("run-up", 16, "frames before a window")
    add("frame", 1 / 2.13, "seconds of a frame: read, denoise, write")
    add("frame-bytes", 106e6, "read and written for a frame")
    add("examples", 8192, "of a dataset")
    add("per-file", 8, "examples of a file")
    add("example", 0.56, "seconds of an example")
    add("example-bytes", 3.1e6, "of an example")
    return parser.parse_args()


def main():
    f = figures()
    print("| | devices | time, s | efficiency | where the rest goes |\n|---|---|---|---|---|")
    for name, model in (("still", still), ("shot", shot), ("dataset", dataset)):
        for devices in DEVICES:
            useful, parts = model(f, devices)
            time = sum(parts.values())
            ideal = useful / devices
            parts["pieces"] -= ideal
            rest = ", ".join(f"{part} {seconds:.2g} s" for part, seconds in parts.items() if seconds >= 0.01 * time)
            rest = rest.replace("pieces", "waiting")
            print(f"| {name} | {devices} | {time:.3g} | {100 * ideal / time:.0f} % | {rest} |")


if __name__ == "__main__":
    main()
