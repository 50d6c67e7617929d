# SPDX-License-Identifier: MIT
"""What the engines' tests share: where wholehand is installed, a scene, grips of it, small geometry."""

import glob
import json
import math
import os
import shutil
import tempfile
import unittest

from harness import SOURCE, STAGED, cross, dot, minus, run, unit

HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLES = os.path.join(SOURCE, "examples")
PATIENCE = 120  # s: on however busy a machine

# What the packages install, unpacked in one folder.
INCLUDE = f"{STAGED}/usr/include"
LIBRARIES = os.path.dirname(glob.glob(f"{STAGED}/usr/lib/*/libwholehand.so")[0])

# Joints as OpenXR names them, in the order of `grip --json`.
FINGER = ["METACARPAL", "PROXIMAL", "INTERMEDIATE", "DISTAL", "TIP"]
JOINTS = [f"XR_HAND_JOINT_THUMB_{joint}_EXT" for joint in FINGER if joint != "INTERMEDIATE"]
JOINTS += [f"XR_HAND_JOINT_{finger}_{joint}_EXT" for finger in ("INDEX", "MIDDLE", "RING", "LITTLE") for joint in FINGER]

# One beaker beside the origin. No busy machine ends its session by late ticks.
SCENE = """
[scene]
name = "one_beaker"

[hand]
person = "paper"              # the simulated user then takes the beaker with a roll
handedness = "right"
contact_tolerance_mm = 0.004  # the least: fingertips of a session hold where a sweep's do

[[vessel]]
name = "beaker"
shape = "cylinder"
diameter_mm = 80
height_mm = 110
wall_mm = 1.5
force_range_N = 2
place_mm = [60, 0, 0]
liquid = { name = "red", fill = 0.5 }

[liquid]
fills = [0, 0.5]

[tilts]
deg = [0, 30, 60]

[live]
late_steps = 1000
"""


def environment(folder):
    """For engines, which write below HOME, and find the library where it is."""
    return {**os.environ, "HOME": folder, "XDG_DATA_HOME": folder, "XDG_CONFIG_HOME": folder, "XDG_CACHE_HOME": folder,
            "LANG": "en_US.UTF-8", "LC_ALL": "en_US.UTF-8", "LD_LIBRARY_PATH": LIBRARIES}


def grip(scene, *options):
    """What `wholehand grip --json` says of a grip of the beaker."""
    return json.loads(run("grip", scene, "--vessel", "beaker", "--json", *options))


def own_copy(example, folder):
    """An example's project where it may be written to: engines leave files beside their projects."""
    built = shutil.ignore_patterns("*.so", ".import")  # of somebody who has used the project in the checkout
    return shutil.copytree(os.path.join(EXAMPLES, example), os.path.join(folder, example), ignore=built)


# ---- geometry: rotations are rows ----

def distance(a, b):
    return math.dist(a, b)


def rows_of(quaternion):
    """The rotation of x, y, z, w."""
    x, y, z, w = unit(quaternion)
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


def inward(rows, place, point):
    """A point of the world in a frame that is there and turned so."""
    away = minus(point, place)
    return [dot([rows[k][column] for k in range(3)], away) for column in range(3)]


def roll_of(direction, gripper):
    """The roll in degrees (docs/method.md, kernel 3) of a hand whose tips lie along `direction`, and whose gripper has these axes
    (rows): at roll 0 the gripper's second axis is up, as far as the line lets it."""
    down = unit(minus([0, -1, 0], [-direction[1] * x for x in direction]))
    second = [-gripper[k][1] for k in range(3)]
    second = unit(minus(second, [dot(second, direction) * x for x in direction]))
    return math.degrees(math.atan2(dot(second, cross(direction, down)), dot(second, down)))


class EngineTest(unittest.TestCase):
    """A folder for all tests of a class, with the scene in it."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="wholehand_engine_")
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.scene = os.path.join(cls.folder, "one.toml")
        with open(cls.scene, "w") as file:
            file.write(SCENE)

    def assert_places(self, ours, theirs, tolerance):
        """24 places, each within a distance in m of the other's."""
        self.assertEqual((len(ours), len(theirs)), (24, 24))
        farthest = max(range(24), key=lambda j: distance(ours[j], theirs[j]))
        self.assertLess(distance(ours[farthest], theirs[farthest]), tolerance, JOINTS[farthest])
