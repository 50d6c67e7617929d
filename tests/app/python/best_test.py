# SPDX-License-Identifier: MIT
"""The best grips against the lists that `wholehand rank` makes of the same result."""

import csv
import itertools
import pathlib
import unittest

import numpy as np
import wholehand as wh
import xarray as xr

from harness import complaint, run
from installed import MESH, SEVERAL, SOBOL, InFolder, tube_ply

# a canister of 5.5 kg
HEAVY = """[[vessel]]
name = "canister"
shape = "cylinder"
diameter_mm = 75
height_mm = 180
wall_mm = 20
density_kg_m3 = 7800
[table]
[strength]
[liquid]
fills = [0, 1]
[grips]
height_fraction = { from = 0.3, to = 0.9, count = 4 }
roll_deg = { from = -90, to = 0, count = 3 }
[tilts]
deg = [0, 45, 90]
"""


class Best(InFolder):
    def setUp(self):
        super().setUp()
        pathlib.Path("tube.ply").write_text(tube_ply())

    def data_of(self, text):
        pathlib.Path("scene.toml").write_text(text)
        return wh.sweep("scene.toml", on="core", output="own.nc")

    def ranked(self, *options):
        """The rows of the program's list: vessel, rank, and where it is."""
        run("rank", "own.nc", "-o", "list.csv", *options)
        with open("list.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        pathlib.Path("list.csv").unlink()
        return rows

    def same(self, found, rows):
        self.assertGreater(len(rows), 0)
        self.assertEqual(list(found["vessel"].values), [row["vessel"] for row in rows])
        self.assertEqual(list(found["rank"].values), [int(row["rank"]) for row in rows])
        for name, column, factor in (
            ("height", "height_mm", 1e3),
            ("azimuth", "azimuth_deg", 180 / np.pi),
            ("obliquity", "obliquity_deg", 180 / np.pi),
            ("roll", "roll_deg", 180 / np.pi),
            ("offset", "offset_mm", 1e3),
            ("hand_scale", "hand_scale", 1),
            ("score", "score", 1),
        ):
            # a list has six digits or more
            np.testing.assert_allclose(
                found[name].values * factor, [float(row[column]) for row in rows], rtol=1e-5, atol=1e-6, err_msg=name
            )

    def test_it_is_the_programs_list(self):
        for text in (SEVERAL, SOBOL, MESH):
            data = self.data_of(text)
            self.same(wh.best(data), self.ranked())
            for n, apart in ((1, 25), (6, 10), (40, 25), (12, 0), (9, 3.5), (4, 200)):
                self.same(wh.best(data, n=n, apart_mm=apart), self.ranked("--best", n, "--apart-mm", apart))
            data.close()

    def test_it_ranks_as_the_program_does(self):
        pushed = SEVERAL.replace("[output]", '[output]\nalso = ["push"]')
        data = self.data_of(pushed + "[robust]\nheight_mm = 3\nroll_deg = 5\ncount = 8\n")
        self.same(wh.best(data, n=4), self.ranked("--best", 4))
        self.same(wh.best(data, n=4, by="robust"), self.ranked("--best", 4, "--rank-by", "robust"))
        for by in ("score", "worst_effort", "push"):
            self.same(wh.best(data, n=4, by=by), self.ranked("--best", 4, "--rank-by", by))
        self.assertGreater(wh.best(data, n=4).robust_low.values.max(), 0)
        data.close()
        without = self.data_of(SEVERAL)
        self.assertIn("no [robust]", str(self.refused(wh.best, without, by="robust")))
        self.assertIn("lacks 'push', by which grips are chosen: name them in [output] also", str(self.refused(wh.best, without, by="push")))

    def test_where_vectors_are_kept_azimuths_count(self):
        data = self.data_of(SEVERAL.replace("[output]", '[output]\nalso = ["midpoint"]'))
        self.same(wh.best(data, n=30, apart_mm=10), self.ranked("--best", 30, "--apart-mm", 10))
        data.close()

    def test_a_condition_and_an_own_score(self):
        data = self.data_of(SEVERAL)
        self.same(
            wh.best(data, n=5, apart_mm=5, where=data.fingers_used >= 4),
            self.ranked("--best", 5, "--apart-mm", 5, "--where", "fingers_used >= 4"),
        )
        own = 1 - data.score_depth
        found = wh.best(data, n=5, apart_mm=0, by=own)
        values = own.where((data.reason == 0) & (data.plausible == 1)).isel(azimuth=0).sel(vessel="low", hand_scale=1)
        expected = np.sort(values.values[~np.isnan(values.values)])[::-1][:5]
        np.testing.assert_array_equal(1 - found.score_depth.values[(found.vessel == "low") & (found.hand_scale == 1)], expected)
        of_states = self.refused(wh.best, data, by="largest_safe_tilt")
        self.assertIn("fill", str(of_states))
        np.testing.assert_array_equal(wh.best(data, n=2, by=data.score)["score"], wh.best(data, n=2)["score"])

    def test_grips_that_do_not_hold_are_listed_on_request_alone(self):
        data = self.data_of(HEAVY)
        self.assertGreater(int((data.not_held == 1).sum()), 3)
        np.testing.assert_array_equal(data.not_held == 1, data.worst_effort > 1)
        np.testing.assert_array_equal(data.score.values[data.not_held.values == 1], 0)
        self.assertEqual(wh.best(data).sizes["grip"], 0)
        least_bad = wh.best(data, n=4, apart_mm=0, least_bad=True)
        self.same(least_bad, self.ranked("--least-bad", "--best", 4, "--apart-mm", 0))
        self.assertTrue((least_bad.held_margin < 1).all())
        np.testing.assert_allclose(least_bad.held_margin * least_bad.worst_effort, 1)
        np.testing.assert_array_equal(np.sort(data.worst_effort.values, axis=None)[:4], least_bad.worst_effort)
        self.assertIn("'not_held'", str(self.refused(wh.best, data.drop_vars("not_held"))))
        data.close()
        robust = self.data_of(HEAVY + "[robust]\nheight_mm = 3\ncount = 8\n")
        self.assertEqual(wh.best(robust).sizes["grip"], 0)
        least_bad = wh.best(robust, n=4, apart_mm=0, least_bad=True)
        self.same(least_bad, self.ranked("--least-bad", "--best", 4, "--apart-mm", 0))
        self.assertTrue(np.isnan(least_bad.robust_low).all())
        robust.close()
        light = self.data_of(HEAVY.replace("wall_mm = 20", "wall_mm = 1"))
        held = wh.best(light, n=50)
        self.assertGreater(held.sizes["grip"], 0)
        self.assertTrue((held.not_held == 0).all() and (held.held_margin >= 1).all())
        xr.testing.assert_identical(held, wh.best(light, n=50, least_bad=True))
        light.close()
        without = self.data_of(HEAVY.replace("[strength]", "[strength]\nefforts = false\n"))
        self.assertIn("[strength]", str(self.refused(wh.best, without, least_bad=True)))
        without.close()

    def test_a_part_of_a_dataset(self):
        data = self.data_of(SEVERAL).load()
        whole, part = wh.best(data, n=4), wh.best(data.sel(vessel="low"), n=4)
        np.testing.assert_array_equal(whole.score.values[whole.vessel.values == "low"], part.score.values)
        few = data.isel(roll=slice(1, 3), obliquity=[1])
        found = wh.best(few, n=4, apart_mm=0)
        self.assertTrue(set(found["roll"].values) <= set(few["roll"].values))
        self.assertIn("no vessel left", str(self.refused(wh.best, data.isel(vessel=[]))))

    def test_they_differ_by_what_was_asked_and_are_the_best_that_do(self):
        """Once more by brute force: the rule itself, over hands that `evaluate` poses."""
        data = self.data_of(SOBOL).load()
        apart = 20e-3
        of = data.isel(vessel=0)
        posed = wh.evaluate("scene.toml", "glass", wh.grips(of), "posed")["posed"]
        eligible = np.flatnonzero((of.reason.values == 0) & (of.plausible.values == 1))
        chosen = []
        for i in sorted(eligible, key=lambda i: (-of.score.values[i], i)):
            if all(np.linalg.norm(posed[i] - posed[j], axis=1).max() > apart for j in chosen):
                chosen.append(i)
        self.assertGreater(len(eligible), len(chosen) + 20)
        found = wh.best(data, n=len(chosen) + 5, apart_mm=1e3 * apart)
        np.testing.assert_array_equal(found["score"], of.score.values[chosen])
        np.testing.assert_array_equal(found["roll"], of["roll"].values[chosen])
        for i, j in itertools.combinations(chosen, 2):
            self.assertGreater(np.linalg.norm(posed[i] - posed[j], axis=1).max(), apart)

    def test_its_grips_go_on(self):
        data = self.data_of(SEVERAL).load()
        found = wh.best(data, n=3)
        low = found.isel(grip=(found.vessel == "low").values)
        again = wh.evaluate("scene.toml", "low", low, "score")["score"]
        np.testing.assert_array_equal(again, low.score)
        one = wh.grip("scene.toml", "low", at=low.isel(grip=0))
        self.assertEqual(one.score, float(low.score[0]))
        self.assertEqual(wh.grips(low).dtype, wh.GRIP)
        self.assertEqual(found["height"].attrs["units"], "m")

    def test_numbers_without_a_sign_are_ordered_as_numbers(self):
        data = self.data_of(SEVERAL).load()
        expected = wh.best(data, n=4, apart_mm=0, by=data.fingers_used.astype(float))
        for kind in (np.uint8, np.uint32, np.int8):
            found = wh.best(data, n=4, apart_mm=0, by=data.fingers_used.where(data.reason == 0, 0).astype(kind))
            np.testing.assert_array_equal(found["score"], expected["score"])
        # by truth values, the true ones come first
        good = data.score > 0.5
        np.testing.assert_array_equal(
            wh.best(data, n=4, apart_mm=0, by=good)["score"], wh.best(data, n=4, apart_mm=0, by=good.astype(float))["score"]
        )
        self.assertIn("real numbers", str(self.refused(wh.best, data, by=data.score.astype(complex))))
        self.assertIn("truths", str(self.refused(wh.best, data, where=data.fingers_used)))

    def test_a_condition_is_an_array_of_truths(self):
        data = self.data_of(SEVERAL).load()
        line = "allowed: a DataArray of truths, as data.fingers_used >= 4"
        for wrong, said in (
            ("fingers_used >= 4", "where is 'fingers_used >= 4'"),
            ("antipodal", "where is 'antipodal'"),
            (["antipodal"], "where is list"),
            ((data.score > 0).values, "where is ndarray"),
            (True, "where is bool"),
        ):
            with self.assertRaises(TypeError) as refused:
                wh.best(data, where=wrong)
            self.assertEqual(str(refused.exception), f"best: {said}; {line}")
        with self.assertRaises(TypeError) as refused:
            wh.best(data, by=data.score.values)
        self.assertEqual(str(refused.exception), "best: by is ndarray; allowed: the name of a variable, or a DataArray")

    def test_a_result_that_moved_with_its_mesh(self):
        data = self.data_of(MESH)
        expected = wh.best(data).score.values
        data.close()
        moved = pathlib.Path("moved")
        moved.mkdir()
        for name in ("own.nc", "scene.toml", "tube.ply"):
            pathlib.Path(name).rename(moved / name)
        with xr.open_dataset("moved/own.nc") as there:
            np.testing.assert_array_equal(wh.best(there).score.values, expected)
            (moved / "tube.ply").rename("tube.ply")
            np.testing.assert_array_equal(wh.best(there).score.values, expected)

    def test_azimuths_that_a_sweep_repeats_are_no_condition(self):
        data = self.data_of(SEVERAL).load()
        self.assertEqual(data.sizes["azimuth"], 2)
        line = "azimuth_deg changes nothing in this sweep: the vessels are bodies of revolution, and one azimuth stands for all"
        for named in (
            {"where": data.azimuth > 0.1},
            {"where": (data.score > 0) & (data.azimuth > 0.1)},
            {"by": data.score * np.cos(data.azimuth)},
            {"by": data.score.isel(azimuth=[1])},
        ):
            self.assertIn(line, str(self.refused(wh.best, data, **named)))
        self.assertIn(line, complaint("rank", "own.nc", "--where", "azimuth_deg > 3", "-o", "list.csv")[1])
        np.testing.assert_array_equal(wh.best(data, by=data.score.where(data.score > 0))["score"], wh.best(data)["score"])

    def test_what_is_wrong_is_said(self):
        data = self.data_of(SEVERAL).load()
        for named in ({"n": 0}, {"n": -3}, {"apart_mm": -1}, {"apart_mm": float("nan")}, {"apart_mm": float("inf")}):
            self.assertIn("allowed", str(self.refused(wh.best, data, **named)))
        self.assertIn("'plausible'", str(self.refused(wh.best, data.drop_vars("plausible"))))
        self.assertIn("'score2'", str(self.refused(wh.best, data, by="score2")))
        self.assertIn("'scene'", str(self.refused(wh.best, xr.Dataset())))
        self.assertIn("several vessels", str(self.refused(wh.grips, data)))
        spoilt = data.copy()
        spoilt.attrs["scene"] = "not a scene"
        self.refused(wh.best, spoilt)
        old = data.assign_attrs(version="0.3.0")
        self.assertIn("written by version 0.3.0; this version reads files from 0.4.0 on", str(self.refused(wh.best, old)))
        with self.assertRaises(TypeError):
            wh.best(data, by=np.zeros(3))
        pathlib.Path("scene.toml").write_text(MESH)
        meshes = wh.sweep("scene.toml", on="core")
        pathlib.Path("tube.ply").write_text(tube_ply(radius=25e-3))
        self.assertIn("mesh", str(self.refused(wh.best, meshes)))


if __name__ == "__main__":
    unittest.main()
