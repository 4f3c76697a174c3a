"""Devices that calls share, and what a forked process does with those of its parent."""

import atexit
import contextlib
import ctypes
import os
import threading
import weakref

from limpid._error import Error


class _Inherited:
    """Stands for a handle in a forked process, which lacks the threads of the drivers."""

    def __getattr__(self, name):
        self.refuse()

    @staticmethod
    def refuse():
        raise Error("this process was forked after the device was opened, and cannot use it: open devices after "
                    "forking only, or use multiprocessing's start method 'spawn'", "unsupported")


_owners = weakref.WeakSet()


def own(owner, handle):
    """Sets owner._handle, an object of an extension module that uses a device."""
    owner._handle = handle
    _owners.add(owner)


def handle_of(owner):
    """Returns owner._handle, to pass it on."""
    if isinstance(owner._handle, _Inherited):
        owner._handle.refuse()
    return owner._handle


def _let_go():
    for owner in list(_owners):
        # Never destroyed: destroying it would wait for threads that do not exist here.
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(owner._handle))
        owner._handle = _Inherited()
    _owners.clear()


def _after_fork(call):
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=call)


_after_fork(_let_go)


_all_shared = []


@contextlib.contextmanager
def watched():
    """Forgets all devices that calls share if the block, or the function that this decorates, loses one. Each next
    call opens its device anew."""
    try:
        yield
    except Error as error:
        if error.code == "device_lost":
            for devices in _all_shared:
                devices.forget()
        raise


class SharedDevices:
    """Devices by the text that chose them. make(text) opens one."""

    def __init__(self, make):
        self._make = make
        self._clear()
        _all_shared.append(self)
        # Drivers may be unloaded before the interpreter's last objects are destroyed.
        atexit.register(self._clear)
        _after_fork(self._clear)

    def _clear(self):
        self._made, self._lock = {}, threading.Lock()

    def forget(self):
        with self._lock:
            self._made = {}

    def get(self, text):
        with self._lock:  # opening a device releases the GIL
            if text not in self._made:
                self._made[text] = self._make(text)
            return self._made[text]
