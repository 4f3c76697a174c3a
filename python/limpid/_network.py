"""Denoising of single frames with a trained network. Uses the extension module limpid._neural."""

from limpid import _arrays
from limpid._denoising import parameter_value, parameters_of, text_of
from limpid._devices import own

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
    """Returns the network's parameters as a dict of limpid.Parameter by name."""
    return parameters_of(_module().parameters())


class Network:
    """A trained network, KPCN, that denoises single frames of about 32 samples per pixel (docs/kpcn.md).

    weights: path of a weight file; None: the weights that come with Limpid.
    device: text that chooses a device as limpid.Device does, or a limpid.Device. In both cases the network opens the
        device separately. None: the best one.
    parameters: a dict of names and values for set().

    Different threads may use different networks at the same time. Calls to one network wait for each other. The GIL is
    released while the device works. Ctrl+C ends denoise(), but the device still finishes that frame: the network waits
    for it before it does anything else, and when it is deleted.

    Raises limpid.Error if no device fits or the weights cannot be read, ImportError if Limpid was built without its
    network.
    """

    def __init__(self, weights=None, *, device=None, parameters=None):
        own(self, _module().Network(text_of(device), _arrays.path("weights", weights)))
        for name, value in (parameters or {}).items():
            self.set(name, value)

    def __repr__(self):
        return f"<limpid.Network on {self.device_name!r}, {self.precision}>"

    @property
    def device_name(self):
        """The device's name, as the driver reports it."""
        return self._handle.device_name()

    @property
    def precision(self):
        """How the network is computed, for example "half precision, cooperative matrices"."""
        return self._handle.precision()

    def denoise(self, diffuse, normal, depth, *, diffuse_variance, specular=None, specular_variance=None,
                emission=None, albedo=None, albedo_variance=None, normal_variance=None, depth_variance=None,
                samples=32):
        """Denoises one frame by itself and returns the denoised picture, (height, width, 3) float32.

        Images are arrays as in Denoiser.denoise(), and means over a pixel's samples. Variances, (h, w), are those of
        the means: s^2 / N for N samples with the variance s^2. limpid.render() returns all of these inputs under the
        same names.

        diffuse: (h, w, 3), linear diffuse light including albedo; all light if specular is not given.
        normal: (h, w, 3), world space, -1 to 1; 0 where nothing is hit.
        depth: (h, w), distance from the eye, world units. Where nothing is hit: 0 or below, not finite, or at least
            1e9.
        diffuse_variance, specular_variance: variances of the luminance.
        specular: (h, w, 3), specular light; needs specular_variance.
        emission: (h, w, 3), light of emitters and sky that the camera sees directly. It is added unfiltered.
        albedo: (h, w, 3), diffuse albedo from 0 to 1 including textures, which then stay sharp. Default: 1.
        albedo_variance, normal_variance, depth_variance: variance of the luminance, mean variance of the components,
            variance of the distance. Default: 0, as if all rays went through the pixels' centres.
        samples: samples per pixel. With fewer than 8, variances are too imprecise for "kpcn.errors", which is then
            off.

        A NaN or an infinity counts as 0.

        Raises ValueError, naming the argument, if a shape or type is wrong; limpid.Error if the library fails.
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
        """Returns the parameters that set() accepts, as a dict of limpid.Parameter by name."""
        return parameters()

    def set(self, name, value):
        """Sets a parameter from the next frame on. Raises limpid.Error if no parameter has this name, or if the value
        is outside its range. "kpcn.half" and "kpcn.cis565" reload the weights."""
        self._handle.set(name, float(value))

    def get(self, name):
        """Returns the value of a parameter, as bool, int or float."""
        value = self._handle.get(name)
        return parameter_value(self.parameters()[name].type, value)
