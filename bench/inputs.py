#!/usr/bin/python3
"""Measures what leaving an input out costs: time of all passes, and the error of the pictures (docs/embedding.md).

Renders sequences with one sample per pixel and their references, and denoises them with and without each input through
the library's C interface (Python module limpid). Prints a Markdown table: the differences in the time of all passes
and in the error of the pictures, compared with giving all inputs.

    PYTHONPATH=build/release/python bench/inputs.py [--device NAME] [--width W --height H] [--frames N] [--spp N] [--scene NAME]
"""
import argparse

import numpy

import limpid

SEQUENCES = (("builtin:lab-textures", "dolly"), ("builtin:cornell-moving", "shake"), ("builtin:lab-mirror", "orbit"),
             ("builtin:lab-disocclusion", "shake"))
OPTIONAL = ("albedo", "albedo_specular", "emission", "motion", "previous_normal", "reflection_motion", "roughness",
            "hit_distance", "id")
# What is left out; with hit distances, the motion of reflections is computed if it is missing.
CASES = ((), ("albedo",), ("albedo_specular",), ("emission",), ("motion",), ("previous_normal",), ("reflection_motion",),
         ("reflection_motion", "hit_distance"), ("id",))
COMPARED = 2  # the last frames of a sequence


def inputs_of(frame):
    return {name: frame[name] for name in ("normal", "depth", *OPTIONAL) if name in frame}


def denoised(frames, method, signals, without, device):
    """Returns the last COMPARED denoised frames, and the median time of all passes in milliseconds."""
    height, width = frames[0]["depth"].shape[:2]
    denoiser = limpid.Denoiser(width, height, method, signals=signals, motion_depth="distance", timings=True,
                               device=device)
    pictures, times = [], []
    for frame in frames:
        given = inputs_of(frame)
        for name in without:
            given.pop(name, None)
        light = {"radiance": frame["diffuse"], "specular": frame["specular"]}
        if "emission" in without:  # a renderer that does not separate it has it in its radiance
            light["radiance"] = frame["diffuse"] + frame["emission"]
        if signals == 1:
            light = {"radiance": light["radiance"] + frame["specular"]}
        pictures.append(denoiser.denoise(**light, **given, view=frame["view"], projection=frame["projection"]))
        times.append(sum(denoiser.timings().values()))
    return pictures[-COMPARED:], float(numpy.median(times[1:]))


def scores(pictures, references):
    compared = [limpid.compare(picture, reference) for picture, reference in zip(pictures, references)]
    return {name: float(numpy.mean([each[name] for each in compared])) for name in ("psnr", "flip")}


def measure(options):
    rows = {}
    for scene, path in SEQUENCES:
        if options.scene and options.scene not in scene:
            continue
        size = (scene, options.width, options.height)
        shared = {"camera_path": path, "device": options.device}
        noisy = list(limpid.render_sequence(*size, frames=options.frames, spp=1, **shared))
        references = [frame["color"] for frame in limpid.render_sequence(
            *size, frames=options.frames, first=options.frames - COMPARED, spp=options.spp, jitter="off", seed=1,
            **shared)]
        for method, signals in (("svgf", 1), ("svgf", 2), ("atrous", 1)):
            for without in CASES:
                pictures, time = denoised(noisy, method, signals, without, options.device)
                result = scores(pictures, references)
                rows[scene, method, signals, without] = (result["psnr"], result["flip"], time)
                print(scene, method, signals, "+".join(without) or "all", *("%.4f" % v for v in rows[
                    scene, method, signals, without]), flush=True)
    return rows


def print_table(rows):
    scenes = list(dict.fromkeys(scene for scene, *_ in rows))
    print("| without | method | " + " | ".join(scene.removeprefix("builtin:") for scene in scenes) + " |")
    print("|---|---|" + "---|" * len(scenes))
    for without in CASES[1:]:
        for method, signals in (("svgf", 1), ("svgf", 2), ("atrous", 1)):
            cells = []
            for scene in scenes:
                full, less = rows[scene, method, signals, ()], rows[scene, method, signals, without]
                cells.append("%+.2f dB, %+.4f, %+.3f ms" % tuple(b - a for a, b in zip(full, less)))
            print(f"| {', '.join(without)} | {method}, {signals} | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device")
    parser.add_argument("--scene", default="", help="only sequences whose name contains this")
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--height", type=int, default=360)
    parser.add_argument("--frames", type=int, default=32)
    parser.add_argument("--spp", type=int, default=2048, help="samples of the references")
    print_table(measure(parser.parse_args()))


if __name__ == "__main__":
    main()
