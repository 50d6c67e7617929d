# SPDX-License-Identifier: MIT
"""A sweep as a Dataset is the program's result file; it keeps quiet, and ends when it is asked to."""

import os
import pathlib
import pickle
import pty
import signal
import subprocess
import sys
import threading
import time
import unittest
import unittest.mock

import numpy as np
import wholehand as wh
import xarray as xr

from harness import PROGRAM, complaint, run
from installed import MESH, SEVERAL, SOBOL, InFolder, tube_ply

OF_THE_RUN = {"wall_time_s", "kernel_time_s"}


class Sweep(InFolder):
    def same(self, found, file):
        """All of it but the checksums: names, dimensions, coordinates, values to the bit, attributes; but what a clock says."""
        with xr.open_dataset(file, drop_variables="checksums") as stored:
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
            self.assertNotIn("source", found.encoding)  # it is in memory, and its file is gone
        self.assertEqual([name for name in os.listdir(".") if "partial" in name], [])

    def test_its_options_are_the_programs(self):
        pathlib.Path("scene.toml").write_text(SEVERAL)
        run("sweep", "scene.toml", "--on", "core", "--precision", "float", "--best", 7, "--no-refine")
        self.same(wh.sweep("scene.toml", on="core", precision="float", best=7, refine=False), "scene.nc")
        self.assertEqual(wh.sweep("scene.toml", on="core", threads=1).attrs["device"], "core, 1 thread")
        pathlib.Path("kept.toml").write_text(SEVERAL.replace("[output]", '[output]\nkeep = ["score", "joints", "reason"]'))
        run("sweep", "kept.toml", "--on", "core")
        found = wh.sweep(SEVERAL, on="core", keep=["joints", "reason", "score"])
        with xr.open_dataset("kept.nc", drop_variables="checksums") as stored:
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

    def test_an_option_of_another_kind_is_named(self):
        for named, words in (
            ({"threads": "many"}, "sweep: threads is str; allowed: a whole number"),
            ({"on": 3}, "sweep: on is int; allowed: a text"),
            ({"refine": 1}, "sweep: refine is int; allowed: True or False"),
            ({"keep": [5]}, "variables: int among the names; allowed: names of scene.variables()"),
        ):
            with self.assertRaises(TypeError) as caught:
                wh.sweep("small", **{"on": "core"} | named)
            self.assertEqual(str(caught.exception), words)
        self.assertIn("too large", str(self.refused(wh.sweep, "small", on="core", best=1 << 40)))

    def test_a_terminal_shows_nothing(self):
        pathlib.Path("tube.ply").write_text(tube_ply())
        pathlib.Path("scene.toml").write_text(MESH)
        script = (
            "import wholehand as wh\n"
            "data = wh.sweep('scene.toml', on='core', best=2)\n"
            "wh.best(data)\n"
            "wh.evaluate('scene.toml', 0, [[0.045, 0, 0, 0, 0, 1]])\n"
            "wh.grip('scene.toml', 0, height_mm=45)\n"
        )
        shown = {}
        for label, command in (("package", [sys.executable, "-c", script]), ("program", [PROGRAM, "sweep", "scene.toml"])):
            terminal, of_child = pty.openpty()
            done = subprocess.run(
                command, stdout=subprocess.DEVNULL, stderr=of_child, env=os.environ | {"XDG_CACHE_HOME": os.path.abspath(label)}
            )
            os.set_blocking(terminal, False)
            try:
                shown[label] = os.read(terminal, 100_000)
            except BlockingIOError:
                shown[label] = b""
            os.close(of_child)
            os.close(terminal)
            self.assertEqual(done.returncode, 0, shown[label])
        self.assertIn(b"distances to its mesh", shown["program"])  # so the terminal is one
        self.assertEqual(shown["package"], b"")

    def test_notes_are_warnings(self):
        with self.assertWarnsRegex(wh.Note, r"\[robust\]"):
            wh.sweep(SEVERAL + "[robust]\nazimuth_deg = 3\ncount = 8\n", on="core", best=0)

    def test_its_files_are_opened_and_closed_under_the_lock_of_the_library(self):
        """Not only read, as xarray does it: another thread's sweep may be writing. Without, one in some dozen runs of the Dask example
        crashed on a busy machine.
        """
        from xarray.backends.file_manager import CachingFileManager
        from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

        seen = []

        def watched(method):
            def call(manager, *arguments, **named):
                seen.append((method.__name__, all(lock.locked() for lock in NETCDF4_PYTHON_LOCK.locks)))
                return method(manager, *arguments, **named)

            return call

        opens, closes = CachingFileManager.acquire_context, CachingFileManager.close
        with (
            unittest.mock.patch.object(CachingFileManager, "acquire_context", watched(opens)),
            unittest.mock.patch.object(CachingFileManager, "close", watched(closes)),
        ):
            wh.sweep(SEVERAL, on="core")
            in_memory = len(seen)
            kept = wh.sweep(SEVERAL, on="core", output="own.nc")
            float(kept.score.max())
            again = pickle.loads(pickle.dumps(kept))  # as Dask sends it to another process
            np.testing.assert_array_equal(again.score.values, kept.score.values)
            again.close()
            kept.close()
        names = [name for name, _ in seen]
        self.assertIn("close", names[:in_memory])
        self.assertGreaterEqual(names[in_memory:].count("close"), 2)
        self.assertIn("acquire_context", names)
        self.assertEqual([name for name, is_locked in seen if not is_locked], [])
        self.assertFalse(any(lock.locked() for lock in NETCDF4_PYTHON_LOCK.locks))

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

    def test_ctrl_c_while_meshes_are_read_ends_it_too(self):
        many = MESH.replace("height_mm = [30, 60]", "height_mm = { from = 10, to = 80, count = 30000 }")
        pathlib.Path("scene.toml").write_text(many)
        pathlib.Path("tube.ply").write_text(tube_ply(sides=500))
        script = (
            "import wholehand as wh\n"
            "try:\n"
            "    wh.sweep('scene.toml', on='core', keep='score', best=0, output='own.nc')\n"
            "except KeyboardInterrupt:\n"
            "    print('stopped')\n"
        )
        environment = os.environ | {"XDG_CACHE_HOME": os.path.abspath("cache")}
        with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, env=environment) as child:
            try:
                ends = time.monotonic() + 100
                # the lock is there before meshes are read, and the partial file after
                while not os.path.exists("own.nc.partial.lock") and child.poll() is None and time.monotonic() < ends:
                    time.sleep(1e-3)
                child.send_signal(signal.SIGINT)
                self.assertEqual(child.communicate(timeout=100)[0], "stopped\n")
            finally:
                child.kill()
        self.assertFalse(os.path.exists("own.nc"))

    def test_a_signal_that_ends_processes_ends_this_one(self):
        code, out, errors = self.interrupted(
            signal.SIGTERM, "import wholehand as wh; wh.sweep('long.toml', on='core', keep='score', output='long.nc')"
        )
        self.assertEqual((code, out), (-signal.SIGTERM, ""), errors)


if __name__ == "__main__":
    unittest.main()
