# SPDX-License-Identifier: MIT
"""Every function with arguments that nobody means: an exception of Python's or a wh.Error of one line, and never a crash."""

import os
import subprocess
import sys
import unittest

from installed import InFolder

ROUNDS = 400

SCRIPT = """
import random, sys, warnings
import numpy as np, xarray as xr
import wholehand as wh

warnings.simplefilter("ignore")
seed, rounds = int(sys.argv[1]), int(sys.argv[2])
dice = random.Random(seed)
scene = wh.scene("small")
data = wh.sweep(scene, on="core", best=2)
grip = wh.grip(scene, 0, height_mm=45)
odd = [
    None, True, -1, 0, 1, 2**31, 2**63, 2**64, 10**30, 0.5, -0.0, 1e308, float("nan"), float("inf"), 1j, "", "x", "small",
    "core", "tumbler", "score", "a\\nb", "a = 1\\n", "\\x00", "\\ud800", "x" * 5000, b"", b"small", [], [[]], [1], [1, 2, 3],
    ["score"], [None], (), {}, {"height": 0.05}, {"height": [0.05, 0.06]}, {"vessel": []}, {"vessel": 1}, set(), object(),
    np.zeros(0), np.zeros(3), np.zeros((3, 6)), np.zeros((2, 6)) + 0.05, np.eye(3), np.zeros((0, 6)), np.zeros((2, 3, 4)),
    np.full((2, 6), np.nan), np.zeros((2, 6), "c16"), np.zeros((2, 6), "O"), np.array("score"), np.zeros(2, wh.GRIP),
    np.zeros(2, [("height", "f8"), ("foo", "f8")]), np.zeros(2, [("height", "f8", 3)]), np.ma.masked_all((2, 6)),
    np.broadcast_to(1.0, (2, 6)), scene, data, data.score, data.isel(vessel=0), xr.Dataset(), data.score.isel(vessel=0), grip,
    lambda: 1, int, wh,
]
made = [
    (wh.scene, ["source"], ["file"]),
    (wh.evaluate, ["scene", "vessel", "grips"], ["variables", "on", "precision", "threads"]),
    (
        wh.grip,
        ["scene", "vessel"],
        ["height_mm", "azimuth_deg", "roll_deg", "offset_mm", "hand_scale", "thumb_mm", "index_mm", "at", "fills", "fills_ml",
         "tilts_deg", "on", "precision", "quality"],
    ),
    (wh.best, ["data"], ["n", "apart_mm", "by", "where"]),
    (wh.grips, ["data"], []),
    (wh.sweep, ["scene"], ["on", "precision", "best", "keep", "output", "threads", "refine", "resume"]),
    (wh.session, ["scene"], ["gap"]),
    (grip.svg, ["path"], []),
    (grip.glb, ["path"], []),
    (grip.__getitem__, ["name"], []),
    (scene.fills, ["vessel"], []),
]
good = {"scene": scene, "vessel": 0, "grips": np.zeros((2, 6)) + 0.05, "data": data, "height_mm": 45, "source": "small"}
allowed = (wh.Error, TypeError, ValueError, KeyError, OverflowError, AttributeError, IndexError)
session = wh.session()
endings = {}
for turn in range(rounds):
    call, needed, further = dice.choice(made)
    named = {name: good.get(name, None) if name in good and dice.random() < 0.6 else dice.choice(odd) for name in needed}
    named |= {name: dice.choice(odd) for name in further if dice.random() < 0.25}
    if "on" in further and "on" not in named:
        named["on"] = "core"
    if call in (grip.svg, grip.glb, grip.__getitem__, scene.fills):
        arguments, named = [dice.choice(odd)], {}
    else:
        arguments = []
    try:
        call(*arguments, **named)
        end = "done"
    except allowed as error:
        end = type(error).__name__
        if end == "Error" and ("\\n" in str(error) or error.exit_code not in (2, 3) or not str(error)):
            sys.exit(f"{call.__name__}({arguments}, {named}): {error.exit_code} {error!r}")
        of_data = call in (wh.best, wh.grips, wh.evaluate)  # which take whatever behaves like a Dataset
        if type(error) in (AttributeError, IndexError) and not of_data:
            sys.exit(f"{call.__name__}({arguments}, {named}): {error!r}")
    endings[end] = endings.get(end, 0) + 1
    step = [dice.choice(odd) for _ in range(4)]
    try:
        session.step(*step, tick=dice.choice([None, None, None, *odd]))
    except (wh.Error, ValueError, OverflowError):
        pass
# after all of it, what is right is right
assert (wh.evaluate(scene, 0, np.array([[0.045, 0, 0, -0.5, 0, 1.0]]), "reason")["reason"] == 0).all()
assert session.step([0, 0.3, 0.2], None, 0.1, 0, tick=2**53).tick == 2**53
print(endings)
"""


class WrongUse(InFolder):
    def test_nothing_crashes(self):
        for seed in (1, 2, 261212128):  # the last once found a line that was two
            os.mkdir(f"of {seed}")  # a drawing may be written to a file of any name
            done = subprocess.run(
                [sys.executable, "-c", SCRIPT, str(seed), str(ROUNDS)],
                capture_output=True,
                text=True,
                timeout=250,
                cwd=f"of {seed}",
            )
            self.assertEqual(done.returncode, 0, f"seed {seed}: {done.stderr[-3000:]}")
            for end in ("'done'", "'Error'", "'TypeError'"):
                self.assertIn(end, done.stdout)


if __name__ == "__main__":
    unittest.main()
