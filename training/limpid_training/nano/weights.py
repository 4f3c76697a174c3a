"""The weights of a network: in a checkpoint, and in the file that becomes a part of Limpid.

The file's tensors hold halves (texels, 8) in the order in which src/denoise/methods/nano/nano_network.cpp reads them:
level by level the layers on the way down, then level by level those on the way up and the last ones. The order counts,
the names do not. A texel has what one invocation of a shader needs at once: eight outputs. Of a layer, first come the
biases; then the weights by tap, group of eight inputs, group of eight outputs, and input. Outputs that fill up a group
are 0."""

import os

import torch

from .. import checkpoint, tensor_file
from . import network

#: Channels in a texel.
GROUP = 8


def of_checkpoint(state):
    """Returns the weights of a checkpoint that are worth using, by name: means over the last steps, which have less of
    each batch's noise."""
    if "ema" not in state:
        return state["net"]
    return dict(zip(state["net"], state["ema"]))


def layers_of(shape):
    """Yields the name in the file, the name in the network, and whether the layer computes logits."""
    for level, depth in enumerate(shape.depths):
        yield f"level {level}/halve", "inp" if level == 0 else f"down.{level - 1}", False
        for number in range(depth):
            yield f"level {level}/around {number}", f"enc.{level}.{number}", False
    for level in range(len(shape.widths)):
        if level + 1 < len(shape.widths):
            yield f"level {level}/join", f"mix.{level}", False
            yield f"level {level}/after", f"dec.{level}", False
        yield f"level {level}/logits", f"heads.{level}", True


def padded_logits(outputs):
    """The place in the file of each of a last layer's outputs, and the number of places there. Each signal's logits
    begin a group."""
    each = outputs // network.SIGNALS
    places = -(-each // GROUP) * GROUP
    return [signal * places + i for signal in range(network.SIGNALS) for i in range(each)], network.SIGNALS * places


def packed(weight, bias):
    outputs, inputs, height, width = weight.shape
    taps = weight.permute(2, 3, 1, 0).reshape(height * width, inputs // GROUP, GROUP, outputs // GROUP, GROUP)
    return torch.cat([bias.reshape(-1, GROUP), taps.permute(0, 1, 3, 2, 4).reshape(-1, GROUP)]).half()


def unpacked(texels, shape):
    """The inverse of packed(). `shape`: that of the weights."""
    outputs, inputs, height, width = shape
    bias, taps = texels.float().split([outputs // GROUP, len(texels) - outputs // GROUP])
    taps = taps.reshape(height * width, inputs // GROUP, outputs // GROUP, GROUP, GROUP).permute(0, 1, 3, 2, 4)
    return taps.reshape(height, width, inputs, outputs).permute(3, 2, 0, 1), bias.reshape(-1)


def to_file(weights):
    """Returns the file's tensors, in its order. All widths must be multiples of GROUP."""
    tensors = {}
    for name, layer, logits in layers_of(network.shape_of(weights)):
        weight, bias = weights[layer + ".weight"].float().cpu(), weights[layer + ".bias"].float().cpu()
        if logits:
            places, count = padded_logits(len(bias))
            whole = torch.zeros(count, *weight.shape[1:]), torch.zeros(count)
            whole[0][places], whole[1][places] = weight, bias
            weight, bias = whole
        tensors[name] = packed(weight, bias)
    return tensors


def sizes_of(tensors):
    return {name: tuple(tensor.shape) for name, tensor in tensors.items()}


def from_file(tensors):
    """Returns the weights of the network by name: the inverse of to_file(), but for the rounding to halves. Raises
    KeyError if the tensors are of no network that Limpid computes."""
    for shape in network.SHAPES.values():
        expected = network.Net(shape).state_dict()
        if sizes_of(to_file(expected)) == sizes_of(tensors):
            break
    else:
        raise KeyError("no network has such tensors")
    weights = {}
    for name, layer, logits in layers_of(shape):
        of_layer = expected[layer + ".weight"].shape
        if logits:
            places, count = padded_logits(of_layer[0])
            weight, bias = unpacked(tensors[name], (count, *of_layer[1:]))
            weight, bias = weight[places], bias[places]
        else:
            weight, bias = unpacked(tensors[name], of_layer)
        weights[layer + ".weight"], weights[layer + ".bias"] = weight, bias
    return weights


def read(path):
    """Returns the state of a run, of a checkpoint, or of a file of weights, of which only "net" is there. Ends the
    program if there is none, or if it is damaged."""
    if os.path.isdir(path):
        return checkpoint.load(path)
    if not path.endswith(".safetensors"):
        return checkpoint.read(path)
    try:
        return {"net": from_file(tensor_file.read(path)[0])}
    except (OSError, ValueError) as fault:
        checkpoint.end(str(fault), checkpoint.UNREADABLE)
    except KeyError:
        checkpoint.end(f"{path}: has no weights of {network.names()}", checkpoint.UNREADABLE)


def network_in(path):
    """Returns the network of a run, of a checkpoint, or of a file of weights."""
    return network.network_of(of_checkpoint(read(path)))
