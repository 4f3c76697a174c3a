"""Limpid: denoisers and a path tracer for any Vulkan device, with NumPy arrays in and out.

denoise() denoises a still, Denoiser the frames of a sequence, and Network single frames with a trained network.
denoise_shot() cleans the files of any renderer. render() and render_sequence() path-trace a scene. compare() measures
the difference between a picture and its reference. docs/python.md has examples.
"""

from limpid._camera import look_at, perspective
from limpid._denoise import version as _version
from limpid._denoising import Denoiser, Device, Parameter, denoise, parameters
from limpid._error import Error
from limpid._network import Network
from limpid._rendering import builtin_scenes, compare, render, render_sequence
from limpid._shots import denoise_shot, explain_shot

__version__ = _version()
__all__ = [
    "Denoiser", "Device", "Error", "Network", "Parameter", "builtin_scenes", "compare", "denoise", "denoise_shot",
    "explain_shot", "look_at", "parameters", "perspective", "render", "render_sequence",
]

for _name in __all__:
    globals()[_name].__module__ = "limpid"
