"""Exports the weights of a training run to the file that is built into Limpid's denoiser `nano` or `film`.

    python3 -m limpid_training.nano.export RUN -o ../weights/nano.safetensors

weights.py describes the file. Its metadata hold the parameters of the training."""

import argparse
import json

import torch

from .. import checkpoint, tensor_file
from . import network, weights

#: Options of a training that say nothing of the network.
OF_THE_CALL = ("clips", "output", "device", "resume", "overwrite", "start", "validation", "report", "save",
               "time_limit")


def metadata_of(name, state):
    options = {key: value for key, value in state.get("options", {}).items() if key not in OF_THE_CALL}
    # Older checkpoints have one data set.
    datasets = [dataset for dataset in state.get("datasets") or [state.get("dataset")] if dataset]
    training = {"datasets": datasets, "steps": state.get("step"), "seconds": round(state.get("seconds", 0)),
                "options": options}
    return {"limpid.network": name, "limpid.training": json.dumps(training)}


def export(run, output):
    """Returns the name of the network."""
    state = weights.read(run)
    trained = weights.of_checkpoint(state)
    shape = network.shape_of(trained)
    name = network.name_of(shape)
    if not name:
        shapes = ", ".join(f"{known} ({shape})" for known, shape in network.SHAPES.items())
        checkpoint.end(f"{run}: has the shape {shape}; Limpid computes only {shapes}", checkpoint.USAGE)
    tensors = weights.to_file(trained)
    for layer, tensor in tensors.items():
        if not torch.isfinite(tensor).all():
            raise SystemExit(f"{run}: some of '{layer}' are no finite numbers in half precision")
    tensor_file.write(output, tensors, metadata_of(name, state), by_name=False)
    return name


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="limpid_training.nano.export", description=__doc__.split("\n")[0])
    parser.add_argument("run", help="output folder of limpid_training.nano.train, or a checkpoint")
    parser.add_argument("-o", "--output", required=True, help="safetensors file to write")
    chosen = parser.parse_args()
    print(f"wrote {chosen.output}: weights of '{export(chosen.run, chosen.output)}'")
