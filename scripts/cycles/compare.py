"""Builds test scenes in Blender, renders them with Cycles and with Limpid, and compares. Run by scripts/cycles.sh."""

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

SEEDS = (0x1F123BB5, 0x6C078965)  # Cycles mixes its seed weakly: with 1 and 2, the noise is correlated


def arguments():
    parser = argparse.ArgumentParser(prog="scripts/cycles.sh", description=__doc__)
    parser.add_argument("--limpid", default="build/release/limpid", help="path of the program limpid")
    parser.add_argument("--out", default="out/cycles", help="folder for scenes, pictures and the table")
    parser.add_argument("--only", action="append", default=[], metavar="SCENE",
                        help="run only this scene; may be repeated")
    parser.add_argument("--quality", type=float, default=1.0, help="factor for the number of samples")
    parser.add_argument("--check", action="store_true",
                        help="exit with 1 if a scene without known differences deviates by more than 1 %%")
    given = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    unknown = [name for name in given.only if name not in scenes.SCENES]
    if unknown:
        parser.error(f"there is no scene {unknown[0]}; there are {', '.join(scenes.SCENES)}")
    return given


def aside(path):
    """Redirects standard output, and so what Blender prints, to a file. Returns a stream to the original one."""
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
    """Exports scene.gltf and adds the fields of materials.GLTF. Light is exported with W/sr as candela and W/m^2 as
    lux."""
    path = os.path.join(folder, "scene.gltf")
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLTF_SEPARATE", export_cameras=True, export_lights=True,
                              convert_lighting_mode="COMPAT", export_animations=True, export_yup=True)
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
    # Cycles does not count the first surface as a bounce.
    for limit in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "volume_bounces"):
        setattr(cycles, limit, settings.bounces - 1)
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return images.read_picture(path)


def limpid(command):
    """Runs a command and returns its standard output."""
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit {result.returncode}\n{result.stderr}")
    return result.stdout


def render_limpid(given, path, gltf, settings, samples, seed):
    light = (["--env", settings.environment] if settings.environment else
             ["--background", ",".join(str(c) for c in settings.background)])
    limpid([given.limpid, "render", gltf, "-o", path, "--float", "--device", "cpu",
            "--width", str(scenes.WIDTH), "--height", str(settings.height),
            "--spp", str(samples), "--seed", str(seed), "--max-depth", str(settings.bounces), *light, *settings.options])
    return images.read_picture(path)


def compared(given, folder, name, test, reference):
    """Returns relMSE and FLIP of two pictures, computed by `limpid compare`."""
    paths = [os.path.join(folder, f"{name}.{which}.exr") for which in ("limpid", "cycles")]
    for path, picture in zip(paths, (test, reference)):
        images.save_picture(path, picture)
    values = json.loads(limpid([given.limpid, "compare", "--json", *paths]))
    return values["relmse"], values["flip"]


def run(given, name):
    """Renders one scene with both renderers, each with both seeds."""
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
        return os.path.join(folder, f"{renderer}.{SEEDS.index(seed) + 1}.exr")

    test = [render_limpid(given, named("limpid", seed), gltf, settings, samples, seed) for seed in SEEDS]
    reference = [render_cycles(named("cycles", seed), settings, samples, seed) for seed in SEEDS]
    return settings, samples * len(SEEDS), test, reference


def measure(given, name):
    """Renders and compares a scene. Returns the result, and writes it to result.json in the scene's folder."""
    settings, samples, test, reference = run(given, name)
    folder = os.path.join(given.out, name)
    relmse, flip = compared(given, folder, "mean", *figures.mean_pictures(test, reference))
    noise = compared(given, folder, "noise", *figures.noise_pictures(test, reference))
    strips = figures.strip_ratios(test, reference, len(settings.strips)) if settings.strips else []
    result = figures.Result(name, samples, figures.ratio(test, reference), relmse, noise[0], flip, noise[1],
                            dict(zip(settings.strips, strips)))
    result.save(os.path.join(folder, "result.json"))
    return result, settings.exact


def assemble(out):
    """Writes the table and the picture of all scenes with results in `out`, from this run or an earlier one."""
    results, tiles = [], []
    for number, name in enumerate(scenes.SCENES, 1):
        folder = os.path.join(os.path.abspath(out), name)
        if not os.path.exists(os.path.join(folder, "result.json")):
            continue
        results.append((number, figures.Result.load(os.path.join(folder, "result.json"))))
        pictures = [images.read_picture(os.path.join(folder, f"mean.{which}.exr")) for which in ("limpid", "cycles")]
        tiles.append(sheet.tile(number, *pictures))
    images.save_picture(os.path.join(os.path.abspath(out), "cycles.jpg"), sheet.contact(tiles), "JPEG")
    text = figures.table(results)
    with open(os.path.join(out, "table.md"), "w", encoding="utf-8") as file:
        file.write(text)
    return text


def main():
    given = arguments()
    os.makedirs(given.out, exist_ok=True)
    report = aside(os.path.join(given.out, "blender.log"))
    failed = []
    for name in given.only or scenes.SCENES:
        result, exact = measure(given, name)
        print(figures.line(list(scenes.SCENES).index(name) + 1, result), file=report, flush=True)
        if exact and result.deviates():
            failed.append(name)
    print("\n" + assemble(given.out), file=report, flush=True)
    if given.check and failed:
        print(f"Off by more than 1 %: {', '.join(failed)}", file=sys.stderr)
        sys.exit(1)


main()
