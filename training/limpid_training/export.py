"""Exports the weights of a training run to the file format that Limpid's denoiser reads.

    python3 -m limpid_training.export RUN -o kpcn.safetensors

Tensors are in half precision and named after the network's layers ("diffuse.hidden.0.weight"). The metadata hold the
network's shape and the parameters of the training."""

import argparse
import json

import torch

from . import checkpoint, features, tensor_file


#: Options of a training that say nothing of the network.
OF_THE_CALL = ("data", "output", "device", "resume", "overwrite")


def export(run, output):
    state = checkpoint.load(run)
    options = state["options"]
    if options["direct"]:
        raise SystemExit(f"{run}: predicts colours; Limpid denoises with kernels")
    weights = {name: weight.half() for name, weight in state["net"].items()}
    for name, weight in weights.items():
        if not torch.isfinite(weight).all():
            raise SystemExit(f"{run}: some of '{name}' are no finite numbers in half precision")
    unseen = sorted(set(range(features.INPUT_CHANNELS)) - set(features.INPUTS[options["inputs"]]))
    for side in features.SIDES:
        weights[side + ".hidden.0.weight"][:, unseen] = 0.0  # inputs not used in training
    shape = ("hidden", "channels", "width", "facing", "diffuse_input")
    metadata = {
        "limpid.network": "kpcn",
        "limpid.shape": json.dumps({key: options[key] for key in shape}),
        "limpid.training": json.dumps(
            {
                "dataset": state["dataset"],
                "epochs": state["epoch"],
                "seconds": round(state["seconds"]),
                "options": {key: value for key, value in options.items() if key not in OF_THE_CALL},
            }
        ),
    }
    tensor_file.write(output, weights, metadata)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="limpid_training.export", description=__doc__.split("\n")[0])
    parser.add_argument("run", help="output folder of limpid_training.train")
    parser.add_argument("-o", "--output", required=True, help="safetensors file to write")
    chosen = parser.parse_args()
    export(chosen.run, chosen.output)
