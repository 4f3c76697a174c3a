import contextlib
import io
import os
import sys
import unittest
from unittest import mock

from limpid_training.nano import compare, weights

PROGRAM = os.environ.get("LIMPID_PROGRAM")


@unittest.skipUnless(PROGRAM, "LIMPID_PROGRAM does not name the program `limpid`")
class CompareTest(unittest.TestCase):
    """The library computes the same pictures from the shipped weights as this package does."""

    def test_the_library_computes_the_same(self):
        for name, shipped in compare.SHIPPED.items():
            net = weights.network_in(shipped)
            results = list(compare.compare(PROGRAM, net, scenes=compare.SCENES[:1], frames=(0, 3), width=50, height=38))
            self.assertEqual([result[1] for result in results], [0, 3])
            for _, number, ours, svgf in results:
                self.assertLess(ours, compare.TOLERANCE * svgf, (name, number))
                self.assertGreater(svgf, 1e-4)


class CommandTest(unittest.TestCase):
    def test_weights_of_the_other_network_are_refused(self):
        told = io.StringIO()
        call = ["compare", "limpid", "--network", "film", "--weights", compare.SHIPPED["nano"]]
        with mock.patch.object(sys, "argv", call), contextlib.redirect_stderr(told):
            with self.assertRaises(SystemExit) as ended:
                compare.main()
        self.assertEqual(ended.exception.code, 2)
        self.assertIn("has no weights of 'film'", told.getvalue())


if __name__ == "__main__":
    unittest.main()
