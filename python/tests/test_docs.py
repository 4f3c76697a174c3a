"""Runs every block of Python in docs/python.md, in order."""

import os
import re
import tempfile
import unittest

DOCS = os.path.join(os.path.dirname(__file__), "..", "..", "docs", "python.md")


class DocsTest(unittest.TestCase):
    def test_blocks_run(self):
        with open(DOCS) as file:
            text = file.read()
        blocks = list(re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))
        self.assertGreaterEqual(len(blocks), 4)
        names = {"__name__": "docs"}
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            for block in blocks:
                # Makes line numbers in errors match the page.
                source = "\n" * text.count("\n", 0, block.start(1)) + block[1]
                exec(compile(source, "docs/python.md", "exec"), names)
            os.chdir("/")


if __name__ == "__main__":
    unittest.main()
