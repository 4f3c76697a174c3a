"""Rendering and comparing pictures. Uses the extension module limpid._renderer."""

import numpy as np

from limpid import _arrays, _camera
from limpid._denoising import text_of
from limpid._devices import SharedDevices, handle_of, own, watched

try:
    from limpid import _renderer
except ImportError as error:
    _renderer, _missing = None, error


def _module():
    if _renderer is None:
        message = "limpid was built without its renderer: limpid.render and limpid.compare are missing"
        raise ImportError(message) from _missing
    return _renderer


class _Device:
    def __init__(self, select):
        own(self, _module().Device(select))


_devices = SharedDevices(_Device)

#: Options of _Renderer that render() does not take.
OF_SEQUENCES = ("fps", "frames", "animation", "camera_path", "shutter", "shutter_position")


def compare(test, reference, *, exposure="auto"):
    """Measures the difference between a picture and its reference.

    test, reference: (height, width, 3), linear radiance, float16, float32 or float64.
    exposure: stops for psnr, ssim and flip, which compare display-encoded pictures: exposed, clamped to [0, 1] and
        sRGB-encoded. "auto" scales the reference's average luminance to 0.18.

    Returns a dict:
    psnr: in dB, infinite for equal pictures.
    ssim: 1 for equal pictures.
    flip: mean LDR-FLIP at 67 pixels per degree, 0 to 1, 0 for equal pictures.
    relmse: mean((test - reference)^2 / (reference^2 + 0.01)) of linear values, without exposure.
    exposure: the stops that were applied.
    invalid_pixels: number of pixels of the test picture with a NaN or an infinity. They count as the largest error.

    Raises limpid.Error if the reference has invalid pixels.
    """
    reference = _arrays.image("reference", reference, (3, 4))
    test = _arrays.image("test", test, (3, 4), reference.shape[:2])
    if exposure != "auto" and not -60.0 <= float(exposure) <= 60.0:
        raise ValueError(f"exposure: {exposure!r} is neither 'auto' nor a number of stops from -60 to 60")
    pictures = (np.ascontiguousarray(picture[:, :, :3]) for picture in (test, reference))
    return _module().compare(*pictures, None if exposure == "auto" else float(exposure))


def render(scene, width, height, spp=64, **options):
    """Path-traces a still of a scene and returns a dict of arrays.

    scene: path of a .gltf, .glb or .obj file, or "builtin:" followed by a name that builtin_scenes() lists.
    width, height: size in pixels. spp: samples per pixel.

    Options:
    seed: of the random numbers; default: 0. The same seed gives the same picture on the same device.
    denoiser: None, "temporal", "atrous", "svgf", "nano", "film", "bilateral" or "kpcn": denoises the picture that is
        returned as "color".
    parameters: a dict of names and values, such as {"pathtrace.max_depth": 4}; `limpid info` lists them.
    device: as in limpid.Denoiser.
    environment: path of an equirectangular .hdr or .exr.
    camera: name or number of one of the scene's cameras; default: the first.
    eye, target, fov: a camera instead of the scene's: two points of three numbers each, and the vertical field of view
        in degrees.
    jitter: where rays go through their pixels: "pixel" (anywhere), "frame" (at one point, the same for all pixels) or
        "off" (the centre). Default with a denoiser: "pixel" for "kpcn", else "off". Default without one: "off" for
        sequences without motion blur, else "pixel".
    weights: weight file for "kpcn", instead of the one that comes with Limpid.
    asset_root: files that the scene refers to must lie in this folder or in the scene's own; default: the parent of
        the scene's folder.

    Arrays are float32 unless stated otherwise, with row 0 at the top:
    color: (h, w, 3), linear radiance, denoised if there is a denoiser.
    diffuse, specular, emission: (h, w, 3). Without a denoiser, color is their sum.
    albedo, albedo_specular: (h, w, 3).
    normal, previous_normal: (h, w, 3), world space, 0 where nothing is hit.
    depth: (h, w), distance from the eye, world units, 1e10 where nothing is hit.
    motion, reflection_motion: (h, w, 3), previous minus current position: x and y in pixels, z in world units. 1e10
        where there is none.
    roughness: (h, w). hit_distance: (h, w), length of reflected rays, world units; 1e9: to the sky, 0: unknown.
    id: (h, w) uint32, the object's number plus one; 0 where nothing is hit.
    diffuse_variance, specular_variance, albedo_variance, normal_variance, depth_variance: (h, w), variance of the
        mean, 0 for one sample.
    view, projection: (4, 4) float64, the camera's matrices.

    Denoiser.denoise() accepts these arrays as they are, with motion_depth="distance".
    """
    for name in OF_SEQUENCES:
        if name in options:
            raise TypeError(f"render() makes a still: {name} is an option of render_sequence()")
    return _Renderer(scene, width, height, spp, default_jitter="pixel", **options).render(0)


def render_sequence(scene, width, height, frames, spp=1, *, first=0, fps=30.0, animation=None, camera_path=None,
                    shutter=0.0, shutter_position="center", **options):
    """Path-traces the frames of a moving scene. A generator that yields for each frame what render() returns.

    frames: number of frames. first: the first of them that is rendered. fps: frames per second.
    animation: name or number of one of the scene's clips, "all", or "none" for a static scene; default: the first
        clip, if there is one.
    camera_path: "orbit", "dolly", "shake", or a JSON file (docs/animation.md).
    shutter: motion blur: how long the shutter is open, in frames, 0 to 100; each sample sees another instant. Without a
        denoiser only. The camera's matrices are those at the frame's time.
    shutter_position: at the frame's time the shutter opens ("start"), is halfway ("center") or closes ("end").
    options: those of render(). A denoiser with a history keeps it from frame to frame.
    """
    first = _arrays.number("first", first, 0, 1000000)
    jitter = "pixel" if shutter else "off"  # blurred frames are not denoised later, sharp ones often are
    renderer = _Renderer(scene, width, height, spp, default_jitter=jitter, fps=fps, frames=frames, animation=animation,
                         camera_path=camera_path, shutter=shutter, shutter_position=shutter_position, **options)
    return (renderer.render(frame) for frame in range(first, frames))


def builtin_scenes():
    """Returns the built-in scenes: a dict from "builtin:..." to a one-line description."""
    return dict(_module().builtin_scenes())


class _Renderer:
    """Renders one scene on a device, and adds the camera's matrices to each frame."""

    def __init__(self, scene, width, height, spp, *, default_jitter, seed=0, denoiser=None, parameters=None,
                 device=None, environment=None, camera=None, eye=None, target=None, fov=None, jitter=None,
                 weights=None, asset_root=None, fps=30.0, frames=1, animation="none", camera_path=None, shutter=0.0,
                 shutter_position="center"):
        for name, value, least, most in (("width", width, 1, 65535), ("height", height, 1, 65535),
                                         ("spp", spp, 1, 1 << 24), ("frames", frames, 1, 1000000),
                                         ("seed", seed, 0, 2**32 - 1)):
            _arrays.number(name, value, least, most)
        if jitter is None:
            jitter = "" if denoiser else default_jitter
        path = _arrays.path
        options = _module().Options(
            scene=path("scene", scene), width=width, height=height, samples=spp, seed=seed, denoiser=_text(denoiser),
            assignments=[f"{name}={_arrays.setting(value)}" for name, value in (parameters or {}).items()],
            environment=path("environment", environment), camera=_text(camera), eye=_vector("eye", eye),
            target=_vector("target", target), fov=0.0 if fov is None else float(fov), jitter=str(jitter),
            weights=path("weights", weights), asset_root=path("asset_root", asset_root), fps=float(fps), frames=frames,
            animation=_text(animation), camera_path=path("camera_path", camera_path), shutter=float(shutter),
            shutter_position=str(shutter_position))
        with watched():
            own(self, _module().Renderer(handle_of(_devices.get(text_of(device))), options))

    def render(self, frame):
        with watched():
            layers, camera = self._handle.render(frame)
        if "hit_distance" in layers:  # 1e10 in files means unknown, but a ray into the sky for denoise()
            layers["hit_distance"][layers["hit_distance"] >= 1e10] = 0.0
        layers["view"], layers["projection"] = _camera.matrices_of(camera)
        return layers


def _text(value):
    return "" if value is None else str(value)


def _vector(name, value):
    with np.errstate(over="ignore"):  # what is too large for the library's floats becomes infinite
        array = np.asarray([] if value is None else value, np.float64).astype(np.float32)
    if array.shape not in ((0,), (3,)) or not np.isfinite(array).all():
        raise ValueError(f"{name}: needs three finite numbers, not {value!r}")
    return array.tolist()
