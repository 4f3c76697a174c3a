"""Reads and writes named tensors in the safetensors format (https://github.com/huggingface/safetensors, "Format"),
with the CRC-32 of all elements as metadata "crc32". src/neural/tensor_file.h does the same in C++."""

import json
import math
import os
import struct
import tempfile
import zlib

import torch

_TYPES = {"F16": torch.float16, "F32": torch.float32}
_NAMES = {dtype: name for name, dtype in _TYPES.items()}
_METADATA = "__metadata__"


def _bytes_of(tensor):
    return tensor.detach().cpu().contiguous().numpy().tobytes()


def write(path, tensors, metadata=None, by_name=True):
    """Writes `tensors`, a dict of float16 or float32 tensors, in the order of their names, or else of the dict. An
    existing file is replaced only when the new one is complete."""
    header, place, checksum, blocks = {}, 0, 0, []
    for name in sorted(tensors) if by_name else tensors:
        block = _bytes_of(tensors[name])
        header[name] = {
            "dtype": _NAMES[tensors[name].dtype],
            "shape": list(tensors[name].shape),
            "data_offsets": [place, place + len(block)],
        }
        place += len(block)
        checksum = zlib.crc32(block, checksum)
        blocks.append(block)
    header[_METADATA] = dict(metadata or {}, crc32=f"{checksum:08x}")
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    folder = os.path.dirname(os.path.abspath(path))
    handle, temporary = tempfile.mkstemp(dir=folder, prefix=os.path.basename(path) + ".")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(struct.pack("<Q", len(text)))
            stream.write(text)
            for block in blocks:
                stream.write(block)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def read(path):
    """Returns the tensors by name, and the metadata. Raises ValueError if the file is damaged, or if its elements are
    of another type than F16 and F32.

    The file is mapped: processes that read the same file share its memory, and tensors that are never used are never
    loaded. Changes to a tensor are not written back."""
    size = os.path.getsize(path)
    if size < 8:
        raise ValueError(f"{path}: is no safetensors file")
    # Unlike numpy.memmap, keeps no file open: data sets may have more files than a process may open.
    content = torch.from_file(path, shared=False, size=size, dtype=torch.uint8).numpy()
    (length,) = struct.unpack_from("<Q", content)
    if length > size - 8:
        raise ValueError(f"{path}: is cut off within its header")
    try:
        header = json.loads(content[8 : 8 + length].tobytes())
    except ValueError as fault:
        raise ValueError(f"{path}: its header is no JSON: {fault}") from None
    data = content[8 + length :]
    metadata = header.pop(_METADATA, {})
    if "crc32" in metadata and metadata["crc32"] != f"{zlib.crc32(data):08x}":
        raise ValueError(f"{path}: is damaged: its elements do not have the checksum that it states")
    tensors = {}
    for name, entry in header.items():
        (begin, end), shape = entry["data_offsets"], entry["shape"]
        if entry["dtype"] not in _TYPES:
            known = " and ".join(_TYPES)
            raise ValueError(f"{path}: '{name}' has elements of type {entry['dtype']}; {known} can be read")
        dtype = _TYPES[entry["dtype"]]
        if end > len(data):
            raise ValueError(f"{path}: is cut off within '{name}'")
        if begin < 0 or end - begin != math.prod(shape) * torch.empty(0, dtype=dtype).element_size():
            raise ValueError(f"{path}: '{name}': its shape does not fit its {end - begin} bytes")
        flat = torch.from_numpy(data[begin:end]).view(dtype) if begin < end else torch.empty(0, dtype=dtype)
        tensors[name] = flat.reshape(shape)
    return tensors, metadata
