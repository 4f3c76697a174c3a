"""Denoising of stills and sequences."""

from typing import NamedTuple

import numpy as np

from limpid import _arrays, _camera, _denoise
from limpid._devices import SharedDevices, handle_of, own, watched

# The accepted component counts of images that may have more components than are read.
_COMPONENTS = {
    "radiance": (3, 4), "specular": (3, 4), "emission": (3, 4), "albedo": (3, 4), "albedo_specular": (3, 4),
    "depth": (1,), "roughness": (1,), "hit_distance": (1,), "radiance_variance": (1,), "specular_variance": (1,),
}
# The library's floats have 32 bits. Round so that Python prints 0.2, not 0.20000000298.
_TYPES = {"bool": bool, "int": int, "float": lambda value: float(str(np.float32(value)))}


class Parameter(NamedTuple):
    """A parameter of a denoising method."""

    name: str
    type: type
    default: object
    minimum: float
    maximum: float
    unit: str
    help: str


def parameters_of(rows):
    """Returns a dict of Parameter by name, from an extension module's list of (name, type, default, minimum, maximum,
    unit, help)."""
    result = {}
    for name, kind, default, *rest in rows:
        default = _TYPES[kind](default)
        result[name] = Parameter(name, type(default), default, *rest)
    return result


def parameter_value(kind, number):
    """Converts a number from the library to bool, int or float."""
    return _TYPES[kind.__name__](number)


def parameters(method="svgf"):
    """Returns the parameters of a method as a dict of limpid.Parameter by name. `limpid info` lists the same ones.

    method: as in limpid.Denoiser, or "kpcn"."""
    if method == "kpcn":
        return _network().parameters()
    return parameters_of(_denoise.parameters(_arrays.choose("method", method, _denoise.METHODS)))


class Device:
    """A Vulkan device.

    select: None for the best device (discrete before integrated before CPU); "cpu" for a software device; text with a
        number for the device of that number; otherwise a part of its name, in upper or lower case.
    validation: lets Vulkan's validation layer check every call (slow); messages() returns its messages.

    Raises limpid.Error with the code "unsupported" if no device fits; its text lists the available devices.
    """

    def __init__(self, select=None, *, validation=False):
        self._select = "" if select is None else str(select)
        own(self, _denoise.Device(self._select, bool(validation)))

    def __repr__(self):
        return f"<limpid.Device {self.name!r}>"

    @property
    def name(self):
        """The device's name, as the driver reports it."""
        return self._handle.name()

    def messages(self):
        """Returns the messages of the library and the validation layer since the last call: a list of (level, text).
        The level is "debug", "info", "warning" or "error"."""
        return self._handle.messages()

    def pipeline_cache(self):
        """Returns what the driver has compiled so far, as bytes. Store them for load_pipeline_cache()."""
        return self._handle.pipeline_cache()

    def load_pipeline_cache(self, data):
        """Loads bytes that pipeline_cache() returned in an earlier run, so that the driver need not compile again.
        Call it before the first denoiser is made. Bytes from another device or driver, and damaged ones, are
        ignored."""
        self._handle.load_pipeline_cache(bytes(memoryview(data)))  # bytes(5) would be five zeros


_devices = SharedDevices(Device)


def text_of(choice):
    """Returns the text that chooses a device. For a Device that is what it was made with: several may have its name."""
    if isinstance(choice, Device):
        return choice._select
    return "" if choice is None else str(choice)


def _device_of(choice):
    """Returns `choice` if it is a Device, else a device that is shared by all calls with the same text."""
    return choice if isinstance(choice, Device) else _devices.get(text_of(choice))


class Denoiser:
    """Denoises the frames of a sequence, each with the help of the previous ones.

    width, height: size of all images in pixels, 1 to 32768.
    method: "svgf" (spatiotemporal variance-guided filtering), "nano" (SVGF and a small trained network: closer to the
        truth, slower), "film" (the same with a larger network: for stills and films), "atrous" (temporal accumulation,
        then the edge-avoiding a-trous filter), "temporal" (temporal accumulation alone), "bilateral" (a joint bilateral
        filter of one frame, without history: the simplest), or "visibility" (for ambient occlusion or a shadow mask:
        the first component of radiance, 0 to 1; the result is grey).
    device: a limpid.Device, or text that chooses one as limpid.Device does; None: the best one.
    signals: 1: radiance is all light that is to be filtered; 2: radiance is diffuse light, and specular light is given
        separately.
    demodulated: True if radiance is divided by albedo; the result then is, too.
    normal_encoding: "signed" (xyz, -1 to 1), "unorm" (xyz, mapped to 0 to 1), "octahedral_signed" (xy, -1 to 1), or
        "octahedral_unorm" (xy, mapped to 0 to 1).
    normal_space: "world" or "view" (the space of the frame's view matrix).
    depth_encoding: "distance" (from the eye along the pixel's ray, world units), "linear" (along the view axis, world
        units), or "device" (values of the depth buffer, 0 to 1, by the projection matrix).
    far_depth: depths of this value and beyond mean that nothing is hit; not with "device". World units.
    motion_unit: "pixels", "uv" (the picture is 1 wide and high, v points down) or "ndc" (it is 2 wide and high).
    motion_direction: "to_previous" (previous minus current position) or "from_previous".
    motion_depth: "2d" (only x and y are used, and points are assumed not to move in depth) or "distance" (z is the
        change of the distance from the eye, world units).
    clip_y: the direction of y in clip space: "down" as in Vulkan, "up" as in OpenGL and Direct3D.
    samples: samples per pixel in each frame's light, 1 to 65536; only counts for frames with radiance_variance.
    timings: True to measure the passes' times (see timings()).
    parameters: a dict of names and values for set().

    Different threads may use different denoisers at the same time. Calls to one denoiser wait for each other. The GIL
    is released while the device works.
    """

    def __init__(self, width, height, method="svgf", *, device=None, signals=1, demodulated=False,
                 normal_encoding="signed", normal_space="world", depth_encoding="distance", far_depth=1e9,
                 motion_unit="pixels", motion_direction="to_previous", motion_depth="2d", clip_y="down", samples=1,
                 timings=False, parameters=None):
        for name, value in (("width", width), ("height", height)):
            _check_side(name, value)
        if signals not in (1, 2):
            raise ValueError(f"signals: must be 1 or 2, not {signals!r}")
        if not far_depth > 0.0:
            raise ValueError(f"far_depth: {far_depth!r} is not above 0")
        samples = _arrays.number("samples", samples, 1, 65536)
        choose = _arrays.choose
        description = _denoise.Description(
            method=choose("method", method, _denoise.METHODS), width=width, height=height, signals=signals,
            demodulated=bool(demodulated),
            normal_encoding=choose("normal_encoding", normal_encoding, _denoise.NORMAL_ENCODINGS),
            normal_space=choose("normal_space", normal_space, _denoise.NORMAL_SPACES),
            depth_encoding=choose("depth_encoding", depth_encoding, _denoise.DEPTH_ENCODINGS),
            far_depth=far_depth,
            motion_unit=choose("motion_unit", motion_unit, _denoise.MOTION_UNITS),
            motion_direction=choose("motion_direction", motion_direction, _denoise.MOTION_DIRECTIONS),
            motion_depth=choose("motion_depth", motion_depth, _denoise.MOTION_DEPTHS),
            clip_y=choose("clip_y", clip_y, _denoise.CLIP_Y), timings=bool(timings), samples=samples)
        self._method = method
        self._device = _device_of(device)
        self._signals = signals
        self._samples = samples
        self._clip_y = clip_y
        self._needs_projection = depth_encoding == "device"
        normal_components = (2, 3, 4) if normal_encoding.startswith("octahedral") else (3, 4)
        motion_components = (3, 4) if motion_depth == "distance" else (2, 3, 4)
        self._components = dict(_COMPONENTS, normal=normal_components, previous_normal=normal_components,
                                motion=motion_components, reflection_motion=motion_components)
        self._components["radiance"] = _radiance_components(method)
        self._camera = None  # of the previous frame
        with watched():
            own(self, _denoise.Denoiser(handle_of(self._device), description))
        for name, value in (parameters or {}).items():
            self.set(name, value)

    def __repr__(self):
        return f"<limpid.Denoiser {self.method!r} {self.width} x {self.height} on {self.device.name!r}>"

    @property
    def width(self):
        """Width of all images in pixels."""
        return self._handle.width

    @property
    def height(self):
        """Height of all images in pixels."""
        return self._handle.height

    @property
    def method(self):
        """The method's name."""
        return self._method

    @property
    def device(self):
        """The limpid.Device that it runs on."""
        return self._device

    def denoise(self, radiance, normal, depth, *, specular=None, emission=None, albedo=None, albedo_specular=None,
                motion=None, previous_normal=None, reflection_motion=None, roughness=None, hit_distance=None,
                radiance_variance=None, specular_variance=None, id=None, view=None, projection=None,
                previous_view=None, previous_projection=None, jitter=(0.0, 0.0), reset=False, outputs="color"):
        """Denoises the next frame of the sequence and returns the denoised picture, (height, width, 3) float32.

        All images are arrays (height, width, components) of float16, float32 or float64; row 0 is the top. float32
        arrays, and slices of them, are not copied if a pixel's components are adjacent in memory and no axis is
        reversed.

        radiance: (h, w, 3), linear light scattered towards the eye; with two signals only the diffuse light. With the
            method "visibility" also (h, w): the mask.
        normal: (h, w, 3); (h, w, 2) if octahedral.
        depth: (h, w). Where nothing is hit: 0 or below, not finite, or at least far_depth.
        specular: (h, w, 3), specular light; required with two signals.
        emission: (h, w, 3), light of emitters and sky that the camera sees directly. It is added unfiltered.
        albedo: (h, w, 3), diffuse albedo from 0 to 1 including textures, which then stay sharp.
        albedo_specular: (h, w, 3), pre-integrated reflectance of the specular lobe, 0 to 1.
        motion: (h, w, 2 or 3), in the denoiser's motion_unit and so on. Without it, only the camera moves.
        previous_normal: like normal, of the same surface point in the previous frame.
        reflection_motion: like motion, of the image that the surface reflects.
        roughness: (h, w), roughness of the specular lobe, 0 to 1.
        hit_distance: (h, w), length of the ray that found the specular light, from the surface to its first hit, world
            units; 1e9 or more: it hit nothing; 0: unknown. Needs roughness. Without reflection_motion, the motion of
            reflections is computed from it.
        radiance_variance: (h, w), variance of the radiance's luminance: of the pixel's mean, that of its samples divided
            by their number, which the denoiser must have been told (samples). "svgf", "nano" and "film" take the noise
            of a history's first frames from it; other methods ignore it.
        specular_variance: (h, w), the same of specular; with two signals, both or none.
        id: (h, w), integers from 0 to 2^24, one for each object.
        view, projection: (4, 4), from world to view space and from view to clip space (depth 0 to 1), without jitter.
            Points are column vectors; look_at() and perspective() return such matrices. Without view, the camera is at
            the origin and looks along -z; without projection, a field of view of 60 degrees is assumed.
        previous_view, previous_projection: those of the previous frame; default: the previous call's matrices.
        jitter: (x, y), offset of the rays from the pixels' centres, -0.5 to 0.5 pixels.
        reset: True after a cut: ignores the history.
        outputs: "color" for the picture including emission and albedo. A sequence of names gives a dict of arrays
            instead: "color", and for "svgf", "nano" and "film" "radiance" and "specular", the filtered inputs of
            these names.

        Raises ValueError, naming the argument, if a shape or type is wrong; limpid.Error if the library fails.
        """
        images = {"radiance": radiance, "specular": specular, "emission": emission, "albedo": albedo,
                  "albedo_specular": albedo_specular, "normal": normal, "depth": depth, "motion": motion,
                  "previous_normal": previous_normal, "reflection_motion": reflection_motion,
                  "roughness": roughness, "hit_distance": hit_distance,
                  "radiance_variance": radiance_variance, "specular_variance": specular_variance}
        if self._signals == 2 and specular is None:
            raise ValueError("specular: is needed with two signals")
        if self._signals == 1 and specular is not None:
            raise ValueError("specular: is for denoisers of two signals; add it to radiance")
        if hit_distance is not None and roughness is None:
            raise ValueError("roughness: is needed with hit_distance")
        if radiance_variance is not None and self._samples < 2:
            raise ValueError("radiance_variance: the denoiser needs samples of 2 or more")
        if self._signals == 2 and (radiance_variance is None) != (specular_variance is None):
            missing = "radiance_variance" if radiance_variance is None else "specular_variance"
            raise ValueError(f"{missing}: is needed with the other signal's variance")
        if self._signals == 1 and specular_variance is not None:
            raise ValueError("specular_variance: is for denoisers of two signals; add it to radiance_variance")
        names = (outputs,) if isinstance(outputs, str) else tuple(outputs)
        numbers = [_arrays.choose("outputs", name, _denoise.OUTPUTS) for name in names]
        matrices, now = self._matrices(view, projection, previous_view, previous_projection)
        inputs, point = self._inputs(images, id), _point("jitter", jitter)
        with watched():
            results = self._handle.denoise(inputs, numbers, matrices, point, bool(reset))
        self._camera = now
        return results[0] if isinstance(outputs, str) else dict(zip(names, results))

    def _inputs(self, images, id):
        size = (self.height, self.width)
        inputs = []
        for name, value in images.items():
            if value is not None:
                inputs.append((_denoise.INPUTS[name], _arrays.image(name, value, self._components[name], size)))
            elif name in ("radiance", "normal", "depth"):
                raise ValueError(f"{name}: is needed")
        if id is not None:
            inputs.append((_denoise.INPUTS["id"], _arrays.identifiers("id", id, size)))
        return inputs

    def _matrices(self, view, projection, previous_view, previous_projection):
        """Returns the four matrices in column-major order for the library, and this frame's two as they are."""
        if projection is None and self._needs_projection:
            raise ValueError("projection: is needed with depth_encoding='device'")
        view = np.eye(4) if view is None else _arrays.matrix("view", view)
        if projection is None:
            projection = _camera.perspective(60.0, self.width / self.height, clip_y=self._clip_y)
        projection = _arrays.matrix("projection", projection)
        before = self._camera or (view, projection)
        previous = [before[0] if previous_view is None else _arrays.matrix("previous_view", previous_view),
                    before[1] if previous_projection is None
                    else _arrays.matrix("previous_projection", previous_projection)]
        stacked = np.stack([view, projection, *previous]).transpose(0, 2, 1)
        return np.ascontiguousarray(stacked, np.float32), (view, projection)

    @watched()
    def reset(self):
        """Discards the history, as after a cut: the next frame starts anew."""
        self._handle.reset()

    @watched()
    def resize(self, width, height):
        """Sets the size of the following frames in pixels. Discards the history."""
        for name, value in (("width", width), ("height", height)):
            _check_side(name, value)
        self._handle.resize(width, height)

    def parameters(self):
        """Returns the parameters that set() accepts, as a dict of limpid.Parameter by name."""
        return parameters(self._method)

    @watched()
    def set(self, name, value):
        """Sets a parameter from the next frame on. Raises limpid.Error if no parameter has this name, or if the value
        is outside its range or a fraction for an int or a bool."""
        self._handle.set(name, float(value))

    @watched()
    def get(self, name):
        """Returns the value of a parameter, as bool, int or float."""
        value = self._handle.get(name)
        return parameter_value(self.parameters()[name].type, value)

    @watched()
    def timings(self):
        """Returns a dict from the passes of the latest frame, in order, to their milliseconds on the device. Empty
        unless the denoiser was made with timings=True."""
        return dict(self._handle.timings())


def _network():
    from limpid import _network as module  # not at the top, since it imports this module

    return module


def _radiance_components(method):
    return (1, 3, 4) if method == "visibility" else _COMPONENTS["radiance"]


def _check_side(name, value):
    if not isinstance(value, (int, np.integer)) or not 1 <= value <= 32768:
        raise ValueError(f"{name}: {value!r} is not a number of pixels from 1 to 32768")


def _point(name, value):
    array = np.asarray(value, np.float64)
    if array.shape != (2,):
        raise ValueError(f"{name}: needs two numbers, x and y")
    return float(array[0]), float(array[1])


def denoise(radiance, normal, depth, *, specular=None, emission=None, albedo=None, albedo_specular=None,
            radiance_variance=None, specular_variance=None, id=None, view=None, projection=None, jitter=(0.0, 0.0),
            outputs="color", method="svgf", device=None, **options):
    """Denoises one still and returns the denoised picture, (height, width, 3) float32.

    Images are those of Denoiser.denoise(); if specular is given, there are two signals. `options` are those of
    limpid.Denoiser. For sequences use a limpid.Denoiser, which accumulates over frames.

    method: one of limpid.Denoiser's, or "kpcn", the trained network for stills of about 32 samples per pixel. For
    "kpcn", `options` are those of limpid.Network and the variances and samples of its denoise(); radiance is its
    diffuse light, radiance_variance the variance of that; albedo_specular, id, the cameras and jitter are ignored. Every call loads the weights, so make a
    limpid.Network for several stills.
    """
    if method == "kpcn":
        if outputs != "color":
            raise ValueError(f"outputs: {outputs!r} is none of 'color', all that 'kpcn' has")
        if radiance_variance is not None:
            options.setdefault("diffuse_variance", radiance_variance)
        network = _network().Network(options.pop("weights", None), device=device,
                                     parameters=options.pop("parameters", None))
        return network.denoise(radiance, normal, depth, specular=specular, emission=emission, albedo=albedo,
                               specular_variance=specular_variance, **options)
    size = _arrays.image("radiance", radiance, _radiance_components(method)).shape
    denoiser = Denoiser(size[1], size[0], method, device=device, signals=1 if specular is None else 2, **options)
    return denoiser.denoise(radiance, normal, depth, specular=specular, emission=emission, albedo=albedo,
                            albedo_specular=albedo_specular, radiance_variance=radiance_variance,
                            specular_variance=specular_variance, id=id, view=view, projection=projection,
                            jitter=jitter, outputs=outputs)
