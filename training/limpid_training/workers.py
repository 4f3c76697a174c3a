"""The processes that train together, one for each GPU.

torchrun starts them, and tells each its number by environment variables. A process that was started alone trains
alone."""

import gc
import os

import torch
import torch.distributed as distributed
from torch.nn.parallel import DistributedDataParallel

# Gradients are averaged in pieces of this size while the backward pass still computes others. The networks have 1 to
# 5 MB of gradients: one piece of PyTorch's default size, 25 MB, could only be sent at the end.
PIECE_MB = 0.5


class Workers:
    def __init__(self, device):
        self.count = int(os.environ.get("WORLD_SIZE", "1"))
        self.number = int(os.environ.get("RANK", "0"))
        self.device = torch.device(device)
        if self.device.type == "cuda" and self.device.index is None:
            self.device = torch.device("cuda", torch.cuda.current_device())  # PyTorch 1.13 tells no memory without it
        if self.count > 1:
            if self.device.type == "cuda":
                self.device = torch.device("cuda", int(os.environ["LOCAL_RANK"]))
                torch.cuda.set_device(self.device)
            distributed.init_process_group("nccl" if self.device.type == "cuda" else "gloo")

    def shared(self, module):
        """Returns the module, with gradients that are averaged over all workers. All begin with the first's weights."""
        if self.count == 1:
            return module
        devices = [self.device] if self.device.type == "cuda" else None
        return DistributedDataParallel(module, device_ids=devices, bucket_cap_mb=PIECE_MB, broadcast_buffers=False)

    def told(self, number):
        """Returns the first worker's number, a float. Clocks differ, and workers with different learning rates would
        drift apart."""
        if self.count == 1:
            return number
        value = torch.tensor([number], dtype=torch.float64, device=self.device)
        distributed.broadcast(value, 0)
        return value.item()

    def agreed(self, decision):
        """Returns the first worker's decision, a bool. A worker that stopped alone would leave the others waiting for
        its gradients."""
        return bool(self.told(float(decision)))

    def close(self):
        """Nothing may use a module of shared() any more. If one were the last to hold the connection, PyTorch would
        wait for its own thread, which waits for Python, for ever."""
        if self.count > 1:
            gc.collect()
            distributed.barrier()  # the first worker may still be judging and saving
            distributed.destroy_process_group()
