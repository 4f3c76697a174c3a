"""What the tests of the package share: the device, which LIMPID_TEST_DEVICE names (default: cpu)."""

import atexit
import os

import numpy as np

import limpid


def device():
    name = os.environ.get("LIMPID_TEST_DEVICE", "cpu")
    if name not in device.made:
        device.made[name] = limpid.Device(name)
    return device.made[name]


device.made = {}
# Not at a module's end: unittest goes back and forth between the modules of test classes.
atexit.register(device.made.clear)


def mse(a, b):
    return float(np.mean((a - b) ** 2))
