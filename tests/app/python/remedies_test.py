# SPDX-License-Identifier: MIT
"""Whoever does what an error says to do gets no error."""

import unittest
import warnings

import numpy as np
import wholehand as wh
from installed import SEVERAL, InFolder

BARE = '[[vessel]]\nname = "v"\noutline = [{ line = [30, 0] }, { line = [34, 110] }, { line = [0, 110] }]\nwall_mm = 2\n'


class Remedies(InFolder):
    def test_what_an_error_says_to_do_helps(self):
        scene, bare, dry = wh.scene(SEVERAL), wh.scene(BARE), wh.scene(BARE + "[tilts]\ndeg = [0]\n")
        wet = wh.scene(BARE + "[tilts]\ndeg = [0]\n[liquid]\nfills = [0.5]\n")
        data = wh.sweep(scene, on="core")
        grips, masked = np.array([[0.05, 0, 0, 0, 0, 1]] * 2), np.ma.array([0.05, 0.06], mask=[0, 1])

        def kept(*names):
            with warnings.catch_warnings(action="ignore"):  # about heat maps
                return wh.sweep(scene, on="core", best=0, keep=names)

        for words, refused, followed in [
            ("give one of wh.sweep", lambda: wh.best(data.score.to_dataset()), lambda: wh.best(data)),
            ("lacks 'reason', 'plausible', 'score', 'not_held', by which grips are chosen: name them in [output] also", lambda: wh.best(kept("gap")),
             lambda: wh.best(kept("gap", "reason", "plausible", "score", "not_held"))),
            ("reduce it, say with .max('fill')", lambda: wh.best(data, by=by_fill(data)),
             lambda: wh.best(data, by=by_fill(data).max("fill"))),
            ("select one: data.sel(vessel='...')", lambda: wh.grips(data), lambda: wh.grips(data.sel(vessel="low"))),
            ("give output, too", lambda: wh.sweep(scene, on="core", resume=True),
             lambda: wh.sweep(scene, on="core", resume=True, output="a.nc")),
            ("give height or height_mm", lambda: wh.grip(scene, 0), lambda: wh.grip(scene, 0, height_mm=50)),
            ("or thumb_mm and index_mm", lambda: wh.grip(scene, 0),
             lambda: wh.grip(scene, 0, thumb_mm=(-30, 50, 0), index_mm=(30, 50, 0))),
            ("allowed: one of the two", lambda: wh.grip(scene, 0, height_mm=50, fills=[0.5], fills_ml=[50]),
             lambda: wh.grip(scene, 0, height_mm=50, fills_ml=[50])),
            ("allowed: one of the two", lambda: wh.grip(scene, 0, height_mm=50, tilts=[0], tilts_deg=[0]),
             lambda: wh.grip(scene, 0, height_mm=50, tilts=[0])),
            ("add one with its fills", lambda: wh.grip(dry, 0, height_mm=50, fills=[0.5]),
             lambda: wh.grip(wet, 0, height_mm=50, fills=[0.5])),
            ("or leave fills out", lambda: wh.grip(dry, 0, height_mm=50, fills=[0.5]), lambda: wh.grip(dry, 0, height_mm=50)),
            ("give tilts_deg too", lambda: wh.grip(bare_with_liquid(), 0, height_mm=50, fills=[0.5]),
             lambda: wh.grip(bare_with_liquid(), 0, height_mm=50, fills=[0.5], tilts_deg=[0])),
            ("the column 'height' is missing", lambda: wh.evaluate(scene, 0, {"roll": [0.1]}),
             lambda: wh.evaluate(scene, 0, {"roll": [0.1], "height": [0.05]})),
            ("allowed: one of the two", lambda: wh.evaluate(scene, 0, {"height": [0.05], "height_mm": [50]}),
             lambda: wh.evaluate(scene, 0, {"height_mm": [50]})),
            ("say one of .compressed()", lambda: wh.evaluate(scene, 0, {"height": masked}),
             lambda: wh.evaluate(scene, 0, {"height": masked.compressed()})),
            ("allowed: (N, 6)", lambda: wh.evaluate(scene, 0, grips[:, :5]), lambda: wh.evaluate(scene, 0, grips)),
        ]:
            with self.subTest(words):
                self.assertIn(words, str(self.refused(refused)))
                followed()


def by_fill(data):
    return data[next(name for name in data if "fill" in data[name].dims and "azimuth" in data[name].dims)]


def bare_with_liquid():
    return wh.scene(BARE + "[liquid]\nfills = [0.5]\n")


if __name__ == "__main__":
    unittest.main()
