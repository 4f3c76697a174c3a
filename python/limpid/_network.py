"""Denoising of single frames by a trained network: what needs limpid._neural."""

import os

from limpid import _arrays
from limpid._denoising import Device, parameter_value, parameters_of

try:
    from limpid import _neural
except ImportError as error:
    _neural, _missing = None, error

_COLORS = ("diffuse", "specular", "emission", "albedo", "normal")


def _module():
    if _neural is None:
        message = "limpid was built without its network: limpid.Network and the method 'kpcn' are missing"
        raise ImportError(message) from _missing
    return _neural


def parameters():
    """Those of the network, by name: a dict of limpid.Parameter."""
    return parameters_of(_module().parameters())


class Network:
    """A trained network, KPCN, that denoises single frames of about 32 samples per pixel (docs/kpcn.md).

    weights: the path of a file of weights; None: those that come with Limpid.
    device: text that chooses a device as limpid.Device does, or a limpid.Device, which names one: the network opens it
        for itself. None: the best one.
    parameters: a mapping of names to values, as set() takes them.

    Several threads may use networks at once; calls to one network wait for each other. The GIL is released while the
    device works.

    Throws limpid.Error if no device fits or the weights cannot be read, ImportError if Limpid was built without its
    network.
    """

    def __init__(self, weights=None, *, device=None, parameters=None):
        select = device.name if isinstance(device, Device) else "" if device is None else str(device)
        self._handle = _module().Network(select, "" if weights is None else os.fspath(weights))
        for name, value in (parameters or {}).items():
            self.set(name, value)

    def __repr__(self):
        return f"<limpid.Network on {self.device_name!r}, {self.precision}>"

    @property
    def device_name(self):
        """The device, as its driver calls it."""
        return self._handle.device_name()

    @property
    def precision(self):
        """How the network is computed: "half precision, cooperative matrices", "single precision, oneDNN"."""
        return self._handle.precision()

    def denoise(self, diffuse, normal, depth, *, diffuse_variance, specular=None, specular_variance=None,
                emission=None, albedo=None, albedo_variance=None, normal_variance=None, depth_variance=None,
                samples=32):
        """Denoises one frame by itself and returns the clean picture, (height, width, 3) float32.

        Images are arrays as Denoiser.denoise() takes them: means over a pixel's samples. Variances, (h, w), are those
        of the means: of N samples with the variance s^2, s^2 / N. limpid.render() returns all of them under these
        names.

        diffuse: (h, w, 3), linear: diffuse light, textures in it. All light, if specular is not given.
        normal: (h, w, 3), world space, -1 to 1; 0 where there is none.
        depth: (h, w), distance from the eye, world units. Where nothing is seen: 0 or below, not finite, or from 1e9
            on.
        diffuse_variance, specular_variance: of the luminance.
        specular: (h, w, 3), specular light; specular_variance goes with it.
        emission: (h, w, 3): what the camera sees directly (emitters, sky); it is added, and not filtered.
        albedo: (h, w, 3), diffuse albedo, 0 to 1, textures in it: they stay sharp. Default: 1.
        albedo_variance, normal_variance, depth_variance: of the luminance, the components' mean, the distance.
            Default: 0, as where all rays go through the pixels' centres.
        samples: per pixel. Of fewer than 8 the variances are too rough for "kpcn.errors", which is then off.

        A NaN or an infinity counts as 0.

        Throws ValueError naming the argument whose shape or type is wrong, limpid.Error if the library fails.
        """
        images = {"diffuse": diffuse, "specular": specular, "emission": emission, "albedo": albedo, "normal": normal,
                  "depth": depth, "diffuse_variance": diffuse_variance, "specular_variance": specular_variance,
                  "albedo_variance": albedo_variance, "normal_variance": normal_variance,
                  "depth_variance": depth_variance}
        needed = ["diffuse", "normal", "depth", "diffuse_variance"]
        if specular is not None:
            needed.append("specular_variance")
        for name in needed:
            if images[name] is None:
                raise ValueError(f"{name}: is needed")
        if not 1 <= samples < 2**32:
            raise ValueError(f"samples: {samples!r} is not a number from 1 on")
        size = _arrays.image("diffuse", diffuse, (3, 4)).shape[:2]
        inputs = [(_neural.INPUTS[name], _arrays.image(name, value, (3, 4) if name in _COLORS else (1,), size))
                  for name, value in images.items() if value is not None]
        return self._handle.denoise(size[1], size[0], int(samples), inputs)

    def parameters(self):
        """What can be set, by name: a dict of limpid.Parameter."""
        return parameters()

    def set(self, name, value):
        """Sets a parameter from the next frame on. Throws limpid.Error if there is none of this name, or if the value
        is outside its range. "kpcn.half" and "kpcn.cis565" load the weights anew."""
        self._handle.set(name, float(value))

    def get(self, name):
        """The value of a parameter: a bool, int or float, as its type is."""
        value = self._handle.get(name)
        return parameter_value(self.parameters()[name].type, value)
