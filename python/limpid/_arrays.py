"""Checks and converts arguments before they reach the library. A ValueError names the argument that is wrong."""

import os

import numpy as np


def choose(name, value, table):
    """Returns table[value]. Raises ValueError, which lists the valid names, if there is no such entry."""
    if value not in table:
        raise ValueError(f"{name}: {value!r} is none of {', '.join(map(repr, table))}")
    return table[value]


def _shape_text(components):
    return " or ".join("(height, width)" if n == 1 else f"(height, width, {n})" for n in components)


def _check_dtype(name, array):
    if array.dtype.kind != "f" or array.dtype.itemsize > 8:
        hint = ": linear radiance of 8-bit pictures has to be decoded first" if array.dtype.kind in "iu" else ""
        raise ValueError(f"{name}: the dtype is {array.dtype}, not float16, float32 or float64{hint}")


def image(name, value, components, size=None):
    """Returns a float32 view of an array (height, width, n), or a copy if a view is not possible.

    `components`: the accepted values of n. `size`: the required (height, width).
    """
    array = np.asarray(value)
    _check_dtype(name, array)
    if array.ndim == 2 and 1 in components:
        array = array[:, :, np.newaxis]
    if array.ndim != 3 or array.shape[2] not in components:
        raise ValueError(f"{name}: the shape is {np.shape(value)}, not {_shape_text(components)}")
    if size is not None and array.shape[:2] != size:
        raise ValueError(f"{name}: {array.shape[0]} x {array.shape[1]} pixels (height x width), "
                         f"but {size[0]} x {size[1]} are expected")
    if array.size == 0:
        raise ValueError(f"{name}: the shape is {np.shape(value)}, there are no pixels")
    array = array.astype(np.float32, copy=False)
    # Strides along axes of length 1 mean nothing.
    forwards = all(stride > 0 for stride, length in zip(array.strides, array.shape) if length > 1)
    adjacent = array.shape[2] == 1 or array.strides[2] == 4
    if not (forwards and adjacent):
        array = array.copy(order="C")
    return array


def setting(value):
    """Formats a parameter's value as the command line expects it."""
    if isinstance(value, (bool, np.bool_)):
        return "on" if value else "off"
    if isinstance(value, (float, np.floating)) and float(value).is_integer() and abs(value) < 2**53:
        return str(int(value))  # "4.0" is no whole number there
    return str(value)


def path(name, value):
    """Returns the name of a file as bytes, since it need not be UTF-8; b"" for None."""
    try:
        encoded = b"" if value is None else os.fsencode(value)
    except TypeError as error:
        raise TypeError(f"{name}: {error}") from None
    if b"\0" in encoded:
        raise ValueError(f"{name}: {value!r} has zero bytes, but names of files have none")
    return encoded


def number(name, value, least, most):
    """Returns an integer from `least` to `most` as int."""
    if not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise ValueError(f"{name}: {value!r} is not a whole number from {least} to {most}")
    return int(value)


def identifiers(name, value, size):
    """Returns integers (height, width) as float32, which is exact up to 2^24."""
    array = np.asarray(value)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name}: the dtype is {array.dtype}, not an integer")
    if array.size and (array.min() < 0 or array.max() > 2**24):
        raise ValueError(f"{name}: numbers from 0 to {2**24} are possible, not {array.min()} to {array.max()}")
    return image(name, array.astype(np.float32), (1,), size)


def matrix(name, value):
    """Returns a float64 matrix (4, 4)."""
    array = np.asarray(value)
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: the dtype is {array.dtype}, not a floating-point number")
    if array.shape != (4, 4):
        raise ValueError(f"{name}: the shape is {array.shape}, not (4, 4)")
    return array.astype(np.float64)
