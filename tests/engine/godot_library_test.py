# SPDX-License-Identifier: MIT
"""examples/godot-library: the plugin is compiled as docs/engines.md says. Godot sets the nodes of a hand by what it gives of a grip
and of a session. Where the nodes are is compared with `wholehand grip --json`."""

import json
import math
import os
import re
import shutil
import subprocess
import unittest

from harness import minus, run, unit
from support import HERE, JOINTS, LIBRARIES, PATIENCE, EngineTest, environment, grip, inward, own_copy, roll_of, rows_of

# Godot's Vector3 is of float32: half a unit of places below 0.25 m is 7.5e-9 m. Godot's own text of it adds less than 1e-15.
FLOAT = 1e-8


def docs():
    with open(os.path.join(HERE, "../../docs/engines.md")) as file:
        return list(file)


def numbers(value):
    """Numbers from texts, from lists of them and so on."""
    return [numbers(one) for one in value] if isinstance(value, list) else float(value)


class GodotLibrary(EngineTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.project = own_copy("godot-library", cls.folder)
        command = next(line.strip() for line in docs() if line.startswith("    c++ "))
        done = subprocess.run(command.replace("c++ ", "c++ -Wall -Wextra -pedantic -Werror ", 1), shell=True, cwd=cls.project,
                              env={**os.environ, "PKG_CONFIG_PATH": f"{LIBRARIES}/pkgconfig"},
                              capture_output=True, text=True, timeout=PATIENCE)
        if done.returncode:
            raise AssertionError(done.stderr)
        cls.bad = os.path.join(cls.folder, "bad.toml")
        with open(cls.bad, "w") as file:
            file.write("[hand]\nscale = 99\n")
        shutil.copy(os.path.join(HERE, "library_check.gd"), cls.project)
        written = os.path.join(cls.folder, "seen.json")
        done = cls.godot("-s", "library_check.gd", f"--scene={cls.scene}", f"--bad={cls.bad}", f"--write={written}")
        if done.returncode or not os.path.exists(written):
            raise AssertionError(done.stdout)
        cls.said = done.stdout
        with open(written) as file:
            cls.seen = json.load(file)

    @classmethod
    def godot(cls, *arguments):
        return subprocess.run(["godot3-server", "--path", cls.project, *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=PATIENCE, env=environment(cls.folder))

    def test_names_are_openxr_s(self):
        self.assertEqual(self.seen["names"], JOINTS)

    def test_a_vessel_is_that_of_the_scene(self):
        name, highest, mass, place = self.seen["vessel"]
        known = grip(self.scene, "--height-mm=60")
        self.assertEqual((name, float(highest)), ("beaker", 0.11))
        empty = next(state for state in known["states"] if state["fill"] == 0)
        self.assertAlmostEqual(float(mass), empty["mass_kg"], delta=1e-14)
        self.assertLess(math.dist(numbers(place), [0.06, 0, 0]), FLOAT)

    def test_a_grip_s_nodes_are_the_joints_of_the_program(self):
        seen = self.seen["grip"]
        # the angles of SOME in library_check.gd are 0.5, 0.1 and -0.4 rad
        known = grip(self.scene, "--height-mm=60", "--azimuth-deg=28.64788975654116", "--obliquity-deg=5.729577951308232",
                     "--roll-deg=-22.918311805232932", "--offset-mm=2", "--hand-scale=1.02")
        self.assertTrue(known["feasible"])
        self.assertEqual((seen["feasible"], seen["reason"]), (True, ""))
        for ours, theirs in zip(numbers(seen["nodes"]), known["posed_m"]):
            for k in range(3):
                self.assertAlmostEqual(ours[k], theirs[k], delta=FLOAT)
        # reals are doubles, written with 15 digits after the point
        self.assertAlmostEqual(float(seen["closure"]), known["closure"], delta=1e-9)
        self.assertAlmostEqual(float(seen["score"]), known["score"], delta=1e-9)
        self.assertEqual([bool(int(seen["touch_mask"]) >> joint & 1) for joint in range(24)], known["touching"])
        text = json.loads(self.seen["grip_json"])
        self.assertEqual(text.keys(), known.keys())
        self.assert_places(text["posed_m"], known["posed_m"], 1e-9)

    def test_a_session_s_nodes_are_the_joints_of_its_grip(self):
        seen = self.seen["session"]
        self.assertEqual((seen["states"], seen["grasps"], seen["period"]), (["free", "touching", "lift", "tilt"], 1, 1e-3))
        place, turn = numbers(seen["stood"])
        self.assertLess(math.dist(turn, [0, 0, 0, 1]), 1e-6, "it stood upright at the grasp")
        thumb, index = (minus(tip, place) for tip in numbers(seen["tips"]))
        known = grip(self.scene, f"--thumb-mm={','.join(f'{1e3 * x:.12g}' for x in thumb)}",
                     f"--index-mm={','.join(f'{1e3 * x:.12g}' for x in index)}",
                     f"--roll-deg={roll_of(unit(minus(index, thumb)), rows_of(numbers(seen['gripper']))):.12g}")
        place, turn = numbers(seen["vessel"])
        self.assertGreater(seen["tilt"], 0.1, "it is lifted and tilted by now")
        self.assertGreater(place[1], 0.01)
        # 1e-7 m, to which a session finds the hand of a grip (tests/device/session/hand_view_test.cpp), and some units of 3e-8 of places and
        # turns in float32: of the tips that say which grip it is, of the vessel, and of the joints
        self.assert_places([inward(rows_of(turn), place, joint) for joint in numbers(seen["nodes"])], known["proxies_m"], 1e-6)
        # -z of a joint runs along its bone to the next joint; a bone of 20 mm between places of float32 is 1e-5 rad off at most
        nodes, turns = numbers(seen["nodes"]), numbers(seen["turns"])
        for j, name in enumerate(JOINTS):
            if not name.endswith("TIP_EXT"):
                along = [-row[2] for row in rows_of(turns[j])]
                self.assertLess(math.dist(along, unit(minus(nodes[j + 1], nodes[j]))), 1e-5, name)

    def test_a_thread_steps_the_session(self):
        seen = self.seen["thread"]
        self.assertEqual(seen["grasps"], 1)
        self.assertGreater(seen["ticks"], 0)
        self.assertGreater(math.hypot(*numbers(seen["wrist"])), 0.01)
        self.assertEqual(seen["refused"], "session_step: a thread steps the session; call session_stop first")
        self.assertEqual(seen["failed"], "wh_session_step: the measurement is not finite")

    def test_what_is_refused_says_why(self):
        seen = self.seen["refusals"]
        parts = {
            "no scene": "wh_scene_vessels", "bad scene": "bad.toml:2:9: scale = 99; allowed: 0.05 to 20",
            "type": "open: argument 1 must be a String", "count": "open takes 1 arguments, and got 0",
            "no session": "there is no session; call session_open first", "no thread": "call session_start first",
            "vessel": "no vessel 'bucket'; the scene has beaker", "key": "a key is unknown; allowed: height, azimuth",
            "number": "wh_grip_evaluate", "same tick": "the tick 699 does not come after the tick 699",
            "not finite": "the measurement is not finite", "place": "session_step: argument 2 must be a Vector3",
        }
        self.assertEqual(seen.keys(), parts.keys())
        for wrong, part in parts.items():
            self.assertIn(part, seen[wrong], wrong)
            self.assertIn(seen[wrong], self.said, "Godot prints it too")
        self.assertNotIn("SCRIPT ERROR", self.said)

    def test_the_lines_of_the_docs_run(self):
        lines = docs()
        first = next(k for k, line in enumerate(lines) if line.startswith("    var wholehand"))
        last = next(k for k in range(first, len(lines)) if not lines[k].startswith("    "))
        with open(os.path.join(self.project, "snippet.gd"), "w") as file:
            file.write("extends Spatial\nfunc _ready():\n\tvar gap = 0.1\n" + "".join("\t" + line[4:] for line in lines[first:last])
                       + "\tprint(\"tip %.9f %.9f %.9f\" % [$Tip.translation.x, $Tip.translation.y, $Tip.translation.z])\n"
                       + "\twholehand.session_stop()\n\tget_tree().quit()\n")
        with open(os.path.join(self.project, "Snippet.tscn"), "w") as file:
            file.write('[gd_scene load_steps=2 format=2]\n[ext_resource path="res://snippet.gd" type="Script" id=1]\n'
                       '[node name="Main" type="Spatial"]\nscript = ExtResource( 1 )\n'
                       '[node name="Tip" type="Spatial" parent="."]\n[node name="Tracker" type="Spatial" parent="."]\n')
        done = self.godot("res://Snippet.tscn")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("ERROR", done.stdout)
        tip = [float(x) for x in re.search(r"tip (.*)", done.stdout).group(1).split()]
        known = json.loads(run("grip", "mixing_board", "--vessel", "beaker1", "--height-mm=60",
                               "--roll-deg=-22.918311805232932", "--json"))
        self.assertLess(math.dist(tip, known["posed_m"][8]), FLOAT)

    def test_the_project_runs(self):
        done = self.godot(f"--scene={self.scene}", "--grasps=1")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("ERROR", done.stdout)
        self.assertRegex(done.stdout, r"grasps [1-9]\d*, lost \d+\n")

    def test_without_the_plugin_the_project_says_what_to_do(self):
        project = own_copy("godot-library", os.path.join(self.folder, "bare"))
        done = subprocess.run(["godot3-server", "--path", project], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              timeout=PATIENCE, env=environment(self.folder))
        self.assertEqual(done.returncode, 3, done.stdout)
        self.assertIn("compile the plugin as docs/engines.md says", done.stdout)
        self.assertNotIn("ERROR", done.stdout)

    def test_the_project_refuses_a_bad_scene(self):
        done = self.godot(f"--scene={self.bad}")
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("bad.toml:2:9: scale = 99; allowed: 0.05 to 20", done.stdout)
        self.assertNotIn("SCRIPT ERROR", done.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
