# SPDX-License-Identifier: MIT
"""The package itself: its types, its examples in docstrings, its help, and what importing it takes."""

import doctest
import importlib
import inspect
import os
import pathlib
import pkgutil
import pydoc
import subprocess
import sys
import unittest

import wholehand as wh

from harness import run
from installed import InFolder

USER = """
from pathlib import Path
import numpy as np
import xarray as xr
import wholehand as wh

scene: wh.Scene = wh.scene(Path("x.toml"))
scene = wh.scene({"vessel": []})
data: xr.Dataset = wh.sweep(scene, on="core", keep=["score"], output="x.nc")
values = wh.evaluate(scene, 0, np.zeros((3, 6)), "score")["score"]
best: xr.Dataset = wh.best(data, 3, 25.0, where=data.score > 0.5)
grip: wh.Grip = wh.grip("small", "tumbler", height_mm=3, tilts_deg=[1, 2])
far: bool = bool((grip.joints[:, 1] > 0.1).any())
with wh.session(scene, gap=(0, 0.1)) as session:
    step: wh.Step = session.step([0, 0, 0], None, 0.1)
    name: str | None = step.vessel
    force: float = step.grip_force
try:
    passed: bool = wh.check(scene).passed
except wh.Error as error:
    code: int = error.exit_code
dtype: "np.dtype[np.void]" = wh.GRIP
"""
WRONG = {
    'wh.evaluate("small", 0, [[0.0] * 6], threads="2")': "arg-type",
    'wh.grip("small", "tumbler", 45)': "call-arg|misc",
    "wh.scene(3)": "arg-type",
    "wh.check().pased": "attr-defined",
    "wh.session().step([0, 0, 0]).grip_force.upper()": "attr-defined",
}


class Package(InFolder):
    def mypy(self, *arguments):
        folder = str(pathlib.Path(wh.__file__).parent.parent)
        environment = os.environ | {"MYPYPATH": folder}
        done = subprocess.run(
            ["/usr/bin/mypy", "--strict", "--cache-dir", "mypy", *arguments], capture_output=True, text=True, env=environment
        )
        return done.returncode, done.stdout + done.stderr

    def test_types(self):
        folder = str(pathlib.Path(wh.__file__).parent)
        pathlib.Path("user.py").write_text(USER)
        code, found = self.mypy(folder, "user.py")
        self.assertEqual(code, 0, found)
        pathlib.Path("wrong.py").write_text("import wholehand as wh\n" + "\n".join(WRONG) + "\n")
        code, found = self.mypy("wrong.py")
        self.assertEqual(code, 1)
        for number, kind in enumerate(WRONG.values(), 2):
            self.assertRegex(found, rf"wrong.py:{number}: error: .*\[({kind})\]")
        self.assertTrue((pathlib.Path(folder) / "py.typed").exists())

    def test_the_stubs_say_what_the_module_has(self):
        def names(of):
            return {name for name in dir(of) if not name.startswith("_")}

        stubs = (pathlib.Path(wh.__file__).parent / "_core.pyi").read_text()
        described = {}
        for line in stubs.splitlines():
            words = line.replace("(", " ").replace(":", " ").split()
            if line.startswith("class "):
                of = described.setdefault(words[1], set())
            elif line.startswith("    def "):
                of.add(words[1])
            elif line and not line.startswith((" ", "#", "from", "import", "_", ")", "@")):
                described[words[1] if words[0] == "def" else words[0]] = set()
        self.assertEqual(set(described), names(wh._core))
        for name, members in described.items():
            if inspect.isclass(getattr(wh._core, name)):
                self.assertEqual({one for one in members if one != "__init__"}, names(getattr(wh._core, name)), name)

    def test_the_examples_of_the_docstrings_run(self):
        attempted = 0
        for module in pkgutil.iter_modules(wh.__path__):
            if module.name == "_core":
                continue
            result = doctest.testmod(importlib.import_module(f"wholehand.{module.name}"))
            self.assertEqual(result.failed, 0, module.name)
            attempted += result.attempted
        self.assertGreater(attempted, 30)

    def test_everything_has_help(self):
        for name in wh.__all__:
            if name == "GRIP":
                continue
            thing = getattr(wh, name)
            self.assertTrue(thing.__doc__, name)  # its own, which inspect.getdoc would take from a base
            for member, value in vars(thing).items() if inspect.isclass(thing) else ():
                if isinstance(value, property) or (inspect.isfunction(value) and not member.startswith("_")):
                    self.assertTrue(value.__doc__, f"{name}.{member}")
        text = pydoc.plain(pydoc.render_doc(wh.evaluate))
        for word in ("evaluate(scene", "(N, 6)", "height (m), azimuth (rad)", "Returns", "Raises", "Error"):
            self.assertIn(word, text)

    def test_importing_it_brings_nothing_that_takes_long(self):
        script = "import sys, wholehand; print(*sorted({name.split('.')[0] for name in sys.modules}))"
        loaded = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout.split()
        self.assertIn("wholehand", loaded)
        for name in ("numpy", "xarray", "pandas", "netCDF4", "matplotlib", "scipy", "dask"):
            self.assertNotIn(name, loaded)

    def test_it_is_of_the_programs_version(self):
        self.assertEqual(f"wholehand {wh.__version__}", run("--version").splitlines()[0])
        with self.assertRaises(AttributeError):
            wh.no_such_thing

    def test_the_module_shows_its_entry_alone(self):
        shown = subprocess.run(
            ["/usr/bin/nm", "-D", "--defined-only", wh._core.__file__], capture_output=True, text=True, check=True
        ).stdout
        self.assertEqual([line.split()[-1] for line in shown.splitlines()], ["PyInit__core"])


if __name__ == "__main__":
    unittest.main()
