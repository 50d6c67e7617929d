# SPDX-License-Identifier: MIT
"""Every example of examples/python runs to its end, with the installed package. Each checks its own result."""

import os
import pathlib
import subprocess
import sys
import unittest

from installed import InFolder

EXAMPLES = pathlib.Path(__file__).resolve().parents[3] / "examples/python"


class Examples(InFolder):
    def test_all_of_them_run(self):
        files = sorted(EXAMPLES.glob("*.py"))
        self.assertGreaterEqual(len(files), 4)
        for file in files:
            environment = os.environ | {"MPLCONFIGDIR": os.getcwd(), "PYTHONWARNINGS": "error::UserWarning"}
            done = subprocess.run([sys.executable, file], capture_output=True, text=True, env=environment, timeout=200)
            self.assertEqual(done.returncode, 0, f"{file.name}: {done.stderr}")
            self.assertTrue(done.stdout, file.name)
        for made in ("own_glass.png", "own_glass.svg", "own_glass.glb"):
            self.assertGreater(pathlib.Path(made).stat().st_size, 1000)


if __name__ == "__main__":
    unittest.main()
