"""The exception that the library raises."""


class Error(RuntimeError):
    """A failure of the library or the device; str() describes it.

    code: "invalid_argument" (a value outside its range, an unknown name, a missing input), "unsupported" (no device
    fits, or it lacks a feature), "out_of_memory", "device_lost" (make a new Device; those that calls share are opened
    anew by the next call), "unreadable" (an input file), or "failed" (anything else).
    """

    def __init__(self, message, code="failed"):
        super().__init__(message)
        self.code = code


Error.__module__ = "limpid"
