import builtins
from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
__all__: list[str]

_Image = NDArray[np.float32]
_Matrix = NDArray[np.float64]
_Method = Literal["svgf", "atrous", "temporal", "bilateral", "visibility", "nano", "film"]
_StillMethod = Literal["svgf", "atrous", "temporal", "bilateral", "visibility", "nano", "film", "kpcn"]
_ShotMethod = Literal["svgf", "atrous", "temporal", "bilateral", "nano", "film", "kpcn"]
_Output = Literal["color", "radiance", "specular"]
_Path = str | bytes | PathLike[str] | PathLike[bytes]

class Error(RuntimeError):
    code: Literal["invalid_argument", "unsupported", "out_of_memory", "device_lost", "unreadable", "failed"]
    def __init__(self, message: str, code: str = "failed") -> None: ...

class Parameter(NamedTuple):
    name: str
    type: builtins.type[bool] | builtins.type[int] | builtins.type[float]
    default: bool | int | float
    minimum: float
    maximum: float
    unit: str
    help: str

class Device:
    def __init__(self, select: str | int | None = None, *, validation: bool = False) -> None: ...
    @property
    def name(self) -> str: ...
    def messages(self) -> list[tuple[str, str]]: ...
    def pipeline_cache(self) -> bytes: ...
    def load_pipeline_cache(self, data: bytes) -> None: ...

class Denoiser:
    def __init__(
        self,
        width: int,
        height: int,
        method: _Method = "svgf",
        *,
        device: Device | str | int | None = None,
        signals: Literal[1, 2] = 1,
        demodulated: bool = False,
        normal_encoding: Literal["signed", "unorm", "octahedral_signed", "octahedral_unorm"] = "signed",
        normal_space: Literal["world", "view"] = "world",
        depth_encoding: Literal["distance", "linear", "device"] = "distance",
        far_depth: float = 1e9,
        motion_unit: Literal["pixels", "uv", "ndc"] = "pixels",
        motion_direction: Literal["to_previous", "from_previous"] = "to_previous",
        motion_depth: Literal["2d", "distance"] = "2d",
        clip_y: Literal["down", "up"] = "down",
        samples: int = 1,
        timings: bool = False,
        parameters: Mapping[str, float] | None = None,
    ) -> None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def method(self) -> str: ...
    @property
    def device(self) -> Device: ...
    @overload
    def denoise(
        self,
        radiance: ArrayLike,
        normal: ArrayLike,
        depth: ArrayLike,
        *,
        specular: ArrayLike | None = None,
        emission: ArrayLike | None = None,
        albedo: ArrayLike | None = None,
        albedo_specular: ArrayLike | None = None,
        motion: ArrayLike | None = None,
        previous_normal: ArrayLike | None = None,
        reflection_motion: ArrayLike | None = None,
        roughness: ArrayLike | None = None,
        hit_distance: ArrayLike | None = None,
        radiance_variance: ArrayLike | None = None,
        specular_variance: ArrayLike | None = None,
        id: ArrayLike | None = None,
        view: ArrayLike | None = None,
        projection: ArrayLike | None = None,
        previous_view: ArrayLike | None = None,
        previous_projection: ArrayLike | None = None,
        jitter: tuple[float, float] = (0.0, 0.0),
        reset: bool = False,
        outputs: _Output = "color",
    ) -> _Image: ...
    @overload
    def denoise(
        self,
        radiance: ArrayLike,
        normal: ArrayLike,
        depth: ArrayLike,
        *,
        specular: ArrayLike | None = None,
        emission: ArrayLike | None = None,
        albedo: ArrayLike | None = None,
        albedo_specular: ArrayLike | None = None,
        motion: ArrayLike | None = None,
        previous_normal: ArrayLike | None = None,
        reflection_motion: ArrayLike | None = None,
        roughness: ArrayLike | None = None,
        hit_distance: ArrayLike | None = None,
        radiance_variance: ArrayLike | None = None,
        specular_variance: ArrayLike | None = None,
        id: ArrayLike | None = None,
        view: ArrayLike | None = None,
        projection: ArrayLike | None = None,
        previous_view: ArrayLike | None = None,
        previous_projection: ArrayLike | None = None,
        jitter: tuple[float, float] = (0.0, 0.0),
        reset: bool = False,
        outputs: Sequence[_Output],
    ) -> dict[str, _Image]: ...
    def reset(self) -> None: ...
    def resize(self, width: int, height: int) -> None: ...
    def parameters(self) -> dict[str, Parameter]: ...
    def set(self, name: str, value: float) -> None: ...
    def get(self, name: str) -> bool | int | float: ...
    def timings(self) -> dict[str, float]: ...

class Network:
    def __init__(
        self,
        weights: _Path | None = None,
        *,
        device: Device | str | int | None = None,
        parameters: Mapping[str, float] | None = None,
    ) -> None: ...
    @property
    def device_name(self) -> str: ...
    @property
    def precision(self) -> str: ...
    def denoise(
        self,
        diffuse: ArrayLike,
        normal: ArrayLike,
        depth: ArrayLike,
        *,
        diffuse_variance: ArrayLike,
        specular: ArrayLike | None = None,
        specular_variance: ArrayLike | None = None,
        emission: ArrayLike | None = None,
        albedo: ArrayLike | None = None,
        albedo_variance: ArrayLike | None = None,
        normal_variance: ArrayLike | None = None,
        depth_variance: ArrayLike | None = None,
        samples: int = 32,
    ) -> _Image: ...
    def parameters(self) -> dict[str, Parameter]: ...
    def set(self, name: str, value: float) -> None: ...
    def get(self, name: str) -> bool | int | float: ...

@overload
def denoise(
    radiance: ArrayLike,
    normal: ArrayLike,
    depth: ArrayLike,
    *,
    specular: ArrayLike | None = None,
    emission: ArrayLike | None = None,
    albedo: ArrayLike | None = None,
    albedo_specular: ArrayLike | None = None,
    radiance_variance: ArrayLike | None = None,
    specular_variance: ArrayLike | None = None,
    id: ArrayLike | None = None,
    view: ArrayLike | None = None,
    projection: ArrayLike | None = None,
    jitter: tuple[float, float] = (0.0, 0.0),
    outputs: Sequence[_Output],
    method: _Method = "svgf",
    device: Device | str | int | None = None,
    **options: Any,
) -> dict[str, _Image]: ...
@overload
def denoise(
    radiance: ArrayLike,
    normal: ArrayLike,
    depth: ArrayLike,
    *,
    specular: ArrayLike | None = None,
    emission: ArrayLike | None = None,
    albedo: ArrayLike | None = None,
    albedo_specular: ArrayLike | None = None,
    radiance_variance: ArrayLike | None = None,
    specular_variance: ArrayLike | None = None,
    id: ArrayLike | None = None,
    view: ArrayLike | None = None,
    projection: ArrayLike | None = None,
    jitter: tuple[float, float] = (0.0, 0.0),
    outputs: _Output = "color",
    method: _StillMethod = "svgf",
    device: Device | str | int | None = None,
    **options: Any,
) -> _Image: ...
def denoise_shot(
    input: _Path,
    output: _Path,
    *,
    denoiser: _ShotMethod | None = None,
    preset: str | None = None,
    parameters: Mapping[str, float] | None = None,
    weights: _Path | None = None,
    map: Mapping[str, str] | None = None,
    map_file: _Path | None = None,
    files: Mapping[str, _Path] | None = None,
    cameras: _Path | None = None,
    fps: float = 24.0,
    camera_start: int = 0,
    motion: Literal["auto"] | None = "auto",
    frames: int | tuple[int, int] | None = None,
    shard: tuple[int, int] | None = None,
    cuts: Literal["auto"] | Sequence[int] = "auto",
    skip_unreadable: bool = False,
    bidirectional: bool = False,
    strength: float = 1.0,
    preserve: float = 0.0,
    recover: str = "auto",
    resume: bool = False,
    exposure: float | Literal["auto"] = "auto",
    device: Device | str | int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> dict[str, float]: ...
def explain_shot(
    input: _Path,
    *,
    map: Mapping[str, str] | None = None,
    map_file: _Path | None = None,
    files: Mapping[str, _Path] | None = None,
    cameras: _Path | None = None,
    fps: float = 24.0,
    camera_start: int = 0,
    motion: Literal["auto"] | None = "auto",
    frames: int | tuple[int, int] | None = None,
) -> str: ...
def parameters(method: _StillMethod = "svgf") -> dict[str, Parameter]: ...
def compare(
    test: ArrayLike, reference: ArrayLike, *, exposure: float | Literal["auto"] = "auto"
) -> dict[str, float]: ...
def render(
    scene: _Path,
    width: int,
    height: int,
    spp: int = 64,
    *,
    seed: int = 0,
    denoiser: str | None = None,
    parameters: Mapping[str, float] | None = None,
    device: Device | str | int | None = None,
    environment: _Path | None = None,
    camera: str | int | None = None,
    eye: ArrayLike | None = None,
    target: ArrayLike | None = None,
    fov: float | None = None,
    jitter: Literal["pixel", "frame", "off"] | None = None,
    weights: _Path | None = None,
    asset_root: _Path | None = None,
) -> dict[str, NDArray[Any]]: ...
def render_sequence(
    scene: _Path,
    width: int,
    height: int,
    frames: int,
    spp: int = 1,
    *,
    first: int = 0,
    fps: float = 30.0,
    animation: str | int | None = None,
    camera_path: _Path | None = None,
    shutter: float = 0.0,
    shutter_position: Literal["start", "center", "end"] = "center",
    seed: int = 0,
    denoiser: str | None = None,
    parameters: Mapping[str, float] | None = None,
    device: Device | str | int | None = None,
    environment: _Path | None = None,
    camera: str | int | None = None,
    eye: ArrayLike | None = None,
    target: ArrayLike | None = None,
    fov: float | None = None,
    jitter: Literal["pixel", "frame", "off"] | None = None,
    weights: _Path | None = None,
    asset_root: _Path | None = None,
) -> Iterator[dict[str, NDArray[Any]]]: ...
def builtin_scenes() -> dict[str, str]: ...
def look_at(eye: ArrayLike, target: ArrayLike, up: ArrayLike = (0.0, 1.0, 0.0)) -> _Matrix: ...
def perspective(
    fov: float, aspect: float, near: float = 0.1, far: float = ..., clip_y: Literal["down", "up"] = "down"
) -> _Matrix: ...
