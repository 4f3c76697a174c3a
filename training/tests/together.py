"""Starts several workers, as torchrun does."""

import os
import socket
import subprocess
import sys


def start_workers(test, count, *module_and_arguments):
    """Returns the workers' output; `test` fails if one of them does. (Debian's torchrun does not work with Debian's
    Python.)"""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = str(free.getsockname()[1])
    workers = []
    for rank in map(str, range(count)):
        world = {"WORLD_SIZE": str(count), "RANK": rank, "LOCAL_RANK": rank, "MASTER_ADDR": "127.0.0.1"}
        environment = dict(os.environ, OMP_NUM_THREADS="1", MASTER_PORT=port, **world)
        workers.append(
            subprocess.Popen([sys.executable, "-m", *module_and_arguments], env=environment, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT))
    try:
        output = [worker.communicate(timeout=240)[0].decode() for worker in workers]
    finally:
        for worker in workers:
            worker.kill()  # what has not ended
    test.assertEqual([worker.returncode for worker in workers], [0] * count, output)
    return output
