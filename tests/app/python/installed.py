# SPDX-License-Identifier: MIT
"""What tests of the installed package share: the program beside it, scenes, and the place that all of it was loaded from."""

import contextlib
import math
import os
import tempfile
import unittest

import wholehand as wh

from harness import STAGED

assert wh.__file__.startswith(os.path.join(STAGED, "usr/lib/python3/dist-packages")), wh.__file__


class InFolder(unittest.TestCase):
    """Each test in an empty folder of its own."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        stack = contextlib.ExitStack()
        stack.enter_context(contextlib.chdir(self.folder.name))
        self.addCleanup(stack.close)

    def refused(self, call, *arguments, **named):
        """The wh.Error that a call ends with."""
        with self.assertRaises(wh.Error) as caught:
            call(*arguments, **named)
        self.assertIn(caught.exception.exit_code, (2, 3))
        return caught.exception


# Two vessels, liquid, states that pour, several hand scales, and grips that miss.
SEVERAL = """
[[vessel]]
name = "tall"
outline = [{ line = [30, 0] }, { line = [34, 110] }, { line = [0, 110] }]
wall_mm = 2

[[vessel]]
name = "low"
outline = [{ line = [41, 0] }, { line = [41, 55] }, { line = [0, 55] }]
wall_mm = 2.5

[liquid]
fills = [0.25, 0.75]

[strength]
thumb_N = 40

[grips]
height_fraction = { from = 0.2, to = 1, count = 5 }
azimuth_deg = [0, 30]
obliquity_deg = [-15, 10]
roll_deg = { from = -80, to = 10, count = 4 }
offset_mm = [0, 12]
hand_scale = [1, 0.9]

[tilts]
deg = [0, 40, 80]

[output]
best = 3
"""

SOBOL = """
[[vessel]]
name = "glass"
outline = [{ line = [30, 0] }, { line = [34, 110] }, { line = [0, 110] }]
wall_mm = 2

[grips]
sampling = "sobol"
count = 300
height_fraction = { from = 0.1, to = 0.9 }
roll_deg = { from = -90, to = 20 }
hand_scale = { from = 0.9, to = 1.1 }
"""


def tube_ply(radius=32e-3, height=90e-3, sides=48):
    """A closed cylinder as PLY text, m, y up."""
    points, faces = [], []
    for y in (0, height):
        for k in range(sides):
            angle = 2 * math.pi * k / sides
            points.append((radius * math.cos(angle), y, -radius * math.sin(angle)))
    points += [(0, 0, 0), (0, height, 0)]
    for k in range(sides):
        n = (k + 1) % sides
        faces += [(k, n, sides + n), (k, sides + n, sides + k), (2 * sides, n, k), (2 * sides + 1, sides + k, sides + n)]
    head = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    return head + "".join("%.9g %.9g %.9g\n" % p for p in points) + "".join("3 %d %d %d\n" % f for f in faces)


MESH = """
[[vessel]]
name = "tube"
mesh = "tube.ply"
mass_kg = 0.2
center_of_mass_mm = [0, 45, 0]

[grips]
height_mm = [30, 60]
azimuth_deg = [0, 120]
roll_deg = [-60, 0]
"""
