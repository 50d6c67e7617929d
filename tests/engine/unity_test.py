# SPDX-License-Identifier: MIT
"""examples/unity: the C# declarations compile with Mono, and are those of the C header member by member. Grips and sessions through
them are those of the program."""

import json
import os
import re
import subprocess
import unittest

from harness import PROGRAM, dot, minus, run, unit
from support import (EXAMPLES, HERE, INCLUDE, JOINTS, PATIENCE, EngineTest, distance, environment, grip, inward, roll_of, rows_of)

MIRROR = [1, 1, -1]  # from wholehand's axes to Unity's and back


# The C# type of each enum, by its first enumerator.
ENUMS = {"WH_OK": "Status", "WH_DOUBLE": "ValueType", "WH_FREE": "SessionState", "WH_JOINTS": "Native"}


def header():
    """The C header without its comments."""
    with open(f"{INCLUDE}/wholehand/wholehand.h") as file:
        return re.sub(r"/\*.*?\*/", "", file.read(), flags=re.S)


def pascal(name):
    return "".join(part.capitalize() for part in name.split("_"))


def members_of(body):
    """Names of a struct's members, in their order."""
    for declaration in body.split(";"):
        # a type, then one or more names with their brackets
        for one in re.sub(r"\[[^\]]*\]", "", declaration).split(","):
            if one.strip():
                yield re.findall(r"\w+", one)[-1]


def compiled_layout(folder):
    """What the C compiler says of each struct: {C# name: {member: [offset, size], "": size}}, and of each enumerator."""
    lines = []
    for name, body in re.findall(r"typedef struct wh_(\w+) \{(.*?)\} wh_\w+;", header(), re.S):
        lines.append(f'printf("S {name} - 0 %zu\\n", sizeof(wh_{name}));')
        lines += [f'printf("S {name} {member} %zu %zu\\n", offsetof(wh_{name}, {member}), sizeof(((wh_{name}*)0)->{member}));'
                  for member in members_of(body)]
    for body in re.findall(r"^(?:typedef )?enum \w*\s*\{(.*?)\}", header(), re.S | re.M):
        ones = re.findall(r"WH_\w+", body)
        lines += [f'printf("E {ENUMS[ones[0]]} {one} %d 0\\n", (int){one});' for one in ones]
    source, program = os.path.join(folder, "layout.c"), os.path.join(folder, "layout")
    with open(source, "w") as file:
        file.write("#include <stddef.h>\n#include <stdio.h>\n#include <wholehand/wholehand.h>\nint main(void) {\n"
                   + "\n".join(lines) + "\nreturn 0;\n}\n")
    subprocess.run(["cc", "-std=c11", f"-I{INCLUDE}", "-o", program, source], check=True, timeout=PATIENCE)
    structs, enums = {}, {}
    for line in subprocess.run([program], capture_output=True, text=True, check=True, timeout=PATIENCE).stdout.splitlines():
        kind, name, member, offset, size = line.split()
        if kind == "E":
            enums[f"{name}.{pascal(member.removeprefix('WH_').lower())}"] = int(offset)
        elif member == "-":
            structs[pascal(name)] = {"": int(size)}
        else:
            structs[pascal(name)][pascal(member)] = [int(offset), int(size)]
    return structs, enums


def in_threes(numbers):
    return [numbers[k:k + 3] for k in range(0, len(numbers), 3)]


class Unity(EngineTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.bad = os.path.join(cls.folder, "bad.toml")
        with open(cls.bad, "w") as file:
            file.write("[hand]\nscale = 99\n")
        cls.sources = [os.path.join(EXAMPLES, "unity", name) for name in ("Wholehand.cs", "SessionThread.cs")]
        check = os.path.join(HERE, "unity_check.cs")
        cls.run_well("mcs", "-unsafe", "-warn:4", "-warnaserror", "-out:check.exe", check, *cls.sources)
        cls.seen = json.loads(cls.run_well("mono", "check.exe", cls.scene, cls.bad))

    def test_the_lines_of_the_docs_run(self):
        with open(os.path.join(HERE, "../../docs/engines.md")) as file:
            lines = re.search(r"^    using \(Wholehand.*?^    \}\n", file.read(), re.S | re.M).group()
        last = '      System.Console.WriteLine("{0:R} {1:R} {2:R}", tip.X, tip.Y, tip.Z);\n    }\n'
        with open(os.path.join(self.folder, "docs.cs"), "w") as file:
            file.write("static class Docs {\n  static void Main() {\n" + lines[:-len("    }\n")] + last + "  }\n}\n")
        self.run_well("mcs", "-unsafe", "-warn:4", "-warnaserror", "-out:docs.exe", "docs.cs", *self.sources)
        tip = [float(x) for x in self.run_well("mono", "docs.exe").split()]
        known = json.loads(run("grip", "mixing_board", "--vessel", "beaker1", "--height-mm=60",
                               "--roll-deg=-22.918311805232932", "--json"))
        self.assertLess(distance([MIRROR[k] * tip[k] for k in range(3)], known["posed_m"][8]), 1e-9)

    @classmethod
    def run_well(cls, *command):
        done = subprocess.run(command, cwd=cls.folder, capture_output=True, text=True, timeout=PATIENCE,
                              env=environment(cls.folder))
        if done.returncode:
            raise AssertionError(done.stdout + done.stderr)
        return done.stdout

    def test_structs_and_enums_are_those_of_c(self):
        structs, enums = compiled_layout(self.folder)
        self.assertGreater(len(structs), 9)
        self.assertEqual(self.seen["layout"], structs)
        self.assertEqual(self.seen["enums"], enums)

    def test_every_function_is_declared(self):
        functions = re.findall(r"^WH_API [^(]*?(wh_\w+)\(", header(), re.M)
        self.assertGreater(len(functions), 25)
        self.assertEqual(sorted(self.seen["functions"]), sorted(functions))

    def test_names_are_openxr_s(self):
        self.assertEqual(self.seen["grip"]["names"], JOINTS)

    def test_reasons_have_names(self):
        # docs/grip.md
        self.assertEqual(self.seen["grip"]["reasons"],
                         ["", "degenerate", "not_converged", "misses", "too_wide", "too_narrow", "on_mouth"])

    def known_grip(self, height_mm):
        """SomeGrip() of unity_check.cs, whose angles are 0.5, 0.1 and -0.4 rad."""
        return grip(self.scene, f"--height-mm={height_mm}", "--azimuth-deg=28.64788975654116", "--obliquity-deg=5.729577951308232",
                    "--roll-deg=-22.918311805232932", "--offset-mm=2", "--hand-scale=1.02")

    def test_a_grip_is_that_of_the_program(self):
        seen = self.seen["grip"]
        known = self.known_grip(60)
        self.assertEqual((seen["is_feasible"], seen["reason"], known["feasible"]), (1, "", True))
        # both are the core's doubles; the angles above come back from degrees, which costs 1e-16 of them
        for ours, theirs in (("joints", "joints_m"), ("proxies", "proxies_m")):
            self.assert_places(in_threes(seen[ours]), known[theirs], 1e-9)
        self.assert_places(seen["posed"], known["posed_m"], 1e-9)
        self.assertAlmostEqual(seen["closure"], known["closure"], delta=1e-9)
        self.assertAlmostEqual(seen["score"], known["score"], delta=1e-9)
        self.assertEqual([bool(seen["touch_mask"] >> joint & 1) for joint in range(24)], known["touching"])
        state = next(s for s in known["states"] if s["fill"] == seen["fill"] and abs(s["tilt_rad"] - seen["tilt"]) < 1e-12)
        self.assertAlmostEqual(seen["mass"], state["mass_kg"], delta=1e-9)
        self.assertAlmostEqual(seen["normal_force"], state["normal_force_N"], delta=1e-9)
        self.assertEqual((seen["name"], seen["highest"], seen["place"]), ("beaker", 0.11, [0.06, 0, 0]))
        text = json.loads(seen["json"])
        self.assertEqual(text.keys(), known.keys())
        self.assert_places(text["posed_m"], known["posed_m"], 1e-9)

    def test_a_batch_is_its_grips(self):
        seen = self.seen["batch"]
        self.assertEqual((seen["device"], seen["notes"]), ("core, 1 thread", ""))
        for k in range(3):
            known = self.known_grip(60 + 10 * k)
            self.assertAlmostEqual(seen["closure"][k], known["closure"], delta=1e-9)
            self.assert_places(in_threes(seen["joints"][72 * k:72 * k + 72]), known["joints_m"], 1e-9)

    def test_variables_have_names_and_units(self):
        self.assertIn("score 1", self.seen["variables"])
        self.assertIn("joints m", self.seen["variables"])

    def test_a_session_s_hand_is_that_of_the_grip(self):
        seen = self.seen["session"]
        self.assertEqual((seen["states"], seen["grasps"], seen["period"]), (["Free", "Touching", "Lift", "Tilt"], 1, 1e-3))
        # the line of the grasp in the frame of the beaker, which stood upright then
        thumb, index = (minus(tip, seen["grasp_place"]) for tip in in_threes(seen["grasp_tips"]))
        known = grip(self.scene, f"--thumb-mm={','.join(f'{1e3 * x:.15g}' for x in thumb)}",
                     f"--index-mm={','.join(f'{1e3 * x:.15g}' for x in index)}",
                     f"--roll-deg={roll_of(unit(minus(index, thumb)), in_threes(seen['gripper'])):.15g}")
        rows = in_threes(seen["vessel_rotation"])
        self.assertGreater(seen["tilt"], 0.1, "it is lifted and tilted by now")
        self.assertGreater(seen["vessel_place"][1], 0.01)
        # 1e-7 m: to which a session finds the hand of a grip (tests/device/session/hand_view_test.cpp)
        self.assert_places([inward(rows, seen["vessel_place"], joint) for joint in seen["joints"]], known["proxies_m"], 1e-7)
        self.assertTrue(all(0.003 < radius < 0.03 for radius in seen["radii"]), seen["radii"])  # m: of skin about fingers
        self.assertGreater(seen["weight"], 1)
        self.assertGreater(seen["feedback"], 0)

    def test_a_hand_in_unity_is_the_mirrored_one(self):
        seen = self.seen["session"]
        pairs = list(zip(seen["joints"], seen["joints_unity"]))
        pairs += [(seen[what], seen[f"{what}_unity"]) for what in ("wrist", "arm", "vessel_place")]
        for ours, unity in pairs:
            self.assertEqual([MIRROR[k] * ours[k] for k in range(3)], unity)
        # a rotation R of the one world is M R M in the other
        turns = [(rows_of(a), rows_of(b)) for a, b in zip(seen["turns"], seen["turns_unity"])]
        turns.append((in_threes(seen["vessel_rotation"]), rows_of(seen["vessel_turn_unity"])))
        for ours, unity in turns:
            for row in range(3):
                for column in range(3):
                    self.assertAlmostEqual(MIRROR[row] * MIRROR[column] * ours[row][column], unity[row][column], delta=1e-12)
        # in Unity +z runs along the bone to the next joint
        for j, name in enumerate(JOINTS):
            if not name.endswith("TIP_EXT"):
                bone = unit(minus(seen["joints_unity"][j + 1], seen["joints_unity"][j]))
                forward = [row[2] for row in rows_of(seen["turns_unity"][j])]
                self.assertAlmostEqual(dot(bone, forward), 1, delta=1e-9, msg=name)

    def test_a_gripper_in_unity_s_axes_is_the_same_gripper(self):
        ours, unity = self.seen["session"], self.seen["unity"]
        self.assertEqual(ours["states"], unity["states"])
        for j in range(24):
            # the turn went through other quaternions: rounding of 1e-16 and a closure of 1e-9 m
            self.assertLess(distance(ours["joints"][j], unity["joints"][j]), 1e-7)

    def test_a_thread_steps_the_session_and_ends_without_force(self):
        seen = self.seen["thread"]
        self.assertEqual(seen["grasps"], 1)
        self.assertGreater(seen["ticks"], 1)
        self.assertGreaterEqual(seen["felt"], seen["ticks"])
        self.assertFalse(seen["last_is_felt"])

    def test_a_thread_that_fails_says_why_and_ends_without_force(self):
        self.assertEqual(self.seen["failing"], {"said": "the session has ended: wh_session_step: the measurement is not finite",
                                                "last_is_felt": False})

    def test_wrong_use_throws_the_line(self):
        seen = self.seen["refusals"]
        program = subprocess.run([PROGRAM, "grip", self.bad, "--vessel", "beaker", "--height-mm", "60"],
                                 capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(program.returncode, 2)
        line = "bad.toml:2:9: scale = 99; allowed: 0.05 to 20"
        self.assertIn(line, program.stderr, "the program's line")
        parts = {
            "bad scene": ("Input", line), "no scene": ("Input", "no scene file '/no/such.toml'"),
            "bad text": ("Input", "mine:2:9: scale = 99; allowed: 0.05 to 20"), "no text": ("Argument", "a pointer is null"),
            "vessel": ("Argument", "the scene has 1 vessels, and none of number 7"), "name": ("Input", "no vessel 'bucket'"),
            "hold": ("Input", "the grip is not feasible"), "later struct": ("Argument", "it is of a later header"),
            "variable": ("Input", "no variable 'color'"), "device": ("Input", "abacus"), "gaps": ("Input", "range of its gap"),
            "before": ("Argument", "no hand before the first step"), "not finite": ("Input", "the measurement is not finite"),
            "no rotation": ("Input", "not a rotation matrix"), "same tick": ("Input", "the tick 0 does not come after the tick 0"),
            "session's vessel": ("Argument", "none of number 9"),
        }
        for wrong, (status, part) in parts.items():
            self.assertTrue(seen[wrong].startswith(status + ": "), f"{wrong}: {seen[wrong]}")
            self.assertIn(part, seen[wrong])
        kinds = {"negative": "ArgumentOutOfRangeException", "joint": "ArgumentOutOfRangeException",
                 "short array": "ArgumentException", "closed": "ObjectDisposedException"}
        self.assertEqual({wrong: seen[wrong] for wrong in kinds}, kinds)
        self.assertEqual(seen.keys(), parts.keys() | kinds.keys())


if __name__ == "__main__":
    unittest.main(verbosity=2)
