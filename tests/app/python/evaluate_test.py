# SPDX-License-Identifier: MIT
"""Batches against the program's own result file, in every layout that NumPy has; and what goes wrong."""

import pathlib
import subprocess
import sys
import threading
import time
import unittest

import numpy as np
import wholehand as wh
import xarray as xr

from harness import run
from installed import MESH, SEVERAL, SOBOL, InFolder, tube_ply

NAMES = ["height", "azimuth", "obliquity", "roll", "offset", "hand_scale"]


def swept(text, *options):
    """A result of the program, with every variable that the scene has."""
    names = list(wh.scene(text, file="scene.toml").variables())
    keep = "keep = [" + ", ".join(f'"{name}"' for name in names) + "]\n"
    text = text.replace("[output]\n", "[output]\n" + keep) if "[output]" in text else text + "\n[output]\n" + keep
    pathlib.Path("scene.toml").write_text(text)
    run("sweep", "scene.toml", *options)
    return text, names, xr.open_dataset("scene.nc", mask_and_scale=False)


class Evaluate(InFolder):
    def setUp(self):
        super().setUp()
        pathlib.Path("tube.ply").write_text(tube_ply())

    def compare(self, text, on, precision):
        """Every variable of every grip, to the bit."""
        options = ["--on", on, "--precision", precision]
        text, names, data = swept(text, *options)
        scene = wh.scene("scene.toml")
        for vessel in scene.vessels:
            of = data.sel(vessel=vessel)
            grips = wh.grips(of)
            found = wh.evaluate(scene, vessel, grips, names, on=on, precision=precision)
            self.assertEqual(list(found), names)
            axes = len([dim for dim in of["reason"].dims])
            for name in names:
                stored = of[name]
                order = [*of["reason"].dims, *scene.variables()[name].dims]
                stored = stored.transpose(*order).values
                stored = stored.reshape(len(grips), *stored.shape[axes:])
                self.assertEqual(found[name].shape, stored.shape, name)
                if stored.dtype.kind == "f":
                    self.assertEqual(found[name].dtype, stored.dtype, name)
                    np.testing.assert_array_equal(found[name], stored, name)
                else:
                    self.assertEqual(found[name].dtype.itemsize, stored.dtype.itemsize, name)
                    self.assertEqual(found[name].dtype.kind, "u" if name.endswith("mask") else "i", name)
                    np.testing.assert_array_equal(found[name].astype(np.int64), stored.astype(np.int64), name)
        data.close()

    def test_it_is_what_a_sweep_stores(self):
        for text in (SEVERAL, SOBOL, MESH):
            self.compare(text, "core", "double")
        self.compare(SEVERAL, "core", "float")

    def test_on_a_device_too(self):
        self.compare(SEVERAL, "vulkan", "float")

    def table(self, count=200):
        random = np.random.default_rng(1)
        low, high = np.array([0.0, -3, -1, -3, -0.02, 0.8]), np.array([0.1, 3, 1, 3, 0.02, 1.2])
        return low + (high - low) * random.random((count, 6))

    def test_any_layout_gives_the_same(self):
        scene, table = wh.scene(SEVERAL), self.table()
        expected = wh.evaluate(scene, "low", table, ["score", "posed", "touch_mask"])
        structured = np.zeros(len(table), wh.GRIP)
        packed = np.zeros(len(table), [("pad", "i1"), *((name, "<f8") for name in reversed(NAMES))])
        big_endian = np.zeros(len(table), [(name, ">f8") for name in NAMES])
        for k, name in enumerate(NAMES):
            structured[name] = packed[name] = big_endian[name] = table[:, k]
        wide = np.full((2 * len(table), 11), np.nan)
        wide[::2, 1:7] = table
        readonly = table.copy()
        readonly.flags.writeable = False
        layouts = {
            "structured": structured,
            "packed, unaligned": packed[NAMES],
            "big endian": big_endian,
            "Fortran": np.asfortranarray(table),
            "strided": wide[::2, 1:7],
            "backwards": table[::-1][::-1],
            "read only": readonly,
            "lists": table.tolist(),
            "columns": {name: table[:, k] for k, name in enumerate(NAMES)},
            "dataset": xr.Dataset(coords={name: ("grip", table[:, k]) for k, name in enumerate(NAMES)}),
        }
        for label, grips in layouts.items():
            found = wh.evaluate(scene, "low", grips, ["score", "posed", "touch_mask"])
            for name, values in expected.items():
                np.testing.assert_array_equal(found[name], values, f"{label}: {name}")
                self.assertTrue(found[name].flags.c_contiguous)
        singles = wh.evaluate(scene, "low", table.astype(np.float32), "score")["score"]
        np.testing.assert_array_equal(singles, wh.evaluate(scene, "low", table.astype(np.float32).astype(float), "score")["score"])

    def test_doubles_are_read_where_they_lie(self):
        table = self.table()
        structured = np.zeros(10, wh.GRIP)
        for grips in (table, np.asfortranarray(table), table[::2], structured):
            for column in wh._evaluate.grip_columns(grips):
                self.assertTrue(np.shares_memory(column, grips))

    def test_columns_that_are_missing_have_their_defaults(self):
        scene = wh.scene(SEVERAL)
        heights = np.linspace(0.01, 0.05, 7)
        whole = np.zeros((7, 6))
        whole[:, 0], whole[:, 5], whole[:, 3] = heights, 1, -0.5
        expected = wh.evaluate(scene, "low", whole, "closure")["closure"]
        np.testing.assert_array_equal(wh.evaluate(scene, "low", {"height": heights, "roll": -0.5}, "closure")["closure"], expected)
        some = np.zeros(7, [("roll", "f8"), ("height", "f8")])
        some["height"], some["roll"] = heights, -0.5
        np.testing.assert_array_equal(wh.evaluate(scene, "low", some, "closure")["closure"], expected)
        self.assertEqual(wh.evaluate(scene, "low", {"height": 0.03}, "closure")["closure"].shape, (1,))

    def test_columns_may_have_the_units_of_a_scene_file(self):
        scene, rad = wh.scene(SEVERAL), np.pi / 180
        units = {"height_mm": [10, 40.5], "azimuth_deg": 12, "obliquity_deg": [-5, 5], "roll_deg": -33, "offset_mm": 3, "hand_scale": 0.95}
        table = [[mm / 1e3, 12 * rad, deg * rad, -33 * rad, 3 / 1e3, 0.95] for mm, deg in ((10, -5), (40.5, 5))]
        expected = wh.evaluate(scene, "low", table, ["score", "joints"])
        for grips in (units, {**units, "height_mm": np.array([10, 40.5], np.float32)}):
            found = wh.evaluate(scene, "low", grips, ["score", "joints"])
            for name, values in expected.items():
                np.testing.assert_array_equal(found[name], values, name)
        self.assertIn("both height and height_mm are given", str(self.refused(wh.evaluate, scene, "low", {"height": 0.03, "height_mm": 30})))
        self.assertIn("roll_deg is <U1; allowed: real numbers", str(self.refused(wh.evaluate, scene, "low", {"height": 0.03, "roll_deg": "1"})))

    def test_grips_of_a_dataset_are_in_its_own_order(self):
        scene = wh.scene(SEVERAL)
        data = wh.sweep(scene, on="core", best=0, keep=["score", "reason", "midpoint"]).sel(vessel="low")
        axes = list(data["reason"].dims)
        for order in (axes, axes[::-1], axes[2:] + axes[:2]):
            turned = data.transpose(*order, ...)
            found = wh.evaluate(scene, "low", wh.grips(turned), "score")["score"]
            np.testing.assert_array_equal(found, turned["score"].values.ravel())
        part = data.isel(roll=1).drop_vars("reason").transpose("height_fraction", "hand_scale", ...)
        found = wh.evaluate(scene, "low", wh.grips(part), "score")["score"]
        np.testing.assert_array_equal(found, part["score"].values.ravel())
        self.assertGreater(len(np.unique(found)), 10)

    def test_a_table_of_pandas_goes_by_its_names(self):
        import pandas as pd

        scene, table = wh.scene(SEVERAL), self.table(20)
        expected = wh.evaluate(scene, "low", table, "score")["score"]
        frame = pd.DataFrame({name: table[:, NAMES.index(name)] for name in reversed(NAMES)})
        np.testing.assert_array_equal(wh.evaluate(scene, "low", frame, "score")["score"], expected)
        np.testing.assert_array_equal(wh.evaluate(scene, "low", frame[["height"]], "closure")["closure"].shape, (20,))
        self.assertIn("'tilt'", str(self.refused(wh.evaluate, scene, "low", frame.assign(tilt=1.0))))
        self.assertIn("no column", str(self.refused(wh.evaluate, scene, "low", pd.DataFrame(table))))

    def test_masked_and_ragged_arrays_are_refused(self):
        scene, table = wh.scene(SEVERAL), self.table(3)
        masked = np.ma.array(table, mask=table > 0)
        column = np.ma.array(table[:, 0], mask=[0, 1, 0])
        for grips in (masked, {"height": column}, np.ma.masked_all(2, wh.GRIP)):
            self.assertIn("masked array", str(self.refused(wh.evaluate, scene, "low", grips)))
        self.assertIn("rows of one length", str(self.refused(wh.evaluate, scene, "low", [[0.1] * 6, [0.1] * 5])))

    def test_a_forked_process_does_not_use_its_parents_device(self):
        script = (
            "import os, numpy as np, wholehand as wh\n"
            "grips = {'height': np.full(5, 0.05)}\n"
            "wh.evaluate('small', 0, grips, 'score', on='vulkan')\n"
            "child = os.fork()\n"
            "if not child:\n"
            "    try:\n"
            "        wh.evaluate('small', 0, grips, 'score', on='vulkan')\n"
            "    except wh.Error as error:\n"
            "        assert error.exit_code == 3\n"
            "        print(error, len(wh.evaluate('small', 0, grips, 'score')['score']), flush=True)\n"
            "    os._exit(0)\n"
            "os.waitpid(child, 0)\n"
            "wh.evaluate('small', 0, grips, 'score', on='vulkan')\n"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r'^a device was opened before this process was forked.*"spawn" 5\n$')

    def test_auto_leaves_few_grips_to_the_core_and_takes_many_to_the_device(self):
        scene = wh.scene("three_beakers")
        heights = np.linspace(0.02, 0.1, 60_000)  # some four seconds of one thread of the core
        for count, wanted in ((100, "core"), (60_000, "vulkan")):
            columns = wh._evaluate.grip_columns({"height": heights[:count]})
            _, chosen = wh._core.evaluate(scene._core, 0, columns, ["gap"], "auto", "double", 1)
            self.assertEqual(chosen, wanted)
        found = wh.evaluate(scene, 0, {"height": heights}, "gap", threads=1)["gap"]
        self.assertEqual(found.dtype, np.float64, "of any number of grips")
        few = wh.evaluate(scene, 0, {"height": heights[::600]}, "gap", on="core")["gap"]
        np.testing.assert_allclose(found[::600], few, rtol=1e-9)

    def test_no_grips_and_no_variables(self):
        scene = wh.scene(SEVERAL)
        found = wh.evaluate(scene, "low", np.zeros((0, 6)), ["score", "joints", "torque"])
        self.assertEqual([value.shape for value in found.values()], [(0,), (0, 24, 3), (0, 2, 3)])
        self.assertEqual(wh.evaluate(scene, "low", self.table(3), []), {})
        self.assertEqual(list(wh.evaluate(scene, "low", self.table(3))), [name for name in swept_by_default(SEVERAL)])

    def test_what_is_wrong_is_said(self):
        scene, good = wh.scene(SEVERAL), self.table(5)
        bad = good.copy()
        bad[3, 2] = np.nan
        self.assertEqual(
            str(self.refused(wh.evaluate, scene, "low", bad)),
            "grips: the obliquity of grip 3 is nan; allowed: a number, -1.5708 to 1.5708 rad",
        )
        for row, column, value in ((0, 0, np.inf), (4, 5, 0), (4, 5, -1), (1, 3, 1e308), (2, 4, -np.inf), (2, 1, 6.29)):
            bad = good.copy()
            bad[row, column] = value
            line = str(self.refused(wh.evaluate, scene, "low", bad))
            self.assertIn(f"the {NAMES[column]} of grip {row} is", line)
        shapes = [np.zeros(6), np.zeros((5, 7)), np.zeros((6, 5)), np.zeros((1, 5, 6)), np.zeros(()), []]
        for grips in shapes:
            self.assertIn("allowed: (N, 6)", str(self.refused(wh.evaluate, scene, "low", grips)))
        for kind in (bool, complex, object, "U4", "M8[s]"):
            self.assertIn("real numbers", str(self.refused(wh.evaluate, scene, "low", np.zeros((2, 6), kind))))
        self.assertIn("'tilt'", str(self.refused(wh.evaluate, scene, "low", {"height": [0.1], "tilt": [1]})))
        self.assertIn("'height' is missing", str(self.refused(wh.evaluate, scene, "low", {"roll": [0.1]})))
        self.assertIn("different shapes", str(self.refused(wh.evaluate, scene, "low", {"height": [0.1, 0.2], "roll": [1, 2, 3]})))
        self.assertIn("allowed: (N,)", str(self.refused(wh.evaluate, scene, "low", {"height": [[0.1]]})))
        self.assertIn("joint", str(self.refused(wh.evaluate, scene, "low", good, ["joint"])))
        self.assertTrue(
            str(self.refused(wh.evaluate, scene, "low", good, "joint")).startswith('variables: unknown variable "joint"; known: ')
        )
        self.assertIn("[table]", str(self.refused(wh.evaluate, scene, "low", good, "table_depth")))
        self.assertIn("no-such", str(self.refused(wh.evaluate, scene, "low", good, on="no-such")))
        self.assertIn("float or double", str(self.refused(wh.evaluate, scene, "low", good, precision="half")))
        self.assertIn("1 to 1024", str(self.refused(wh.evaluate, scene, "low", good, threads=5000)))
        for wrong in ({"threads": "many"}, {"on": 3}, {"precision": 64}, {"variables": 5}, {"variables": [5]}):
            with self.assertRaises(TypeError):
                wh.evaluate(scene, "low", good, **wrong)
        # after all this, it works as before
        self.assertEqual(len(wh.evaluate(scene, "low", good)["score"]), 5)

    def test_full_turns_in_degrees_are_allowed(self):
        scene = wh.scene(SEVERAL)
        for angle in (360.0, -360.0):
            wh.evaluate(scene, "low", {"height": [0.03], "azimuth": np.deg2rad([angle]), "roll": np.radians(angle)})
        wh.evaluate(scene, "low", {"height": [0.03], "obliquity": [np.deg2rad(90.0)]})

    def test_many_threads_at_once_get_what_one_gets(self):
        scene, table = wh.scene(SEVERAL), self.table(400)
        wishes = [
            ("low", "score"),
            ("tall", "closure"),
            ("low", "joints"),
            ("tall", "touch_mask"),
            ("low", "effort"),
            ("tall", "score"),
        ]
        expected = [wh.evaluate(scene, vessel, table, name)[name] for vessel, name in wishes]
        found = [[None] * 4 for _ in wishes]

        def work(k, turn):
            vessel, name = wishes[k]
            found[k][turn] = wh.evaluate(scene, vessel, table, name, threads=1 + turn % 2)[name]

        threads = [threading.Thread(target=work, args=(k, turn)) for k in range(len(wishes)) for turn in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for k, one in enumerate(expected):
            for other in found[k]:
                np.testing.assert_array_equal(other, one)

    def test_other_threads_run_meanwhile(self):
        scene, table = wh.scene(SEVERAL), self.table(30_000)
        wh.evaluate(scene, "low", table[:10])
        is_over, turns = threading.Event(), [0]

        def turn():
            while not is_over.wait(1e-3):
                turns[0] += 1

        thread = threading.Thread(target=turn)
        thread.start()
        while turns[0] == 0:
            time.sleep(1e-3)
        before = turns[0]
        wh.evaluate(scene, "low", table)
        after = turns[0]
        is_over.set()
        thread.join()
        # with the interpreter's lock held all along, the thread would have had no turn
        self.assertGreater(after - before, 2)

    def test_ctrl_c_ends_it_at_any_size(self):
        """Within a second: of processor time by processor, which a busy machine does not stretch."""
        many_states = (
            '[[vessel]]\nname = "cup"\nshape = "cylinder"\ndiameter_mm = 70\nheight_mm = 90\nwall_mm = 2\n[strength]\n[liquid]\n'
            f"fills = {[k / 32 for k in range(33)]}\n[tilts]\ndeg = {{ from = 0, to = 150, count = 1500 }}\n"
        )
        script = (
            "import os, signal, sys, threading, time, numpy as np, wholehand as wh\n"
            "scene, height, count, name = wh.scene(sys.argv[1]), 0.06, int(sys.argv[2]), sys.argv[3]\n"
            "wh.evaluate(scene, 0, {'height': [height]}, name)\n"
            "used = []\n"
            "def interrupt():\n"
            "    used.append(time.process_time())\n"
            "    os.kill(os.getpid(), signal.SIGINT)\n"
            "threading.Timer(0.5, interrupt).start()\n"
            "try:\n"
            "    wh.evaluate(scene, 0, {'height': np.broadcast_to(height, count)}, name, on='core')\n"
            "except KeyboardInterrupt:\n"
            "    print((time.process_time() - used[0]) / len(os.sched_getaffinity(0)))\n"
        )
        for scene, count, name in (("small", 10**9, "reason"), (many_states, 3000, "worst_effort")):
            command = [sys.executable, "-c", script, scene, str(count), name]
            done = subprocess.run(command, capture_output=True, text=True, timeout=200)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertLess(float(done.stdout), 1)

    def test_ctrl_c_ends_it(self):
        script = (
            "import os, signal, threading, time, numpy as np, wholehand as wh\n"
            "scene = wh.scene('three_beakers')\n"
            "grips = {'height': np.full(3_000_000, 0.06)}\n"
            "wh.evaluate(scene, 0, {'height': [0.06]}, 'effort')\n"
            "threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
            "try:\n"
            "    wh.evaluate(scene, 0, grips, 'worst_effort', on='core')\n"
            "except KeyboardInterrupt:\n"
            "    print('stopped', len(wh.evaluate(scene, 0, {'height': [0.06]}, 'worst_effort')))\n"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=200)
        self.assertEqual((done.returncode, done.stdout), (0, "stopped 1\n"), done.stderr)

    def test_beyond_the_domain_of_float_there_is_a_note(self):
        text = SEVERAL.replace("[strength]\nthumb_N = 40", "[hand]\nscale = 0.09")
        scene = wh.scene(text)
        with self.assertWarnsRegex(wh.Note, "use --precision double"):
            wh.evaluate(scene, "low", self.table(3), "score", precision="float")


def swept_by_default(text):
    return wh.evaluate(wh.scene(text), 0, {"height": [0.03]})


if __name__ == "__main__":
    unittest.main()
