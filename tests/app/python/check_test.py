# SPDX-License-Identifier: MIT
"""The check against `wholehand check`."""

import json
import unittest

import wholehand as wh

from harness import complaint, run
from installed import InFolder


class TheCheck(InFolder):
    def test_it_is_the_programs(self):
        found = wh.check("small")
        self.assertEqual(str(found), run("check", "small"))
        self.assertEqual(repr(found), str(found))
        self.assertEqual(found.report, json.loads(run("check", "small", "--json")))
        self.assertIs(found.passed, True)
        self.assertTrue(found)
        rows = found.rows
        self.assertEqual(len(rows), sum(len(one["quantities"]) for one in found.report["comparisons"]))
        self.assertTrue({"comparison", "kernel", "quantity", "worst", "tolerance", "unit"} <= set(rows[0]))
        for row in rows:
            self.assertLessEqual(row["outside"], 0)

    def test_what_is_refused(self):
        for on in ("core", "no-such"):
            error = self.refused(wh.check, "small", on=on)
            self.assertEqual((error.exit_code, str(error)), complaint("check", "small", "--on", on))


if __name__ == "__main__":
    unittest.main()
