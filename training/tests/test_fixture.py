import os
import unittest

import torch

from limpid_training import fixture, tensor_file

DATA = os.path.join(os.path.dirname(__file__), "..", "..", "tests", "data")


class FixtureTest(unittest.TestCase):
    """The stored results with which the C++ tests compare are those that this code computes."""

    def test_the_files_are_what_this_code_makes(self):
        stored, _ = tensor_file.read(os.path.join(DATA, "kpcn_cases.safetensors"))
        made = fixture.cases(fixture.networks(DATA, fixture.SHIPPED))
        self.assertEqual(stored.keys(), made.keys())
        for name, tensor in made.items():
            self.assertTrue(torch.allclose(stored[name], tensor, rtol=1e-5, atol=1e-6), name)

    def test_kernels_are_not_flat(self):
        stored, _ = tensor_file.read(os.path.join(DATA, "kpcn_cases.safetensors"))
        for case in fixture.CASES:
            noisy = stored[case + "/diffuse"] + stored[case + "/specular"]
            change = (stored[case + "/clean"] - noisy).abs().mean() / noisy.abs().mean()
            self.assertGreater(change.item(), 0.1)


if __name__ == "__main__":
    unittest.main()
