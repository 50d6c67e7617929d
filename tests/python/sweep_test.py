# SPDX-License-Identifier: MIT
"""A sweep as a Dataset is the program's result file; it keeps quiet, and ends when it is asked to."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np
import wholehand as wh
import xarray as xr

from installed import MESH, SEVERAL, SOBOL, InFolder, complaint, run, tube_ply

OF_THE_RUN = {"wall_time_s", "kernel_time_s"}


class Sweep(InFolder):
    def same(self, found, file):
        """All of it: names, dimensions, coordinates, values to the bit, attributes; but what a clock says."""
        with xr.open_dataset(file) as stored:
            self.assertEqual(list(found.variables), list(stored.variables))
            self.assertEqual(set(found.coords), set(stored.coords))
            self.assertEqual(dict(found.sizes), dict(stored.sizes))
            for name in stored.variables:
                self.assertEqual(found[name].dtype, stored[name].dtype, name)
                self.assertEqual(found[name].dims, stored[name].dims, name)
                np.testing.assert_array_equal(found[name].values, stored[name].values, name)
                self.assertEqual(found[name].attrs.keys(), stored[name].attrs.keys())
                for key, value in stored[name].attrs.items():
                    np.testing.assert_array_equal(found[name].attrs[key], value, f"{name}: {key}")
            self.assertEqual(found.attrs.keys(), stored.attrs.keys())
            for key, value in stored.attrs.items():
                if key not in OF_THE_RUN:
                    self.assertEqual(found.attrs[key], value, key)

    def test_it_is_the_programs_file(self):
        pathlib.Path("tube.ply").write_text(tube_ply())
        for text, on in ((SEVERAL, "core"), (SOBOL, "core"), (MESH, "core"), (SEVERAL, "vulkan")):
            pathlib.Path("scene.toml").write_text(text)
            run("sweep", "scene.toml", "--on", on)
            found = wh.sweep("scene.toml", on=on)
            self.same(found, "scene.nc")
            self.assertEqual(found.score.attrs["units"], "1")
            self.assertTrue(found["score"].values.flags.owndata or found["score"].values.base is not None)
        self.assertEqual([name for name in os.listdir(".") if "partial" in name], [])

    def test_its_options_are_the_programs(self):
        pathlib.Path("scene.toml").write_text(SEVERAL)
        run("sweep", "scene.toml", "--on", "core", "--precision", "float", "--best", 7, "--no-refine")
        self.same(wh.sweep("scene.toml", on="core", precision="float", best=7, refine=False), "scene.nc")
        self.assertEqual(wh.sweep("scene.toml", on="core", threads=1).attrs["device"], "core, 1 thread")
        pathlib.Path("kept.toml").write_text(SEVERAL.replace("[output]", '[output]\nkeep = ["score", "joints", "reason"]'))
        run("sweep", "kept.toml", "--on", "core")
        found = wh.sweep(SEVERAL, on="core", keep=["joints", "reason", "score"])
        with xr.open_dataset("kept.nc") as stored:
            self.assertEqual(set(found.variables), set(stored.variables))
            np.testing.assert_array_equal(found["joints"].values, stored["joints"].values)

    def test_the_file_is_kept_where_one_is_asked_for(self):
        data = wh.sweep(SEVERAL, on="core", output=pathlib.Path("own.nc"))
        self.assertTrue({"own.nc", "own.best.csv", "own.tall.svg", "own.low.svg"} <= set(os.listdir(".")))
        self.same(data, "own.nc")
        data.close()
        again = wh.sweep(SEVERAL, on="core", output="own.nc")
        again.close()
        with self.assertWarnsRegex(wh.Note, "complete"):
            wh.sweep(SEVERAL, on="core", output="own.nc", resume=True).close()

    def test_nothing_is_printed_and_nothing_is_left(self):
        script = "import wholehand as wh; d = wh.sweep('small', on='core'); assert d.score.size == 72"
        temporary = os.path.abspath("tmp")
        os.mkdir(temporary)
        done = subprocess.run(
            [sys.executable, "-c", script], capture_output=True, text=True, env=os.environ | {"TMPDIR": temporary}
        )
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        self.assertEqual(os.listdir(temporary), [])

    def test_what_is_refused_is_refused_in_the_programs_words(self):
        pathlib.Path("scene.toml").write_text(SEVERAL)
        pathlib.Path("text.nc").write_text("not a result")
        os.mkdir("folder")
        pairs = [
            ({"on": "no-such"}, ["--on", "no-such"]),
            ({"precision": "half"}, ["--precision", "half"]),
            ({"best": -1}, ["--best", "-1"]),
            ({"threads": 2000}, ["--threads", "2000"]),
            ({"output": "nowhere/own.nc"}, ["-o", "nowhere/own.nc"]),
            ({"output": "text.nc"}, ["-o", "text.nc"]),
            ({"output": "folder"}, ["-o", "folder"]),
            ({"output": "scene.toml"}, ["-o", "scene.toml"]),
        ]
        for named, options in pairs:
            on = {} if "on" in named else {"on": "core"}
            error = self.refused(wh.sweep, "scene.toml", **named, **on)
            self.assertEqual(
                (error.exit_code, str(error)), complaint("sweep", "scene.toml", *options, *(["--on", "core"] if on else []))
            )
        self.assertTrue(
            str(self.refused(wh.sweep, SEVERAL, keep="joint", on="core")).startswith('keep: unknown variable "joint"; known: ')
        )
        self.assertIn("output", str(self.refused(wh.sweep, SEVERAL, resume=True)))
        self.assertEqual(pathlib.Path("text.nc").read_text(), "not a result")

    def test_notes_are_warnings(self):
        with self.assertWarnsRegex(wh.Note, r"\[robust\]"):
            wh.sweep(SEVERAL + "[robust]\nazimuth_deg = 3\ncount = 8\n", on="core", best=0)

    def test_two_threads_wait_for_each_other(self):
        expected = wh.sweep(SEVERAL, on="core")["score"].values
        found = [None] * 4

        def work(k):
            found[k] = wh.sweep(SEVERAL, on="core")["score"].values

        threads = [threading.Thread(target=work, args=(k,)) for k in range(len(found))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for one in found:
            np.testing.assert_array_equal(one, expected)

    def interrupted(self, number, script):
        """How a sweep of a minute and more ends that gets a signal once it is under way."""
        pathlib.Path("long.toml").write_text(SEVERAL.replace("count = 5", "count = 20000"))
        with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
            try:
                ends = time.monotonic() + 100
                while not os.path.exists("long.nc.partial.mark") and child.poll() is None and time.monotonic() < ends:
                    time.sleep(0.02)
                child.send_signal(number)
                out, errors = child.communicate(timeout=100)
            finally:
                child.kill()
        return child.returncode, out, errors

    def test_ctrl_c_ends_it_and_it_goes_on_from_there(self):
        script = (
            "import os, wholehand as wh\n"
            "try:\n"
            "    wh.sweep('long.toml', on='core', keep='score', output='long.nc')\n"
            "except KeyboardInterrupt:\n"
            "    print('stopped', wh.sweep('small', on='core').score.size)\n"
        )
        code, out, errors = self.interrupted(signal.SIGINT, script)
        self.assertEqual((code, out), (0, "stopped 72\n"), errors)
        self.assertTrue(os.path.exists("long.nc.partial"))
        self.assertFalse(os.path.exists("long.nc"))

    def test_a_signal_that_ends_processes_ends_this_one(self):
        code, out, errors = self.interrupted(
            signal.SIGTERM, "import wholehand as wh; wh.sweep('long.toml', on='core', keep='score', output='long.nc')"
        )
        self.assertEqual((code, out), (-signal.SIGTERM, ""), errors)


if __name__ == "__main__":
    unittest.main()
