"""Runs the example in examples/python, which must improve the PSNR."""

import os
import re
import subprocess
import sys
import unittest

EXAMPLE = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "python", "denoise_sequence.py")


class ExampleTest(unittest.TestCase):
    def test_psnr_rises(self):
        text = subprocess.run([sys.executable, EXAMPLE, "cpu"], check=True, capture_output=True, text=True).stdout
        before, after = map(float, re.search(r"PSNR ([\d.]+) dB before, ([\d.]+) dB after", text).groups())
        self.assertGreater(after, before + 6.0, text)


if __name__ == "__main__":
    unittest.main()
