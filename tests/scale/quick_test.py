# SPDX-License-Identifier: MIT
"""Sweeps of 16 and 64 simulated ranks: all grips are done, in the time that they have to take, and the same twice."""

import csv
import os
import stat
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["WHOLEHAND_SCALE_PROGRAM"]

# s, of the machine that is simulated (tests/scale/machine.h)
MPI_INIT, OPEN, SYNC = 0.5, 0.09, 0.01
OPENS = 5000  # files a second
NAP = 0.02  # the longest that a rank sleeps before it looks again
LEAST_PIECE = 1024 / 21_000  # of a straggler
LEADER_CHUNK, MARK = 0.012, 0.1
MEETINGS = 24  # times that all wait for all, from the first to the last line of a sweep


def simulate(folder, name):
    path = os.path.join(folder, name)
    subprocess.run([PROGRAM, "--only", "quick", "--csv", path], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Quick(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            cls.rows, cls.again = simulate(folder, "one.csv"), simulate(folder, "two.csv")

    def test_the_numbers_are_the_same_twice(self):
        self.assertEqual(self.rows, self.again)
        self.assertEqual([(row["ranks"], "straggler" in row["machine"]) for row in self.rows],
                         [("16", False), ("16", True), ("64", False), ("64", True)])

    def test_every_grip_is_done_once(self):
        for row in self.rows:
            self.assertEqual(row["done"], row["grips"], row)

    def test_it_takes_what_the_ranks_and_the_stated_overheads_take(self):
        for row in self.rows:
            ranks, result = int(row["ranks"]), float(row["result_s"])
            ideal = int(row["grips"]) / float(row["rate_of_all"])
            start = MPI_INIT + OPEN + 2 * ranks / OPENS + MEETINGS / 2 * NAP
            self.assertGreater(float(row["first_chunk_s"]), MPI_INIT + OPEN, row)
            self.assertLess(float(row["first_chunk_s"]), start + 0.25, row)  # a chunk of a quarter of a second
            self.assertGreater(result, ideal, row)
            read_back = float(row["written_bytes"]) / 5e9
            marks = float(row["leader_s"]) / ranks
            ending = LEADER_CHUNK + MARK + 2 * SYNC + MEETINGS / 2 * NAP
            self.assertLess(result, ideal + start + marks + 2 * LEAST_PIECE + ending + read_back, row)

    def test_a_slow_rank_keeps_nobody_waiting(self):
        for row in self.rows:
            self.assertLess(float(row["last_chunk_s"]) - float(row["first_idle_s"]), 2 * LEAST_PIECE + LEADER_CHUNK, row)

    def test_the_counter_is_asked_ahead(self):
        for row in self.rows:
            self.assertLess(float(row["longest_answer_s"]), 1e-4, row)  # of 1 us each, some at a time

    def test_wrong_usage_ends_before_any_run(self):
        with tempfile.TemporaryDirectory() as folder:
            same = os.path.join(folder, "same")
            pipe = os.path.join(folder, "pipe")
            os.mkfifo(pipe)
            for arguments in (["--only", "foo"], ["--jobs", "0"], ["--bogus"], ["--csv", folder], ["--csv", pipe], ["--svg", "/none/a.svg"],
                              ["--csv", same, "--svg", same]):
                command = [PROGRAM, *(arguments if "--only" in arguments else ["--only", "quick", *arguments])]
                run = subprocess.run(command, capture_output=True, text=True, check=False)
                self.assertEqual((run.returncode, run.stdout, len(run.stderr.strip().split("\n"))), (2, "", 1), run.stderr)
                self.assertTrue(run.stderr.startswith("wholehand-scale: "), run.stderr)
            self.assertEqual(os.listdir(folder), ["pipe"])
            self.assertTrue(stat.S_ISFIFO(os.stat(pipe).st_mode))


if __name__ == "__main__":
    unittest.main()
