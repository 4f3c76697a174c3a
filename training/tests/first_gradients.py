"""Writes the gradients of a training's first batch, for test_training.py.

    python3 -m tests.first_gradients FILE OPTIONS_OF_TRAINING..."""

import sys

import torch

from limpid_training import train


def of(trainer):
    """Returns the gradients of the network for diffuse light, averaged over the workers that have joined."""
    trainer.net.zero_grad()
    trainer.loss("diffuse", next(iter(trainer.batches())))[0].backward()
    return [p.grad.clone() for p in trainer.net.diffuse.parameters()]


if __name__ == "__main__":
    started = train.Trainer(train.parse(sys.argv[2:]))
    gradients = of(started)
    if started.workers.number == 0:
        torch.save(gradients, sys.argv[1])
    started.close()
