"""Denoising of files of any renderer. Uses the extension module limpid._shot."""

import contextlib
import numbers
import warnings

from limpid import _arrays
from limpid._denoising import text_of

try:
    from limpid import _shot
except ImportError as error:
    _shot, _missing = None, error


def _module():
    if _shot is None:
        message = "limpid was built without its programs: limpid.denoise_shot and limpid.explain_shot are missing"
        raise ImportError(message) from _missing
    return _shot


def _pairs(values):
    """{"albedo": "MyAlbedo.RGB"} as "albedo=MyAlbedo.RGB"."""
    return [f"{name}={_arrays.setting(value)}" for name, value in (values or {}).items()]


def _path_pairs(values):
    return [_arrays.path("files", name) + b"=" + _arrays.path(f"files[{name!r}]", value)
            for name, value in (values or {}).items()]


def _inputs(input, map, map_file, files, cameras, fps, camera_start, motion, frames, **rest):
    options = _module().Options()
    options.input = _arrays.path("input", input)
    options.map = _pairs(map)
    options.map_file = _arrays.path("map_file", map_file)
    options.files = _path_pairs(files)
    options.cameras = _arrays.path("cameras", cameras)
    options.fps, options.camera_start = float(fps), int(camera_start)
    options.motion = motion or "none"
    if frames is not None:
        first, last = (frames, frames) if isinstance(frames, numbers.Integral) else frames
        options.frames = f"{first:d}-{last:d}"
    for name, value in rest.items():
        setattr(options, name, value)
    return options


def explain_shot(input, *, map=None, map_file=None, files=None, cameras=None, fps=24.0, camera_start=0, motion="auto",
                 frames=None):
    """Returns several lines: how each layer of a shot's files is understood, what is missing and what that costs,
    where the camera is from, and how much of the change between two frames the motion explains.

    The arguments are those of denoise_shot().
    """
    return _module().explain(_inputs(input, map, map_file, files, cameras, fps, camera_start, motion, frames))


def denoise_shot(input, output, *, denoiser=None, preset=None, parameters=None, weights=None, map=None, map_file=None,
                 files=None, cameras=None, fps=24.0, camera_start=0, motion="auto", frames=None, shard=None,
                 cuts="auto", skip_unreadable=False, bidirectional=False, strength=1.0, preserve=0.0,
                 recover="auto", resume=False, exposure="auto", device=None, progress=None):
    """Denoises the frames of a shot of any renderer as `limpid denoise` does (docs/denoise-your-renders.md).

    input: path of a frame, or of all frames of a shot: "shot.%04d.exr". EXR, PFM, HDR or PNG.
    output: path of the results, with a number if the input has one. EXR: the input's files with a clean beauty; PNG: a
        tone-mapped picture.
    denoiser: "svgf" (default), "nano", "film", "atrous", "temporal", "bilateral" or "kpcn".
    preset: the settings of a paper or course, by name.
    parameters: a dict of names and values: {"svgf.alpha": 0.1}.
    weights: path of weights for "kpcn" instead of those that come with Limpid.
    map: a dict of what layers are: {"albedo": "MyAlbedo.RGB"}. map_file: path of a JSON file of the same.
    files: a dict of layers in files of their own: {"albedo": "albedo.%04d.pfm"}.
    cameras: path of a file of the frames' cameras: JSON, or glTF ("scene.glb#NAME" chooses one of its cameras).
    fps, camera_start: frames per second of the animation in a glTF file, and the frame at its time 0.
    motion: where files have no motion: "auto" searches it on albedo and normals, None denoises each frame alone.
    frames: the only frames to write: a number, or (first, last). Those around them make histories.
    shard: (2, 4) denoises only the second of four parts.
    cuts: "auto", or a list of the first frames after cuts, which may be empty.
    skip_unreadable: leaves out frames that are missing or cannot be read, with a warning, instead of raising an error.
    bidirectional: denoises forwards and backwards and merges both. Takes twice as long.
    strength: share of the clean picture in the result, above 0 to 1.
    preserve: share of what was filtered away, in the mean over 5x5 pixels, that is given back, 0 to 1: more detail and
        more noise.
    recover: "on" gives back what the filter took away besides noise, "off" does not; "auto": with "svgf",
        "nano" and "film", in files of Cycles and pbrt-v4, without a preset.
    resume: goes on after the last complete output. Only for EXR.
    exposure: of a PNG: stops, or "auto".
    device: text or number that chooses a device as limpid.Device does, or a limpid.Device. In both cases the device is
        opened separately. None: the best one.
    progress: is called for each frame with the numbers of finished frames and of all frames. An exception in it stops
        the run, and is raised; what is written is complete.

    Returns a dict: "frames" (written), "kept" (found complete, with `resume`), "skipped", "cuts" (numbers of them) and
    "seconds". What the command line would warn of becomes a UserWarning, also if the run fails.

    Raises limpid.Error: "invalid_argument" for a wrong option, "unreadable" for a file that cannot be read. The GIL is
    released while it works.
    """
    if not 0.0 < strength <= 1.0:
        raise ValueError(f"strength: {strength!r} is not above 0 and at most 1")
    options = _inputs(input, map, map_file, files, cameras, fps, camera_start, motion, frames,
                      output=_arrays.path("output", output), denoiser=denoiser or "", preset=preset or "",
                      settings=_pairs(parameters), weights=_arrays.path("weights", weights),
                      shard="" if shard is None else f"{shard[0]:d}/{shard[1]:d}",
                      cuts=cuts if isinstance(cuts, str) else ",".join(f"{c:d}" for c in cuts) or "none",
                      on_error="skip" if skip_unreadable else "stop", strength=float(strength),
                      preserve=float(preserve), recover=str(recover),
                      bidirectional=bool(bidirectional), resume=bool(resume), exposure=str(exposure))
    messages = []
    try:
        summary = _module().denoise(options, text_of(device), progress, messages)
    except BaseException:  # Ctrl+C, too
        for message in messages:
            with contextlib.suppress(Exception):  # where warnings are errors: this failure says more
                warnings.warn(message, stacklevel=2)
        raise
    for message in messages:
        warnings.warn(message, stacklevel=2)
    return summary
