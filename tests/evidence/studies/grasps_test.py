# SPDX-License-Identifier: MIT
"""The statistics of study.csv from the single grasps of grasps.csv, by numpy and scipy."""

import csv
import os
import tempfile
import unittest

import numpy
from scipy import stats

from harness import run

VESSELS = ["beaker1", "beaker2", "beaker3"]
SAMPLE = [22, 32, 18]  # the paper's grasps of them
PEOPLE = 12
# grasps.csv has nine digits. A correlation and an F lose up to three of them to differences of nearly equal numbers.
DIGITS = 1e-8
AFTER_DIFFERENCES = 1e-5


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def number(text):
    return float(text) if text else numpy.nan


def column(rows, name):
    return numpy.array([number(row[name]) for row in rows])


def mean(values):
    values = numpy.array(values, dtype=float)
    values = values[numpy.isfinite(values)]
    return values.mean() if len(values) else numpy.nan


def correlation(x, y):
    both = numpy.isfinite(x) & numpy.isfinite(y)
    x, y = x[both], y[both]
    return stats.pearsonr(x, y).statistic if len(x) > 2 and numpy.ptp(x) > 0 and numpy.ptp(y) > 0 else numpy.nan


class Grasps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        run("study", "mixing_board", "--people", PEOPLE, "--quick", "-o", cls.folder.name)
        cls.grasps = rows_of(os.path.join(cls.folder.name, "grasps.csv"))
        cls.people = rows_of(os.path.join(cls.folder.name, "people.csv"))
        key = ("experiment", "pose", "vessel", "statistic", "subject")
        cls.rows = {tuple(row[name] for name in key): row for row in rows_of(os.path.join(cls.folder.name, "study.csv"))}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def of(self, experiment, vessel, pose="", subject=None):
        return [row for row in self.grasps
                if row["experiment"] == experiment and row["pose"] == pose and subject in (None, row["subject"])
                and (row["vessel"] == vessel or vessel == "all" and row["vessel"] in VESSELS)]

    def expect(self, key, value, behind=None, tolerance=DIGITS):
        """The statistic has this value, and the people and grasps of the rows `behind` it."""
        row = self.rows[key]
        got = number(row["value"])
        self.assertEqual(numpy.isfinite(got), numpy.isfinite(value), (key, got, value))
        if numpy.isfinite(value):
            self.assertLessEqual(abs(got - value), tolerance * max(1, abs(value)), (key, got, value))
        if behind is not None:
            self.assertEqual(int(row["grasps"]), len(behind), key)
            self.assertEqual(int(row["people"]), len({grasp["person"] for grasp in behind}), key)

    def test_contacts_of_a_vessel(self):
        points = [name for name in self.grasps[0] if name.startswith(("thumb_", "index_", "middle_", "ring_", "little_"))]
        self.assertEqual(len(points), 24)
        for pose in ["paper", "articulated"]:
            for vessel in [*VESSELS, "tutorial"]:
                made = self.of("contacts", vessel, pose)
                held = [row for row in made if row["held"] == "1"]
                key = ("contacts", pose, vessel)
                self.expect((*key, "held_share", ""), len(held) / len(made), made)
                for statistic, name in [("plausible_share", "plausible"), ("mean_fingers", "fingers"), ("mean_points", "points")]:
                    self.expect((*key, statistic, ""), mean(column(held, name)), held)
                height, distance = column(held, "height_mm"), column(held, "distance_mm")
                for counted in ["fingers", "points"]:
                    for name, values in [("height", height), ("distance", distance)]:
                        value = correlation(column(held, counted), values)
                        self.expect((*key, f"pearson_{counted}_{name}", ""), value, held, AFTER_DIFFERENCES)
                for point in points:
                    touches = column(held, point)
                    self.expect((*key, "touch_share", point), mean(touches), held)
                    for name, values in [("height", height), ("distance", distance)]:
                        value = correlation(touches, values)
                        self.expect((*key, f"point_biserial_{name}", point), value, held, AFTER_DIFFERENCES)
                roles = {role: column(held, f"{role}_points") for role in ["tip", "finger", "inner"]}
                all_points = sum(roles.values())
                projected = [row for row, of_row in zip(held, all_points) if of_row > 0]
                self.expect((*key, "projected_share", ""), mean(all_points > 0), held)
                for role, of_role in roles.items():
                    share = of_role.sum() / all_points.sum() if projected else numpy.nan
                    self.expect((*key, f"projected_{role}_share", ""), share, projected)
                    self.expect((*key, f"grasps_projected_{role}_share", ""), mean(of_role > 0), held)

    def test_contacts_of_all_vessels(self):
        for pose in ["paper", "articulated"]:
            weights, fingers = [], []
            for vessel, sample in zip(VESSELS, SAMPLE):
                made = self.of("contacts", vessel, pose)
                held = [row for row in made if row["held"] == "1"]
                in_sample = min(17 * len(made) / PEOPLE, sample * len(made) / len(held))
                weights += [in_sample / len(made)] * len(held)
                fingers += list(column(held, "fingers"))
            self.expect(("contacts", pose, "all", "mean_fingers", ""), numpy.average(fingers, weights=weights))

    def test_forces(self):
        vessel = VESSELS[0]
        choices = sorted({row["subject"] for row in self.of("forces", vessel)})
        self.assertEqual(len(choices), 15)
        for choice in choices:
            tried = self.of("forces", vessel, subject=choice)
            gripped = [row for row in tried if row["gripped"] == "1"]
            key = ("forces", "", vessel)
            lost, oscillated = column(gripped, "losses") >= 2, column(gripped, "oscillated") == 1
            self.expect((*key, "gripped_share", choice), len(gripped) / len(tried), tried)
            self.expect((*key, "lost_share", choice), mean(lost), gripped)
            self.expect((*key, "oscillated_share", choice), mean(oscillated & ~lost), gripped)
            held = (column(gripped, "succeeded") == 1) & ~lost & ~oscillated
            self.expect((*key, "held_share", choice), mean(held), gripped)
            opening = column(gripped, "opening_mm")
            self.expect((*key, "largest_opening_mean", choice), mean(opening) / 1e3, gripped)
            for limit in ["0.5", "1", "2"]:
                self.expect((*key, f"opening_over_{limit}mm_share", choice), mean(opening > float(limit)), gripped)

    def test_sessions(self):
        def chosen(vessel, which):
            rows = self.of("sessions", vessel)
            if which != "all":
                rows = [row for row in rows if number(row["largest_tilt_deg"]) >= 30]
            if which == "maintained":
                rows = [row for row in rows if row["grip_at_first_N"]]
            return [row for row in rows if row["type"]] if which == "analyzed" else rows

        moments = [("response_time", "response_time_s", "all"), ("grip_stopped", "grip_stopped_N", "all"),
                   ("grip_before", "grip_before_N", "tilted"), ("grip_during", "grip_during_N", "tilted"),
                   ("grip_after", "grip_after_N", "tilted"), ("tilt_time", "tilt_time_s", "tilted"),
                   ("maintained_time", "maintain_s", "maintained"), ("normal_increase", "normal_increase_N", "analyzed")]
        compared = 0
        for vessel in ["all", *VESSELS]:
            key = ("sessions", "", vessel)
            for statistic, name, which in moments:
                rows = [row for row in chosen(vessel, which) if row[name]]
                values = column(rows, name)
                for moment, value in [("mean", mean(values)), ("deviation", values.std(ddof=1) if len(values) > 1 else numpy.nan)]:
                    if (*key, f"{statistic}_{moment}", "") in self.rows:
                        self.expect((*key, f"{statistic}_{moment}", ""), value, rows)
                        compared += 1
            analyzed, tilted, every = chosen(vessel, "analyzed"), chosen(vessel, "tilted"), chosen(vessel, "all")
            for course in ["G1", "G2", "G3", "G4"]:
                self.expect((*key, f"{course.lower()}_share", ""), mean([row["type"] == course for row in analyzed]), analyzed)
            self.expect((*key, "rising_share", ""), mean(column(analyzed, "grip_change_N") > 0), analyzed)
            self.expect((*key, "lost_share", ""), mean([row["outcome"] == "lost" for row in every]), every)
            if vessel != "all":
                self.expect((*key, "tilted_share", ""), len(tilted) / len(every), every)
                self.expect((*key, "analyzed_share", ""), len(analyzed) / len(tilted), tilted)
                self.expect((*key, "saturated_share", ""), mean(column(tilted, "saturated_s") > 0), tilted)
                value = correlation(column(analyzed, "normal_increase_N"), column(analyzed, "grip_change_N"))
                self.expect((*key, "correlation_increase_change", ""), value, analyzed, AFTER_DIFFERENCES)
        self.assertGreater(compared, 20)
        key = ("sessions", "", "all")
        maintained = chosen("all", "maintained")
        self.expect((*key, "maintained_over_8N_share", ""), mean(column(maintained, "grip_at_first_N") > 8), maintained)
        self.expect((*key, "maintained_under_1N_share", ""), mean(column(maintained, "grip_at_first_N") < 1), maintained)
        groups = [column(chosen(vessel, "analyzed"), "normal_increase_N") for vessel in VESSELS]
        self.expect((*key, "anova_f", ""), stats.f_oneway(*groups)[0], chosen("all", "analyzed"), AFTER_DIFFERENCES)
        grasping = len({row["person"] for row in self.grasps if row["experiment"] == "sessions"})
        self.expect((*key, "people_with_grasps_share", ""), grasping / PEOPLE)

    def test_people_are_those_of_the_grasps(self):
        people = {row["person"]: row for row in self.people}
        self.assertEqual(sorted(people, key=int), [str(k) for k in range(PEOPLE)])
        for row in self.grasps:
            for name in ["sex", "hand_length_mm", "hand_breadth_mm"]:
                self.assertEqual(row[name], people[row["person"]][name])

    def test_what_is_off_leads_to_the_nearer_end(self):
        compared = [row for row in self.rows.values() if row["inside"]]
        self.assertGreaterEqual(len(compared), 40)
        for row in compared:
            paper, off = float(row["paper"]), float(row["off"])
            low, high = float(row["low"]), float(row["high"])
            self.assertEqual(off == 0, row["inside"] == "1", row)
            if off:
                self.assertAlmostEqual(paper + off, min([low, high], key=lambda end: abs(end - paper)), delta=1e-12)


if __name__ == "__main__":
    unittest.main(verbosity=0)
