import os
import unittest

from limpid_training.nano import compare, weights

PROGRAM = os.environ.get("LIMPID_PROGRAM")


class HashTest(unittest.TestCase):
    def test_is_that_of_the_library(self):
        # By the same function `limpid dataset` draws the numbers of rooms. These are in the manifest.
        self.assertEqual([compare.drawn("room", example, seed=0) for example in (0, 1)], [120738741, 3053152959])


@unittest.skipUnless(PROGRAM, "LIMPID_PROGRAM does not name the program `limpid`")
class CompareTest(unittest.TestCase):
    """The library computes the same pictures from the shipped weights as this package does."""

    def test_the_library_computes_the_same(self):
        net = weights.network_in(compare.SHIPPED)
        ((_, ours, svgf),) = compare.compare(PROGRAM, net, scenes=compare.SCENES[:1], width=50, height=38)
        self.assertLess(ours, compare.TOLERANCE * svgf)
        self.assertGreater(svgf, 1e-4)


if __name__ == "__main__":
    unittest.main()
