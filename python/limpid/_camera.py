"""View and projection matrices. Points are column vectors: clip = projection @ view @ [x, y, z, 1]."""

import math

import numpy as np


def look_at(eye, target, up=(0.0, 1.0, 0.0)):
    """Returns the view matrix, (4, 4) float64, of a camera at `eye` that looks at `target`.

    View space is right-handed: x to the right, y up, and the camera looks along -z.

    Raises ValueError if a number is not finite, if eye and target are the same point, or if up is along the view.
    """
    eye, target, up = (_point(name, v) for name, v in (("eye", eye), ("target", target), ("up", up)))
    if np.array_equal(eye, target):
        raise ValueError(f"look_at: eye and target are the same point, {eye.tolist()}")
    if not up.any():
        raise ValueError("look_at: up is 0 and has no direction")
    back = _unit(eye - target)
    right = np.cross(_unit(up), back)
    # Rounding to single precision turns vectors by 1e-7: then the rest is no direction but an error.
    if not np.linalg.norm(right) >= 1e-6:  # nor is NaN, where eye and target are too far apart
        raise ValueError(f"look_at: up, {up.tolist()}, is along the view, so it does not say where the top is")
    return _view(eye, right, np.cross(back, right), -back)


def perspective(fov, aspect, near=0.1, far=math.inf, clip_y="down"):
    """Returns a perspective projection, (4, 4) float64, for the view space of look_at().

    fov: vertical field of view, degrees. aspect: width / height. near, far: distances of the clip planes, world units;
    depth is 0 at the near and 1 at the far plane. clip_y: "down" as in Vulkan, "up" as in OpenGL and Direct3D.
    """
    if clip_y not in ("down", "up"):
        raise ValueError(f"clip_y: {clip_y!r} is none of 'down', 'up'")
    if not (0.0 < fov < 180.0 and aspect > 0.0 and 0.0 < near < far):
        raise ValueError("perspective: needs 0 < fov < 180, aspect > 0 and 0 < near < far")
    scale = 1.0 / math.tan(math.radians(fov) / 2.0)
    # far / (far - near), which is 1 if far is infinite.
    share = 1.0 / (1.0 - near / far)
    return np.array([
        [scale / aspect, 0.0, 0.0, 0.0],
        [0.0, scale if clip_y == "up" else -scale, 0.0, 0.0],
        [0.0, 0.0, -share, -share * near],
        [0.0, 0.0, -1.0, 0.0],
    ])


def _point(name, value):
    array = np.asarray(value, np.float64)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{name}: needs three finite numbers, not {value!r}")
    return array


def _unit(vector):
    vector = vector / np.abs(vector).max()  # the squares of very long and very short ones would have no room
    return vector / np.linalg.norm(vector)


def _view(eye, right, up, forward):
    rotation = np.stack([right, up, -forward])
    rotation /= np.linalg.norm(rotation, axis=1, keepdims=True)
    view = np.eye(4)
    view[:3, :3] = rotation
    view[:3, 3] = -rotation @ eye
    return view


def matrices_of(camera):
    """Returns view and projection of a camera of limpid._renderer, which has an origin and three axes.

    `right` and `up` are scaled so that they reach the picture's edges."""
    origin, forward, right, up = (np.array(camera[key], np.float64) for key in ("origin", "forward", "right", "up"))
    half_width, half_height = np.linalg.norm(right), np.linalg.norm(up)
    view = _view(origin, right, up, forward)
    if not camera["orthographic"]:
        fov = math.degrees(2.0 * math.atan(half_height))
        return view, perspective(fov, half_width / half_height, near=0.01)
    far = 1e4
    return view, np.array([
        [1.0 / half_width, 0.0, 0.0, 0.0],
        [0.0, -1.0 / half_height, 0.0, 0.0],
        [0.0, 0.0, -1.0 / far, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ])
