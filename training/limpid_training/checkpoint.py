"""The checkpoint in the output folder of a training run."""

import os
import sys

import torch

# The same exit codes as those of `limpid`.
USAGE, UNREADABLE = 2, 3


def path_in(run):
    return os.path.join(run, "checkpoint.pt")


def end(message, code):
    """Ends the program."""
    print(message, file=sys.stderr)
    raise SystemExit(code)


def load(run, device="cpu"):
    """Returns what a run saved last. Ends the program if there is no checkpoint, or if it is damaged."""
    return read(path_in(run), device)


def read(path, device="cpu"):
    if not os.path.isfile(path):
        end(f"{path}: there is no checkpoint", UNREADABLE)
    try:
        return torch.load(path, map_location=device)
    except Exception as error:  # unpickling damaged files raises errors of many types
        end(f"{path}: cannot be read: {error}", UNREADABLE)


def refuse_to_replace(run):
    """Ends the program if the run has a checkpoint."""
    if os.path.exists(path_in(run)):
        end(f"{path_in(run)}: there is a checkpoint; --resume continues it, --overwrite replaces it", USAGE)


def replace(path, write):
    """Calls write(stream) for a new file, which replaces the one at `path` when it is complete."""
    with open(path + ".new", "wb") as stream:
        write(stream)
        stream.flush()
        os.fsync(stream.fileno())
    os.replace(path + ".new", path)
