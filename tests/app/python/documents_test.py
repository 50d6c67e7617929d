# SPDX-License-Identifier: MIT
"""The Python lines of README.md and docs/python.md give the output that stands below them."""

import doctest
import os
import tempfile
import unittest

from installed import wh  # noqa: F401 (the installed package, and not the source folder)

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))


class Documents(unittest.TestCase):
    def test_lines_give_what_stands_below_them(self):
        with open(os.path.join(ROOT, "docs/python.md")) as file:
            section = file.read().split("## Ten lines", 1)[1].split("What they hold afterwards", 1)[0]
        lines = [line.strip() for line in section.splitlines() if line.startswith("    ")]
        self.assertGreaterEqual(len(lines), 10)
        names, before = {}, os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)  # where the lines write
            try:
                self.check("README.md", 6, names)
                # both sweep and check the same scene, which takes a minute of processor time
                same = ("ds = wh.sweep(scene, on=\"vulkan\")", "check = wh.check(scene)")
                self.assertTrue(set(same) <= set(lines))
                for line in lines:
                    if line not in same:
                        exec(line, names)
                self.check("docs/python.md", 6, names)
            finally:
                os.chdir(before)

    def check(self, path, least, names):
        with open(os.path.join(ROOT, path)) as file:
            text = file.read()
        test = doctest.DocTestParser().get_doctest(text, names, path, path, 0)
        runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
        seen = runner.run(test, clear_globs=False)
        names.update(test.globs)
        self.assertGreaterEqual(seen.attempted, least, path)
        self.assertEqual(seen.failed, 0, path)


if __name__ == "__main__":
    unittest.main(verbosity=2)
