"""Builds the scenes in Blender, renders them with Cycles and with Limpid, compares. scripts/cycles.sh runs it."""

import argparse
import json
import os
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402

import figures  # noqa: E402
import images  # noqa: E402
import materials  # noqa: E402
import scenes  # noqa: E402
import sheet  # noqa: E402
import stage  # noqa: E402

SEEDS = (1, 2)


def arguments():
    parser = argparse.ArgumentParser(prog="scripts/cycles.sh", description=__doc__)
    parser.add_argument("--limpid", default="build/release/limpid", help="the program")
    parser.add_argument("--out", default="out/cycles", help="a folder for scenes, pictures and the table")
    parser.add_argument("--only", action="append", default=[], metavar="SCENE", help="this scene; may be repeated")
    parser.add_argument("--quality", type=float, default=1.0, help="times as many samples")
    parser.add_argument("--check", action="store_true",
                        help="exit 1 if a scene in which nothing is known to differ is off by more than 1 %%")
    given = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    unknown = [name for name in given.only if name not in scenes.SCENES]
    if unknown:
        parser.error(f"there is no scene {unknown[0]}; there are {', '.join(scenes.SCENES)}")
    return given


def aside(path):
    """What Blender prints goes to a file from now on; what is to be read goes to the stream returned."""
    report = os.fdopen(os.dup(1), "w")
    with open(path, "wb") as log:
        os.dup2(log.fileno(), 1)
    return report


def merge(target, fields):
    for key, value in fields.items():
        if isinstance(value, dict):
            merge(target.setdefault(key, {}), value)
        else:
            target[key] = value


def export(folder):
    """scene.gltf by Blender's exporter; W/sr as candela, W/m^2 as lux, and what materials.GLTF adds."""
    path = os.path.join(folder, "scene.gltf")
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLTF_SEPARATE", export_cameras=True, export_lights=True,
                              convert_lighting_mode="COMPAT", export_animations=False, export_yup=True)
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    for material in document.get("materials", []):
        fields = materials.GLTF.get(material["name"], {})
        merge(material, fields)
        used = document.setdefault("extensionsUsed", [])
        used += [name for name in fields.get("extensions", {}) if name not in used]
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    return path


def render_cycles(path, settings, samples, seed):
    scene = bpy.context.scene
    cycles = scene.cycles
    cycles.samples, cycles.seed = samples, seed
    # Cycles counts the bounces after the first surface.
    for limit in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "volume_bounces"):
        setattr(cycles, limit, settings.bounces - 1)
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return images.read_picture(path)


def limpid(command):
    """Runs it; its standard output."""
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit {result.returncode}\n{result.stderr}")
    return result.stdout


def render_limpid(given, path, gltf, settings, samples, seed):
    light = (["--env", settings.environment] if settings.environment else
             ["--background", ",".join(str(c) for c in settings.background)])
    limpid([given.limpid, "render", gltf, "-o", path, "--float", "--device", "cpu",
            "--width", str(scenes.WIDTH), "--height", str(settings.height),
            "--spp", str(samples), "--seed", str(seed), "--max-depth", str(settings.bounces), *light])
    return images.read_picture(path)


def compared(given, folder, name, test, reference):
    """relMSE and FLIP of two pictures, by `limpid compare`."""
    paths = [os.path.join(folder, f"{name}.{which}.exr") for which in ("limpid", "cycles")]
    for path, picture in zip(paths, (test, reference)):
        images.save_picture(path, picture)
    values = json.loads(limpid([given.limpid, "compare", "--json", *paths]))
    return values["relmse"], values["flip"]


def run(given, name):
    """Renders one scene by both, with both seeds."""
    folder = os.path.abspath(os.path.join(given.out, name))
    os.makedirs(folder, exist_ok=True)
    stage.empty()
    materials.clear()
    settings = scenes.SCENES[name](folder)
    stage.size(scenes.WIDTH, settings.height)
    if not settings.environment:
        stage.background(settings.background)
    gltf = export(folder)
    materials.use_cycles_nodes()
    if settings.for_cycles:
        settings.for_cycles()
    samples = max(1, round(settings.samples * given.quality))

    def named(renderer, seed):
        return os.path.join(folder, f"{renderer}.{seed}.exr")

    test = [render_limpid(given, named("limpid", seed), gltf, settings, samples, seed) for seed in SEEDS]
    reference = [render_cycles(named("cycles", seed), settings, samples, seed) for seed in SEEDS]
    return settings, samples * len(SEEDS), test, reference


def measure(given, name):
    """A row of the table, the strips' ratios, and the two pictures."""
    settings, samples, test, reference = run(given, name)
    folder = os.path.join(given.out, name)
    pictures = figures.mean_pictures(test, reference)
    mean = figures.ratio(test, reference)
    relmse, flip = compared(given, folder, "mean", *pictures)
    noise = compared(given, folder, "noise", *figures.noise_pictures(test, reference))
    number = list(scenes.SCENES).index(name) + 1
    row = (number, name, samples, mean, relmse, noise[0], flip, noise[1])
    ratios = figures.strip_ratios(test, reference, max(1, len(settings.strips)))
    return settings, row, dict(zip(settings.strips, ratios)), pictures


def main():
    given = arguments()
    os.makedirs(given.out, exist_ok=True)
    report = aside(os.path.join(given.out, "blender.log"))
    rows, details, tiles, failed = [], [], [], []
    for name in given.only or scenes.SCENES:
        settings, row, strips, pictures = measure(given, name)
        rows.append(row)
        tiles.append(sheet.tile(row[0], *pictures))
        if strips:
            parts = ", ".join(f"{k}: {r.value:.4f} ± {r.error:.4f}" for k, r in strips.items())
            details.append(f"- `{name}`: {parts}")
        if settings.exact and any(r.deviates() for r in (row[3], *strips.values())):
            failed.append(name)
        print(figures.table(rows[-1:]).splitlines()[-1], *details[-1:] if strips else [], sep="\n", file=report,
              flush=True)
    text = figures.table(rows) + "\n\n" + "\n".join(details) + "\n"
    with open(os.path.join(given.out, "table.md"), "w", encoding="utf-8") as file:
        file.write(text)
    images.save_picture(os.path.abspath(os.path.join(given.out, "cycles.jpg")), sheet.contact(tiles), "JPEG")
    print("\n" + text, file=report, flush=True)
    if given.check and failed:
        print(f"Off by more than 1 %: {', '.join(failed)}", file=sys.stderr)
        sys.exit(1)


main()
