# SPDX-License-Identifier: MIT
"""The statistics of several recordings against numpy's and scipy's, from the grasps that `wholehand session` reports of each of them."""

import csv
import os
import tempfile
import unittest

import numpy
from scipy import stats

from harness import run

PEOPLE = range(5)
VESSELS = ["beaker1", "beaker2", "beaker3"]
# session.csv has nine digits. A correlation and an F lose up to three of them to differences of nearly equal numbers.
DIGITS = 1e-8
AFTER_DIFFERENCES = 1e-5


def number(text):
    return float(text) if text else float("nan")


def finite(values):
    values = numpy.array(values, dtype=float)
    return values[numpy.isfinite(values)]


class SessionStudy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        grasps, recordings = [], []
        for person in PEOPLE:
            recording = os.path.join(cls.folder.name, f"{person}.nc")
            # at the lowest rate, so that the files are small
            run("live", "--person", person, "--no-clock", "--rate", 500, "--record", recording)
            recordings.append(recording)
            report = os.path.join(cls.folder.name, f"{person}")
            run("session", recording, "-o", report)
            with open(os.path.join(report, "session.csv"), newline="") as file:
                grasps += [row for row in csv.DictReader(file) if row["vessel"] in VESSELS]
        study = os.path.join(cls.folder.name, "study")
        run("session", *recordings, "--study", "-o", study)
        with open(os.path.join(study, "study.csv"), newline="") as file:
            cls.rows = {(row["vessel"], row["statistic"]): row for row in csv.DictReader(file) if row["experiment"] == "sessions"}
        cls.grasps = grasps

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def of(self, vessel, *, tilted=False, analyzed=False):
        chosen = [row for row in self.grasps if vessel in ("all", row["vessel"])]
        if tilted:
            chosen = [row for row in chosen if number(row["largest_tilt_deg"]) >= 30]
        if analyzed:
            chosen = [row for row in chosen if row["type"]]
        return chosen

    def column(self, rows, name):
        return [number(row[name]) for row in rows]

    def expect(self, vessel, statistic, value, tolerance=DIGITS):
        got = number(self.rows[vessel, statistic]["value"])
        if not numpy.isfinite(value):
            self.assertFalse(numpy.isfinite(got), (vessel, statistic, got))
            return
        self.assertLessEqual(abs(got - value), tolerance * max(1, abs(value)), (vessel, statistic, got, value))

    def expect_moments(self, vessel, name, rows, column):
        values = finite(self.column(rows, column))
        self.expect(vessel, f"{name}_mean", values.mean() if len(values) else numpy.nan)
        if (vessel, f"{name}_deviation") in self.rows:
            self.expect(vessel, f"{name}_deviation", values.std(ddof=1) if len(values) > 1 else numpy.nan)

    def expect_correlation(self, vessel, statistic, rows, x, y):
        pairs = numpy.array([self.column(rows, x), self.column(rows, y)])
        pairs = pairs[:, numpy.isfinite(pairs).all(axis=0)]
        self.expect(vessel, statistic, stats.pearsonr(*pairs).statistic if pairs.shape[1] >= 3 else numpy.nan, AFTER_DIFFERENCES)

    def test_moments(self):
        for vessel in ["all", *VESSELS]:
            self.expect_moments(vessel, "response_time", self.of(vessel), "response_time_s")
            self.expect_moments(vessel, "grip_stopped", self.of(vessel), "grip_stopped_N")
            self.expect_moments(vessel, "grip_after", self.of(vessel, tilted=True), "grip_after_N")
        for vessel in VESSELS:
            self.expect_moments(vessel, "grip_before", self.of(vessel, tilted=True), "grip_before_N")
            self.expect_moments(vessel, "grip_during", self.of(vessel, tilted=True), "grip_during_N")
            self.expect_moments(vessel, "normal_increase", self.of(vessel, analyzed=True), "normal_increase_N")
        self.expect_moments("all", "tilt_time", self.of("all", tilted=True), "tilt_time_s")
        maintained = [row for row in self.of("all", tilted=True) if row["grip_after_N"]]
        self.expect_moments("all", "maintained_time", maintained, "maintain_s")

    def test_shares(self):
        for vessel in ["all", *VESSELS]:
            rows = self.of(vessel, analyzed=True)
            for course in "1234":
                self.expect(vessel, f"g{course}_share", numpy.mean([row["type"] == f"G{course}" for row in rows]))
            self.expect(vessel, "rising_share", numpy.mean([number(row["grip_change_N"]) > 0 for row in rows]))
            self.expect(vessel, "lost_share", numpy.mean([row["outcome"] == "lost" for row in self.of(vessel)]))

    def test_correlations(self):
        for vessel in VESSELS:
            rows = self.of(vessel, analyzed=True)
            self.expect_correlation(vessel, "correlation_increase_change", rows, "normal_increase_N", "grip_change_N")
        rows = self.of("all", analyzed=True)
        self.expect_correlation("all", "correlation_before_change", rows, "grip_before_N", "grip_change_N")

    def test_analysis_of_variance(self):
        groups = [finite(self.column(self.of(vessel, analyzed=True), "normal_increase_N")) for vessel in VESSELS]
        groups = [group for group in groups if len(group)]
        f, p = stats.f_oneway(*groups)
        together = numpy.concatenate(groups)
        total = ((together - together.mean()) ** 2).sum()
        within = sum(((group - group.mean()) ** 2).sum() for group in groups)
        self.expect("all", "anova_f", f, AFTER_DIFFERENCES)
        self.expect("all", "anova_share", 1 - within / total, AFTER_DIFFERENCES)
        got = number(self.rows["all", "anova_p"]["value"])
        self.assertGreater(got, 0)
        # a tail goes as a power of F, here the fifth or so
        self.assertLess(abs(numpy.log(got / p)), 1e-3)

    def test_there_is_much_to_compare(self):
        self.assertGreaterEqual(len(self.grasps), 3 * len(PEOPLE))
        self.assertGreaterEqual(len(self.of("all", analyzed=True)), 2 * len(PEOPLE))


if __name__ == "__main__":
    unittest.main(verbosity=0)
