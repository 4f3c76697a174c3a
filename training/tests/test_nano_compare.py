import os
import unittest

from limpid_training.nano import compare, weights

PROGRAM = os.environ.get("LIMPID_PROGRAM")


@unittest.skipUnless(PROGRAM, "LIMPID_PROGRAM does not name the program `limpid`")
class CompareTest(unittest.TestCase):
    """The library computes the same pictures from the shipped weights as this package does."""

    def test_the_library_computes_the_same(self):
        net = weights.network_in(compare.SHIPPED)
        results = list(compare.compare(PROGRAM, net, scenes=compare.SCENES[:1], frames=(0, 3), width=50, height=38))
        self.assertEqual([result[1] for result in results], [0, 3])
        for _, number, ours, svgf in results:
            self.assertLess(ours, compare.TOLERANCE * svgf, number)
            self.assertGreater(svgf, 1e-4)


if __name__ == "__main__":
    unittest.main()
