# SPDX-License-Identifier: MIT
"""One sweep by many ranks: the answer of one machine, whoever dies on the way. Ranks here are more than processors."""

import json
import os
import random
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import netCDF4

PROGRAM, MPI_PROGRAM = os.environ["WHOLEHAND_PROGRAM"], os.environ["WHOLEHAND_MPI_PROGRAM"]
# what Open MPI asks of who is root, and of who has no network and few processors. Once a rank has ended badly, mpirun would wait a second or
# two before it kills the others. Its library hwloc has a line of its own where /sys is not there, as in a bare root folder
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_btl": "self,vader", "OMPI_MCA_plm": "isolated", "OMPI_MCA_hwloc_base_binding_policy": "none", "OMPI_MCA_odls_base_sigkill_timeout": "0",
               "HWLOC_HIDE_ERRORS": "2"}
PATIENCE = 240  # s: of a busy machine
TIMES = {"device", "driver", "wall_time_s", "kernel_time_s"}

VESSELS = """
[[vessel]]
name = "wide"
shape = "cylinder"
diameter_mm = 70
height_mm = 110
wall_mm = 1.5

[[vessel]]
name = "narrow"
shape = "cylinder"
diameter_mm = 50
height_mm = 90
wall_mm = 1.5
"""
HELD = """
[liquid]
fills = [0, 1]

[table]

[strength]

[tilts]
deg = [0, 45]
"""
SMALL = VESSELS + HELD + """
[grips]
height_fraction = { from = 0.1, to = 0.95, count = 20 }
obliquity_deg = { from = -15, to = 20, count = 4 }
roll_deg = { from = -90, to = 30, count = 13 }
hand_scale = [0.9, 1]
"""
# some seconds of two processors
LARGE = SMALL.replace("count = 20", "count = 600").replace("hand_scale = [0.9, 1]", "")
POINTS = VESSELS + HELD + """
[robust]
height_mm = 2
friction = 0.05
count = 16

[grips]
height_fraction = { from = 0.1, to = 0.95 }
obliquity_deg = { from = -15, to = 20 }
roll_deg = { from = -90, to = 30 }
sampling = "sobol"
count = 3000
"""
# lists whose candidates may be near to each other: the backend chooses them, more than are listed
NEAR = POINTS.replace("count = 3000", "count = 1000") + """
[output]
apart_mm = 0
best = 4
"""
BARE = VESSELS + """
[output]
keep = []

[grips]
height_fraction = { from = 0.1, to = 0.95, count = 200 }
roll_deg = { from = -90, to = 30, count = 13 }
"""
# more grips than a pass keeps (16,384), and nearly all alike: lists that take a second pass
ALIKE = VESSELS + """
[output]
apart_mm = 150
keep = ["score", "plausible"]

[grips]
height_fraction = { from = 0.1, to = 0.95, count = 4000 }
roll_deg = { from = -90, to = 30, count = 13 }
"""


def content(path):
    """Every value of a result, bit for bit, and its attributes but for times and devices, which the checksums cover, too."""
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        values = {}
        for name, variable in file.variables.items():
            if name == "checksums":
                continue
            data = variable[...]
            values[name] = data.tobytes() if variable.dtype is not str else str(data)
        return values, {name: str(file.getncattr(name)) for name in file.ncattrs() if name not in TIMES}


def rows(path):
    """A list of best grips without the result's own name and number."""
    with open(path, encoding="utf-8") as file:
        lines = [line.rstrip("\n").split(",") for line in file]
    keep = [k for k, name in enumerate(lines[0]) if name not in ("result", "sweep")]
    return [[line[k] for k in keep] for line in lines]


def differing_bytes(path, other):
    with open(path, "rb") as one, open(other, "rb") as two:
        own, others = one.read(), two.read()
    return sum(a != b for a, b in zip(own, others)) + abs(len(own) - len(others)) * len(own)


class Job(unittest.TestCase):
    """What the tests below start and compare."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="ranks.")
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def command(self, ranks, *arguments, program=MPI_PROGRAM):
        return ["mpirun", "-q", "-n", str(ranks), program, "sweep", *arguments, "--on", "core", "--threads", "1"]

    def start(self, command, **more):
        return subprocess.Popen(command, env=ENVIRONMENT, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, start_new_session=True, **more)

    def end(self, process):
        try:
            out, errors = process.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            self.fail(f"it hangs: {process.args}")
        return process.returncode, out, errors

    def run_ranks(self, ranks, *arguments, **more):
        return self.end(self.start(self.command(ranks, *arguments), **more))

    def alone(self, scene, output, *more):
        result = self.end(self.start([PROGRAM, "sweep", scene, "-o", output, "--on", "core", *more]))
        self.assertEqual(result[0], 0, result)
        return result

    known = {}  # results of one machine, by their scenes

    @classmethod
    def tearDownClass(cls):
        for folder in cls.known.values():
            shutil.rmtree(folder)
        cls.known.clear()

    def given(self, scene, output):
        """The result of one machine, computed once for all tests that compare with it."""
        with open(scene, encoding="utf-8") as file:
            text = file.read()
        if text not in self.known:
            self.alone(scene, output)
            self.known[text] = tempfile.mkdtemp(prefix="ranks.")
            shutil.copy(self.path(output), self.known[text] + "/result.nc")
        shutil.copy(self.known[text] + "/result.nc", self.path(output))

    def assert_same(self, one, other):
        values, attributes = content(self.path(one))
        others, other_attributes = content(self.path(other))
        self.assertEqual([name for name in values if values[name] != others.get(name)], [])
        self.assertEqual(attributes, other_attributes)
        self.assertEqual(list(values), list(others))

    def marked(self, output):
        """How many grips of each shard the mark knows; "": of the result itself."""
        try:
            with open(self.path(output + ".partial.mark"), encoding="utf-8") as file:
                vessels = json.loads(file.read().split("\n", 1)[1])["vessels"]
        except OSError:
            return {}
        grips = {}
        for first, last, _, *shard in [stretch for vessel in vessels for stretch in vessel["stretches"]]:
            grips["".join(shard)] = grips.get("".join(shard), 0) + last - first
        return grips

    def interrupt(self, process, output, when=lambda marked: sum(marked.values()) > 0):
        """Ends a run once its mark knows enough: a busy machine takes its time for that."""
        code, errors = self.signalled(process, output, when)
        self.assertEqual(code, 130, errors)
        return errors

    def await_mark(self, process, output, when):
        """Until the mark knows enough, or the run has ended: a busy machine takes its time for either."""
        for _ in range(50 * PATIENCE):
            if process.poll() is not None or when(self.marked(output)):
                break
            time.sleep(0.02)

    def signalled(self, process, output, when):
        self.await_mark(process, output, when)
        process.send_signal(signal.SIGUSR1)  # which mpirun hands on, as srun does
        code, _, errors = self.end(process)
        return code, errors

    def start_nodes(self, nodes, *arguments, folders=()):
        """Ranks whose files have the names of so many nodes: {"a": 2, "b": 1}. Some work in folders of their names."""
        command = ["mpirun", "-q"]
        for name, ranks in nodes.items():
            own = [MPI_PROGRAM, "sweep", *arguments, "--on", "core", "--threads", "1", "--shard", name]
            command += ["-n", str(ranks), *(["--wdir", self.path(name)] if name in folders else []), *own, ":"]
        return self.start(command[:-1])

    def run_nodes(self, nodes, *arguments, folders=()):
        return self.end(self.start_nodes(nodes, *arguments, folders=folders))

    def partial_files(self, output=""):
        """What a job that did not end has left, of one result or of all."""
        return [file for file in os.listdir(self.folder) if output + ".partial" in file]

    def merge(self, result, *more):
        return self.end(self.start([PROGRAM, "merge", result, *more]))

    def await_file(self, name, process):
        for _ in range(20 * PATIENCE):
            if os.path.exists(self.path(name)):
                return
            if process.poll() is not None:
                break
            time.sleep(0.05)
        self.fail(f"{name} did not come: {self.end(process)}")

    def ranks_of(self, process):
        found = subprocess.run(["pgrep", "-g", "0", "-P", str(process.pid)], capture_output=True, text=True, check=False).stdout
        if not found:
            found = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=False).stdout
        return [int(number) for number in found.split()]

    def catches(self, process, number):
        try:
            with open(f"/proc/{process}/comm", encoding="utf-8") as file:
                if not MPI_PROGRAM.endswith("/" + file.read().strip()):
                    return False
            with open(f"/proc/{process}/status", encoding="utf-8") as file:
                caught = [line for line in file if line.startswith("SigCgt:")][0]
        except OSError:
            return False
        return bool(int(caught.split()[1], 16) >> (number - 1) & 1)


class Ranks(Job):
    """The same answer, whoever dies, and one job for one file."""

    def test_any_number_of_ranks_gives_the_answer_of_one_machine(self):
        for name, scene in {"grid": SMALL, "points": POINTS, "near": NEAR, "bare": BARE}.items():
            path = self.write(name + ".toml", scene)
            alone = self.alone(path, name + ".nc", "--threads", "1")
            words = None
            for ranks in (1, 2, 3, 4, 7) if name == "grid" else (1, 3):
                output = f"{name}{ranks}.nc"
                code, out, errors = self.run_ranks(ranks, path, "-o", output)
                self.assertEqual((code, errors), (0, alone[2]))
                self.assert_same(name + ".nc", output)
                if ranks == 1:
                    # its device has the same name: two times of 8 bytes differ, what sums them up (4 bytes), and two checksums of 32
                    self.assertLessEqual(differing_bytes(self.path(name + ".nc"), self.path(output)), 24 + 2 * 32)
                self.assertEqual(rows(self.path(name + ".best.csv")), rows(self.path(f"{name}{ranks}.best.csv")))
                # counts and tables in the same words; lines of devices and times differ
                said = [line.replace(f"{name}{ranks}.", f"{name}.") for line in out.split("\n") if line.startswith(("wide:", "narrow:", "  "))]
                words = words or said
                self.assertEqual(said, words)
                self.assertGreater(len(said), 4)
                maps = [file for file in os.listdir(self.folder) if file.startswith(f"{name}{ranks}.") and file.endswith(".svg")]
                for file in maps:
                    with open(self.path(file), "rb") as own, open(self.path(name + file[len(f"{name}{ranks}"):]), "rb") as other:
                        self.assertEqual(own.read(), other.read(), file)
                self.assertEqual(len(maps), 0 if name == "bare" else 2)
                self.assertEqual(self.partial_files(), [])

    def test_lists_that_take_passes(self):
        path = self.write("alike.toml", ALIKE)
        self.given(path, "alike.nc")
        with netCDF4.Dataset(self.path("alike.nc")) as file:
            file.set_auto_maskandscale(False)
            scores = file["score"][0][file["plausible"][0] == 1]
            last = file["best_score"][0][file["best_grip"][0] >= 0][-1]
            self.assertGreater((scores > last).sum(), 16384, "one pass is enough")
        code, _, errors = self.run_ranks(3, path, "-o", "passes.nc")
        self.assertEqual(code, 0, errors)
        self.assert_same("alike.nc", "passes.nc")
        # whoever resumes has not seen all scores: they read them in the file, or compute them again where it has none
        bare = self.write("bare.toml", ALIKE.replace('keep = ["score", "plausible"]', 'keep = ["gap"]'))
        self.alone(bare, "bare.nc")
        for scene, whole in ((path, "alike.nc"), (bare, "bare.nc")):
            output = "again." + whole
            self.interrupt(self.start(self.command(2, scene, "-o", output, "--mark-seconds", "0.05")), output)
            code, _, errors = self.run_ranks(3, scene, "-o", output, "--resume")
            self.assertEqual(code, 0, errors)
            self.assertIn("grips are there", errors)
            self.assert_same(whole, output)

    def test_another_file_of_the_name_is_not_written(self):
        path = self.write("a.toml", SMALL)
        for name in ("one", "other"):
            os.mkdir(self.path(name))
        self.write("other/a.nc.partial", "of an earlier job")
        own = [MPI_PROGRAM, "sweep", path, "-o", "a.nc", "--on", "core"]
        where = ["--wdir", self.path("one")], ["--wdir", self.path("other")]
        code, out, errors = self.end(self.start(["mpirun", "-q", "-n", "1", *where[0], *own, ":", "-n", "1", *where[1], *own]))
        self.assertEqual(code, 3, errors)
        self.assertEqual(len(errors.strip().split("\n")), 1, errors)
        self.assertRegex(errors, r"wholehand: rank 1 on \S+: a.nc.partial is another file here than on rank 0; ")
        self.assertNotIn("wrote", out)
        with open(self.path("other/a.nc.partial"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "of an earlier job")

    def test_a_rank_that_is_killed_costs_little(self):
        chance = random.Random(15)
        path = self.write("large.toml", LARGE)
        self.given(path, "large.nc")
        with netCDF4.Dataset(self.path("large.nc")) as file:
            all_grips = file["reason"].size
        killed = 0
        for _ in range(40):
            if killed == 10:
                break
            before = sum(self.marked("killed.nc").values())
            resume = ["--resume"] if before else []
            process = self.start(self.command(chance.choice((2, 3, 4)), path, "-o", "killed.nc", "--mark-seconds", "0.05", *resume))
            # one in four is killed as soon as there are ranks, the others when a part of the grips that were left is marked
            if chance.random() < 0.25:
                self.await_mark(process, "killed.nc", lambda _: self.ranks_of(process))
            else:
                enough = before + chance.uniform(0, 0.5) * (all_grips - before)
                self.await_mark(process, "killed.nc", lambda marked: sum(marked.values()) > enough)
            victims = self.ranks_of(process)
            is_hit = bool(victims) and process.poll() is None
            if is_hit:
                os.kill(chance.choice(victims), signal.SIGKILL)
            code, _, errors = self.end(process)
            self.assertNotIn(code, (2, 3), errors)  # which the program gives itself
            self.assertTrue(is_hit or code == 0, errors)
            killed += code != 0
            if killed % 3 == 0 and self.marked("killed.nc"):
                code, _, errors = self.run_ranks(chance.choice((1, 2, 5)), path, "-o", "killed.nc", "--resume")
                self.assertEqual(code, 0, errors)
                self.assertIn("grips are there", errors)
            if os.path.exists(self.path("killed.nc")):  # none where the end came first
                self.assert_same("large.nc", "killed.nc")
                os.remove(self.path("killed.nc"))
        self.assertEqual(killed, 10)
        code, _, errors = self.run_ranks(3, path, "-o", "killed.nc", "--resume")
        self.assertEqual(code, 0, errors)
        self.assert_same("large.nc", "killed.nc")

    def test_one_machine_goes_on_where_ranks_ended_and_ranks_where_it_did(self):
        path = self.write("large.toml", LARGE)
        self.given(path, "large.nc")
        own = [PROGRAM, "sweep", path, "-o", "a.nc", "--on", "core", "--threads", "1"]
        self.interrupt(self.start(self.command(2, path, "-o", "a.nc", "--mark-seconds", "0.05")), "a.nc")
        code, _, errors = self.end(self.start([*own, "--resume"]))
        self.assertEqual(code, 0, errors)
        self.assertIn("grips are there", errors)
        self.assert_same("large.nc", "a.nc")
        os.remove(self.path("a.nc"))
        self.await_mark(alone := self.start([*own, "--mark-seconds", "0.05"]), "a.nc", lambda marked: sum(marked.values()) > 0)
        alone.send_signal(signal.SIGINT)
        self.assertEqual(self.end(alone)[0], 130)
        code, _, errors = self.run_ranks(3, path, "-o", "a.nc", "--resume")
        self.assertEqual(code, 0, errors)
        self.assertIn("grips are there", errors)
        self.assert_same("large.nc", "a.nc")

    def test_ranks_of_another_scene_or_code_are_refused(self):
        path, other = self.write("a.toml", SMALL), self.write("b.toml", SMALL.replace("110", "111"))
        own = [MPI_PROGRAM, "sweep", path, "-o", "a.nc", "--on", "core"]
        another_code = self.path("wholehand-mpi")
        with open(MPI_PROGRAM, "rb") as file:
            program = bytearray(file.read())
        first_digit = re.search(rb"sha1-[0-9a-f]{40}\x00", program).start() + 5
        program[first_digit] = ord("1") if program[first_digit] == ord("0") else ord("0")
        with open(another_code, "wb") as file:
            file.write(program)
        os.chmod(another_code, 0o755)
        for what, command in {"text of the scene": [MPI_PROGRAM, "sweep", other, *own[3:]], "code": [another_code, *own[1:]]}.items():
            code, out, errors = self.end(self.start(["mpirun", "-q", "-n", "1", *own, ":", "-n", "1", *command]))
            self.assertEqual((code, out), (2, ""), errors)
            lines = errors.strip().split("\n")
            self.assertEqual(len(lines), 1, errors)
            name = "sha1-" if what == "code" else ""
            self.assertRegex(lines[0], rf"wholehand: rank 1 on \S+ has another {what}: {name}[0-9a-f]+, and rank 0 on \S+ has {name}[0-9a-f]+; ")
            self.assertFalse([name for name in os.listdir(self.folder) if name.startswith("a.nc")])

    def test_one_job_writes_a_file(self):
        # longer than a second job takes to start
        path = self.write("large.toml", LARGE.replace("count = 600", "count = 2400"))
        first = self.start(self.command(2, path, "-o", "one.nc"))
        for _ in range(600):
            if os.path.exists(self.path("one.nc.partial")):
                break
            time.sleep(0.05)
        code, out, errors = self.run_ranks(2, path, "-o", "one.nc")
        self.assertEqual(code, 2, errors)
        self.assertEqual(len(errors.strip().split("\n")), 1, errors)
        self.assertIn("one.nc", errors)
        self.assertEqual(self.end(first)[0], 0)


class Shards(Job):
    """Nodes that share no file system."""

    def refused_merge(self, code, result, *more):
        """The line with which a merge refuses."""
        found, out, errors = self.merge(result, *more)
        self.assertEqual((found, out, len(errors.strip().split("\n"))), (code, "", 1), errors)
        return errors

    def sweep_to_shards(self, path, name, output):
        """The shards of nodes that leave no result file."""
        code, out, errors = self.run_nodes({"a": 2, "b": 1, "c": 1}, path, "-o", output)
        self.assertEqual((code, errors), (0, ""))
        self.assertIn(f"`wholehand merge {output}` makes one file", out)
        self.assertFalse(os.path.exists(self.path(output)))
        self.assertEqual(rows(self.path(name + ".best.csv")), rows(self.path(name + "s.best.csv")))
        shards = [file for file in os.listdir(self.folder) if file.startswith(output) and file.endswith(".shard")]
        self.assertTrue(shards, out)
        return shards

    def refuse_missing_shards(self, output, shards, folder):
        """Moves the shards to a folder that the merge does not know."""
        os.mkdir(self.path(folder))
        for file in shards:
            os.rename(self.path(file), self.path(f"{folder}/{file}"))
        errors = self.refused_merge(2, output)
        self.assertTrue(all(file in errors for file in shards), errors)

    def refuse_foreign_shards(self, output, shards, folder):
        """Neither a shard of another sweep nor a folder of its name is taken for a shard."""
        os.mkdir(self.path(folder))
        for file in shards:
            self.write(f"{folder}/{file}", "wholehand shard of sweep 0123456789abcdef0123456789abcdef\n")
        errors = self.refused_merge(2, output, "--from", folder)
        self.assertTrue(all(f"{folder}/{file} is a shard of another sweep" in errors for file in shards), errors)
        os.remove(self.path(f"{folder}/{shards[0]}"))
        os.mkdir(self.path(f"{folder}/{shards[0]}"))
        self.assertIn(f"{folder}/{shards[0]} is no file", self.refused_merge(2, output, "--from", folder))

    def refuse_damaged_mark(self, output, folder):
        """A mark that was damaged on its way is to be copied again."""
        mark = self.path(output + ".partial.mark")
        with open(mark, "rb") as file:
            whole = file.read()
        with open(mark, "wb") as file:
            file.write(whole[:-1] + b"?")
        errors = self.refused_merge(3, output, "--from", folder)
        self.assertRegex(errors, r"^wholehand: \S+\.mark: is damaged: .+; copy it again from where the sweep ran\n$")
        with open(mark, "wb") as file:
            file.write(whole)

    def refuse_to_overwrite(self, output, folder):
        self.write(output, "notes of somebody")
        errors = self.refused_merge(2, output, "--from", folder)
        self.assertEqual(errors, f"wholehand: {output} is there and is no result file; move it away, and merge again\n")
        with open(self.path(output), encoding="utf-8") as file:
            self.assertEqual(file.read(), "notes of somebody")
        os.remove(self.path(output))

    def merge_on_full_disk(self, output, folder):
        limited = ["sh", "-c", 'ulimit -f 200; exec "$@"', "sh", PROGRAM, "merge", output, "--from", folder]
        code, out, errors = self.end(self.start(limited))
        self.assertEqual((code, out, len(errors.strip().split("\n"))), (3, "", 1), errors)
        self.assertIn("make room, and merge again", errors)

    def merge_after_kills(self, output, folder):
        """Merges once more after a merge was killed. Removes what a kill that came too late left of the mark."""
        for _ in range(4):
            killed = self.start([PROGRAM, "merge", output, "--from", folder])
            while killed.poll() is None and not os.path.exists(self.path(output + ".partial.lock")):
                pass
            killed.kill()
            if self.end(killed)[0] == 0 or os.path.exists(self.path(output)):
                break
        if os.path.exists(self.path(output)):
            for file in self.partial_files(output):
                os.remove(self.path(file))
        else:
            code, _, errors = self.merge(output, "--from", folder)
            self.assertEqual((code, errors), (0, ""))

    def test_shards_become_the_file_of_one_machine(self):
        # enough pieces that no node comes too late for its first
        for name, scene in {"grid": SMALL.replace("count = 20", "count = 160"), "points": POINTS.replace("3000", "12000")}.items():
            path, output = self.write(name + ".toml", scene), name + "s.nc"
            self.alone(path, name + ".nc")
            shards = self.sweep_to_shards(path, name, output)
            self.refuse_missing_shards(output, shards, folder=name)
            self.refuse_foreign_shards(output, shards, folder=name + "other")
            self.refuse_damaged_mark(output, folder=name)
            self.refuse_to_overwrite(output, folder=name)
            self.merge_on_full_disk(output, folder=name)
            self.merge_after_kills(output, folder=name)
            self.assert_same(name + ".nc", output)
            self.assertEqual(self.partial_files(), [])
            self.assertIn("nothing is left to merge", self.refused_merge(2, output))
            self.assertIn(".partial is not there; name the result", self.refused_merge(2, path))

    def test_shards_without_grips_do_not_stay(self):
        path = self.write("tiny.toml", SMALL.replace("count = 20", "count = 2"))  # less than a piece of each vessel
        self.alone(path, "tiny.nc")
        code, out, errors = self.run_nodes({"a": 1, "b": 1, "c": 1, "d": 1, "e": 1, "f": 1}, path, "-o", "t.nc")
        self.assertEqual((code, errors), (0, ""))
        shards = [file for file in os.listdir(self.folder) if file.endswith(".shard")]
        self.assertLess(len(shards), 2, shards)
        if shards:
            self.assertEqual(self.merge("t.nc")[0], 0)
        self.assert_same("tiny.nc", "t.nc")

    def test_a_sweep_with_shards_goes_on_with_other_nodes(self):
        path = self.write("large.toml", LARGE)
        self.given(path, "large.nc")
        quick = ["-o", "s.nc", "--mark-seconds", "0.05"]
        self.interrupt(self.start_nodes({"a": 1, "b": 1, "c": 1}, path, *quick), "s.nc", lambda marked: {"", "b", "c"} <= set(marked))
        before = self.marked("s.nc")
        code, _, errors = self.merge("s.nc")
        self.assertEqual(code, 3, errors)
        self.assertIn("did not end", errors)
        code, _, errors = self.run_ranks(2, path, "-o", "s.nc", "--resume")
        self.assertEqual(code, 2, errors)
        self.assertIn("another set of files", errors)
        # c takes no part any more, and b has lost its disk: what is computed again is marked on the way, and nothing else
        os.remove(self.path("s.nc.b.shard"))
        lost = before["b"] + before["c"]
        again = r"no rank has the shards? .+: computing ([\d,]+) grips again"
        errors = self.interrupt(self.start_nodes({"a": 1, "b": 2, "d": 1}, path, *quick, "--resume"), "s.nc",
                                lambda marked: "c" not in marked and marked.get("/b", 0) + marked.get("/c", 0) < lost)
        self.assertEqual(int(re.search(again, errors)[1].replace(",", "")), lost)
        now = self.marked("s.nc")
        left = now.get("/b", 0) + now.get("/c", 0)
        self.assertNotIn("c", now)
        self.assertLess(left, lost)
        if left:
            self.assertEqual(sum(now.values()), sum(before.values()))
        else:  # the signal came after the last of them, and new grips may follow
            self.assertGreaterEqual(sum(now.values()), sum(before.values()))
        code, out, errors = self.run_nodes({"a": 1, "b": 2, "d": 1}, path, "-o", "s.nc", "--resume")
        self.assertEqual(code, 0, errors)
        self.assertNotIn("are damaged", errors)
        found = re.search(again, errors)
        self.assertEqual(int(found[1].replace(",", "")) if found else 0, left)
        self.assertFalse([shard for shard in self.marked("s.nc") if shard.startswith("/")])
        os.remove(self.path("s.nc.c.shard"))
        # a damaged shard is found, and the sweep mends it
        with open(self.path("s.nc.b.shard"), "r+b") as file:
            file.seek(os.path.getsize(self.path("s.nc.b.shard")) - 100)
            file.write(b"\x01" * 8)
        code, out, errors = self.merge("s.nc")
        self.assertEqual((code, out), (3, ""), errors)
        self.assertRegex(errors, r"s.nc.b.shard: grips [\d,]+ to [\d,]+ of vessel \d are damaged; ")
        code, _, errors = self.run_nodes({"a": 1, "b": 1, "d": 1}, path, "-o", "s.nc", "--resume")
        self.assertEqual(code, 0, errors)
        self.assertRegex(errors, r"s.nc.b.shard: grips [\d,]+ to [\d,]+ of \w+ are damaged: computing them again")
        code, out, errors = self.merge("s.nc")
        self.assertEqual((code, errors), (0, ""))
        self.assert_same("large.nc", "s.nc")

    def test_shards_are_not_replaced_where_the_mark_is_elsewhere(self):
        path = self.write("large.toml", LARGE)
        self.given(path, "large.nc")
        for name in "ab":
            os.mkdir(self.path(name))
        arguments = [path, "-o", "s.nc", "--mark-seconds", "0.05"]
        self.interrupt(self.start_nodes({"a": 1, "b": 1}, *arguments, folders="ab"), "a/s.nc", lambda marked: "b" in marked)
        with open(self.path("b/s.nc.b.shard"), "rb") as file:
            shard = file.read()
        code, out, errors = self.run_nodes({"b": 1, "a": 1}, *arguments, "--resume", folders="ab")
        self.assertEqual((code, out, len(errors.strip().split("\n"))), (2, "", 1), errors)
        self.assertIn("s.nc.b.shard is here, but on the node of rank 0 there is no s.nc.partial.mark; ", errors)
        # nor where a new node is rank 0
        os.mkdir(self.path("c"))
        code, out, errors = self.run_nodes({"c": 1, "a": 1}, *arguments, "--resume", folders="ac")
        self.assertEqual((code, out, len(errors.strip().split("\n"))), (2, "", 1), errors)
        self.assertIn("s.nc.partial.mark is here, but on the node of rank 0 there is no s.nc.partial.mark; ", errors)
        with open(self.path("b/s.nc.b.shard"), "rb") as file:
            self.assertEqual(file.read(), shard)
        self.assertFalse([name for name in os.listdir(self.path("b")) if name.startswith("s.nc.partial")])
        code, out, errors = self.run_nodes({"a": 1, "b": 1}, *arguments, "--resume", folders="ab")
        self.assertEqual(code, 0, errors)
        self.assertNotIn("again", errors)
        os.symlink(self.path("b/s.nc.b.shard"), self.path("a/s.nc.b.shard"))
        code, out, errors = self.merge("a/s.nc")
        self.assertEqual((code, errors), (0, ""))
        self.assert_same("large.nc", "a/s.nc")
        # a sweep that begins anew says whose shard it replaces
        code, out, errors = self.run_nodes({"a": 1, "b": 1}, path, "-o", "s.nc", folders="ab")
        self.assertEqual(code, 0, errors)
        self.assertIn("s.nc.b.shard is a shard of another sweep: replacing it", errors)

    def test_passes_read_the_shards(self):
        path = self.write("alike.toml", ALIKE)
        self.given(path, "alike.nc")
        self.interrupt(self.start_nodes({"a": 1, "b": 1}, path, "-o", "again.nc", "--mark-seconds", "0.05"), "again.nc")
        code, _, errors = self.run_nodes({"a": 1, "b": 2}, path, "-o", "again.nc", "--resume")
        self.assertEqual(code, 0, errors)
        code, _, errors = self.merge("again.nc")
        self.assertEqual(code, 0, errors)
        self.assert_same("alike.nc", "again.nc")


class Endings(Job):
    """What ends a job early, and what is then left."""

    def test_a_rank_without_room_ends_all(self):
        path = self.write("large.toml", LARGE)
        self.given(path, "large.nc")
        own = [MPI_PROGRAM, "sweep", path, "-o", "full.nc", "--on", "core", "--mark-seconds", "0.05"]
        limited = ["sh", "-c", 'ulimit -f 16000; exec "$@"', "sh", *own]  # blocks of 512 bytes: its writes beyond 8 MB fail
        code, out, errors = self.end(self.start(["mpirun", "-q", "-n", "1", *own, ":", "-n", "1", *limited]))
        self.assertEqual(code, 3, errors)
        self.assertEqual(len(errors.strip().split("\n")), 1, errors)
        self.assertRegex(errors, r"wholehand: rank 1 on \S+: full.nc.partial: cannot write it: .+; make room and go on with --resume")
        self.assertNotIn("wrote", out)
        code, _, errors = self.run_ranks(3, path, "-o", "full.nc", "--resume")
        self.assertEqual(code, 0, errors)
        self.assert_same("large.nc", "full.nc")

    def test_a_file_that_another_job_took_is_left_alone(self):
        # as on two nodes whose file system has no locks
        path = self.write("large.toml", LARGE)
        first = self.start(self.command(2, path, "-o", "one.nc", "--mark-seconds", "0.05"))
        self.await_file("one.nc.partial.mark", first)
        self.write("other", "of another job")
        os.rename(self.path("other"), self.path("one.nc.partial"))
        code, out, errors = self.end(first)
        self.assertEqual(code, 3, errors)
        self.assertEqual(len(errors.strip().split("\n")), 1, errors)
        self.assertIn("wholehand: one.nc.partial: another job replaced this file meanwhile; ", errors)
        self.assertNotIn("wrote", out)
        with open(self.path("one.nc.partial"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "of another job")
        self.assertFalse(os.path.exists(self.path("one.nc")))

    def test_an_error_after_the_last_grip_leaves_all_of_them_marked(self):
        path = self.write("late.toml", LARGE.replace("count = 600", "count = 200"))
        self.alone(path, "whole.nc")
        process = self.start(self.command(2, path, "-o", "late.nc", "--mark-seconds", "80000"))
        self.await_file("late.nc.partial", process)
        os.mkdir(self.path("late.best.csv"))  # which cannot be written then
        code, _, errors = self.end(process)
        self.assertEqual(code, 3, errors)
        self.assertIn("late.best.csv", errors)
        os.rmdir(self.path("late.best.csv"))
        code, _, errors = self.run_ranks(3, path, "-o", "late.nc", "--resume")
        self.assertEqual(code, 0, errors)
        self.assertIn("late.nc.partial: 20,800 of 20,800 grips are there", errors)
        self.assert_same("whole.nc", "late.nc")

    def test_time_and_signals_close_it_cleanly(self):
        path = self.write("large.toml", LARGE)
        self.given(path, "large.nc")
        code, _, errors = self.run_ranks(2, path, "-o", "timed.nc", "--time-limit", "1")
        self.assertEqual(code, 130, errors)
        self.assertRegex(errors, r"wholehand: interrupted at [\d,]+ of [\d,]+ grips; the same command with --resume goes on")
        before = sum(self.marked("timed.nc").values())
        process = self.start(self.command(3, path, "-o", "timed.nc", "--resume", "--mark-seconds", "0.05"))
        code, errors = self.signalled(process, "timed.nc", lambda marked: sum(marked.values()) > before)
        self.assertIn(code, (0, 130), errors)  # a fast machine may have ended
        self.assertIn("grips are there", errors)
        if code:
            code, _, errors = self.run_ranks(1, path, "-o", "timed.nc", "--resume")
            self.assertEqual(code, 0, errors)
        self.assert_same("large.nc", "timed.nc")

    def test_the_time_limit_holds_while_the_best_are_reported(self):
        # robust scores that take longer than the grips
        # a fast machine gets more of them, and a busy one more time for its grips
        counts, seconds, code, errors = [(1500, 20), (4096, 20), (4096, 50)], 1, 0, ""
        while "interrupted at 200 of 200 grips; the same command with --resume goes on" not in errors:
            if code == 0:
                self.assertTrue(counts, "robust scores take no time")
                (count, best), seconds = counts.pop(0), 1
            else:
                seconds *= 2
            self.assertLessEqual(seconds, 64, errors)
            scene = POINTS.replace("count = 16", f"count = {count}").replace("count = 3000", "count = 100")
            path = self.write("robust.toml", scene + f"[output]\nbest = {best}\n")
            code, _, errors = self.run_ranks(2, path, "-o", "timed.nc", "--time-limit", str(seconds))
        self.assertEqual(code, 130, errors)
        self.alone(path, "robust.nc")
        code, _, errors = self.run_ranks(3, path, "-o", "timed.nc", "--resume")
        self.assertEqual(code, 0, errors)
        self.assert_same("robust.nc", "timed.nc")

    def test_a_signal_before_the_devices_are_open_closes_it_cleanly(self):
        path = self.write("a.toml", SMALL)
        own = [MPI_PROGRAM, "sweep", path, "-o", "a.nc", "--on", "core"]
        late = ["sh", "-c", 'until [ -e go ]; do sleep 0.05; done; exec "$@"', "sh", *own]
        process = self.start(["mpirun", "-q", "-n", "1", *own, ":", "-n", "1", *late])
        signalled = False
        for _ in range(20 * PATIENCE):
            for rank in self.ranks_of(process):
                # it waits for the other one
                if not signalled and self.catches(rank, signal.SIGUSR1):
                    os.kill(rank, signal.SIGUSR1)
                    signalled = True
            if signalled:
                break
            time.sleep(0.05)
        self.write("go", "")
        code, out, errors = self.end(process)
        self.assertTrue(signalled)
        self.assertEqual((code, out), (130, ""), errors)
        self.assertEqual(len(errors.strip().split("\n")), 1, errors)
        self.assertIn("wholehand: interrupted before the first grip; ", errors)
        self.assertFalse([name for name in os.listdir(self.folder) if name.startswith("a.nc")])

    def test_a_damaged_stretch_is_computed_again(self):
        path = self.write("large.toml", LARGE)
        self.given(path, "large.nc")
        self.interrupt(self.start(self.command(2, path, "-o", "torn.nc", "--mark-seconds", "0.05")), "torn.nc")
        with netCDF4.Dataset(self.path("torn.nc.partial")) as file:
            file.set_auto_maskandscale(False)
            first = file["gap"][...].ravel()[:8].tobytes()
        with open(self.path("torn.nc.partial"), "r+b") as file:
            at = file.read().index(first)
            file.seek(at)
            file.write(b"\x01" * 8)
        code, out, errors = self.run_ranks(3, path, "-o", "torn.nc", "--resume")
        self.assertEqual(code, 0, errors)
        self.assertIn("are damaged: computing them again", errors)
        self.assert_same("large.nc", "torn.nc")

    def test_an_error_of_any_rank_is_one_line(self):
        path = self.write("a.toml", SMALL)
        code, out, errors = self.run_ranks(3, self.path("none.toml"))
        self.assertEqual((code, out), (2, ""))
        self.assertEqual(len(errors.strip().split("\n")), 1, errors)
        code, out, errors = self.run_ranks(3, path, "-o", self.path("none/a.nc"))
        self.assertEqual((code, out, len(errors.strip().split("\n"))), (2, "", 1), errors)
        code, out, errors = self.run_ranks(2, path, "--time-limit", "1:2")
        self.assertEqual((code, out, len(errors.strip().split("\n"))), (2, "", 1), errors)
        # what the scene asks to keep is not there
        code, out, errors = self.run_ranks(3, self.write("keep.toml", SMALL.replace("[strength]", '[strength]\nefforts = false\n\n[output]\nkeep = ["push"]')))
        self.assertEqual((code, out, len(errors.strip().split("\n"))), (2, "", 1), errors)
        # ranks with different results, and a name that no file can have
        mixed = [MPI_PROGRAM, "sweep", path, "--on", "core", "-o"]
        code, out, errors = self.end(self.start(["mpirun", "-q", "-n", "1", *mixed, "a.nc", ":", "-n", "1", *mixed, "b.nc"]))
        self.assertEqual((code, out, len(errors.strip().split("\n"))), (2, "", 1), errors)
        self.assertRegex(errors, r"rank 1 on \S+ writes b.nc, and rank 0 on \S+ writes a.nc; name the same result on every node")
        for shard, result, line in (("n" * 101, "a.nc", "is no name for a file: .+, 100 of them at most"),
                                    ("n" * 100, "a" * 200 + ".nc", "a file's name has 255 letters at most; ")):
            code, out, errors = self.run_ranks(2, path, "-o", result, "--shard", shard)
            self.assertEqual((code, out, len(errors.strip().split("\n"))), (2, "", 1), errors)
            self.assertRegex(errors, line)
        self.assertFalse([name for name in os.listdir(self.folder) if ".nc" in name])
        # a folder of its own for each rank, and no --shards
        os.mkdir(self.path("apart"))
        code, out, errors = self.end(self.start(["mpirun", "-q", "-n", "1", *mixed, "a.nc", ":", "-n", "1", "--wdir", self.path("apart"), *mixed, "a.nc"]))
        self.assertEqual((code, len(errors.strip().split("\n"))), (3, 1), errors)
        self.assertNotIn("wrote", out)
        self.assertRegex(errors, r"rank 1 on \S+: a.nc.partial is not there, though rank 0 has it; .+ or ask for --shards")
        # rank 1 alone has nothing to read
        own = [MPI_PROGRAM, "sweep", path, "-o", "a.nc", "--on", "core"]
        code, out, errors = self.end(self.start(["mpirun", "-q", "-n", "1", *own, ":", "-n", "1", MPI_PROGRAM, "sweep", "none.toml", *own[3:]]))
        self.assertEqual((code, out, len(errors.strip().split("\n"))), (2, "", 1), errors)
        self.assertIn("rank 1 on ", errors)

    def test_a_failure_before_the_first_step_on_one_rank_ends_all(self):
        path = self.write("a.toml", SMALL)
        own = [MPI_PROGRAM, "sweep", path, "-o", "a.nc", "--on", "core"]
        poor = ["sh", "-c", 'ulimit -n 20; exec "$@"', "sh", *own]
        said = "only . of the 48 files that the program may need can be open at once"
        for code, line, first, second in (
                (3, said, poor, own), (3, rf"rank 2 on \S+: {said}", own, poor),
                (2, r"rank 2 on \S+: .* --none; see wholehand-mpi sweep --help", own, [*own, "--none"]),
                (2, r"rank 2 on \S+: --best .*", own, [*own, "--best", "many"]),
                (2, r"rank 2 on \S+: no sweep is asked for here; start the same on every node", own, [MPI_PROGRAM, "--help"])):
            ranks = ["-n", "1", *first, ":", "-n", "2", *second] if first == poor else ["-n", "2", *first, ":", "-n", "1", *second]
            result, out, errors = self.end(self.start(["mpirun", "-q", *ranks]))
            self.assertEqual((result, out), (code, ""), errors)
            self.assertEqual(len(errors.strip().split("\n")), 1, errors)
            self.assertRegex(errors, "wholehand: " + line)
            self.assertFalse([name for name in os.listdir(self.folder) if name.startswith("a.nc")])


if __name__ == "__main__":
    unittest.main()
