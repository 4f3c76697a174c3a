import json
import os
import struct
import tempfile
import unittest

import torch

from limpid_training import tensor_file


class TensorFileTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.path = os.path.join(folder.name, "a.safetensors")

    def test_comes_back_as_it_was_written(self):
        tensors = {
            "w": torch.arange(6, dtype=torch.float32).reshape(1, 2, 3),
            "half": torch.tensor([0.1, -65504.0], dtype=torch.float16),
            "one": torch.tensor(2.5),
            "none": torch.empty(3, 0),
        }
        tensor_file.write(self.path, tensors, {"seed": "7"})
        read, metadata = tensor_file.read(self.path)
        self.assertEqual(metadata["seed"], "7")
        self.assertEqual(set(read), set(tensors))
        for name in tensors:
            self.assertEqual(read[name].dtype, tensors[name].dtype)
            self.assertTrue(torch.equal(read[name], tensors[name]), name)
        self.assertEqual(os.listdir(self.folder), ["a.safetensors"])

    def test_checksum_is_that_of_the_cpp_writer(self):
        tensor_file.write(self.path, {"w": torch.tensor([1.0])})
        self.assertEqual(tensor_file.read(self.path)[1]["crc32"], "aca16a6a")  # as in tensor_file_test.cpp

    def test_damage_is_noticed(self):
        tensor_file.write(self.path, {"w": torch.ones(100)})
        with open(self.path, "r+b") as stream:
            stream.seek(-5, os.SEEK_END)
            stream.write(b"x")
        with self.assertRaisesRegex(ValueError, "damaged"):
            tensor_file.read(self.path)

    @unittest.skipUnless(os.path.isdir("/proc/self/fd"), "needs Linux")
    def test_keeps_no_file_open(self):
        tensor_file.write(self.path, {"w": torch.ones(100)})
        before = len(os.listdir("/proc/self/fd"))
        read = [tensor_file.read(self.path) for _ in range(3)]
        self.assertEqual(len(os.listdir("/proc/self/fd")), before)
        read[0][0]["w"][0] = 2.0
        self.assertEqual(tensor_file.read(self.path)[0]["w"][0], 1.0, "changes are not written back")

    def test_other_types_and_shapes_are_refused_by_name(self):
        for dtype, shape, text in (("BF16", [2], "'a' has elements of type BF16; F16 and F32 can be read"),
                                   ("I64", [1], "elements of type I64"), ("F16", [3], "does not fit its 4 bytes"),
                                   ("F16", [2], None)):
            header = json.dumps({"a": {"dtype": dtype, "shape": shape, "data_offsets": [0, 4]}}).encode()
            with open(self.path, "wb") as stream:
                stream.write(struct.pack("<Q", len(header)) + header + bytes(4))
            if text is None:
                self.assertEqual(tensor_file.read(self.path)[0]["a"].tolist(), [0.0, 0.0])
                continue
            with self.assertRaisesRegex(ValueError, "a.safetensors.*" + text):
                tensor_file.read(self.path)
        with open(self.path, "wb") as stream:
            stream.write(struct.pack("<Q", 2) + b"{]")
        with self.assertRaisesRegex(ValueError, "a.safetensors.*no JSON"):
            tensor_file.read(self.path)

    def test_a_cut_file_is_noticed(self):
        tensor_file.write(self.path, {"w": torch.ones(100)})
        for size in (3, 20):
            os.truncate(self.path, size)
            with self.assertRaises(ValueError):
                tensor_file.read(self.path)


if __name__ == "__main__":
    unittest.main()
