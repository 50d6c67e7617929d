# SPDX-License-Identifier: MIT
"""Scenes from names, paths, texts and dicts; errors have the program's words."""

import pathlib
import pickle
import tomllib
import unittest

import numpy as np
import wholehand as wh

from harness import complaint, run
from installed import MESH, SEVERAL, InFolder, tube_ply


def cup_obj() -> str:
    """A square cup, 7 x 10 x 7 cm, whose cavity is 6 x 9 x 6 cm: rings of corners, the walls between them, the base and the floor."""
    rings = [(3.5, 0), (3.5, 10), (3, 10), (3, 1)]
    corners = [(x * r, y, z * r) for r, y in rings for x, z in ((-1, -1), (-1, 1), (1, 1), (1, -1))]
    walls = [(4 * k + j, 4 * k + (j + 1) % 4, 4 * k + 4 + (j + 1) % 4, 4 * k + 4 + j) for k in range(3) for j in range(4)]
    faces = [*walls, (3, 2, 1, 0), (12, 13, 14, 15)]
    return "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {' '.join(str(k + 1) for k in face)}\n" for face in faces)


class Scenes(InFolder):
    def test_a_name_a_path_and_a_text_are_the_same_scene(self):
        named = wh.scene("three_beakers")
        pathlib.Path("own.toml").write_text(named.text)
        for other in (wh.scene("own.toml"), wh.scene(pathlib.Path("own.toml")), wh.scene(named.text)):
            self.assertEqual(other.text, named.text)
            self.assertEqual(other.vessels, ("beaker1", "beaker2", "beaker3"))
        self.assertIs(wh.scene(named), named)
        self.assertEqual(wh.scene(named.text).file, "text")
        self.assertEqual(named.name, "three_beakers")

    def test_a_new_scene_is_that_of_the_program(self):
        run("new", "cup", "--shape", "flask", "--diameter-mm", "85", "--neck-mm", "34", "--height-mm", "140", "--fill-ml", "100")
        made = wh.new("cup", shape="flask", diameter_mm=85, neck_mm=34, height_mm=140, fill_ml=100)
        self.assertEqual(made.text, pathlib.Path("cup.toml").read_text())
        with self.assertRaisesRegex(wh.Error, "lacks 'height_mm'"):
            wh.new("cup", diameter_mm=85)
        with self.assertRaisesRegex(TypeError, "radius_mm"):
            wh.new("cup", radius_mm=85)

    def test_shipped_scenes_are_those_of_the_program(self):
        listed = run("scenes")
        self.assertGreaterEqual(len(wh.scenes()), 4)
        for name in wh.scenes():
            self.assertIn(name, listed)
            wh.scene(name)

    def test_a_dict_is_the_scene_that_its_text_is(self):
        for name in (*wh.scenes(), SEVERAL):
            text = wh.scene(name).text
            of_dict = wh.scene(tomllib.loads(text))
            self.assertEqual(tomllib.loads(of_dict.text), tomllib.loads(text))
            self.assertEqual(of_dict.vessels, wh.scene(name).vessels)

    def test_a_dict_takes_what_numpy_has_and_any_text(self):
        glass = {
            "name": "a",
            "outline": ({"line": np.array([30, 0])}, {"line": [np.float32(30), np.int8(90)]}, {"line": [0, 90]}),
            "wall_mm": 2,
        }
        scene = wh.scene(
            {
                "scene": {"name": "quotes"},
                "vessel": [glass],
                "grips": {"height_mm": np.linspace(20, 60, 5)},
                "tilts": {"deg": [0.1 + 0.2]},
            }
        )
        self.assertEqual(scene.tilts[0], np.float64(0.1 + 0.2) * (np.pi / 180))
        for text in ('say "hi"\\', "line\nbreak\ttab", "\x7f\x01", "Grüße 🖐", "", "'''"):
            made = wh._toml.toml_text({text or "k": {"k.e y": text, "list": [text, {"in ner": text}]}})
            self.assertEqual(tomllib.loads(made), {text or "k": {"k.e y": text, "list": [text, {"in ner": text}]}})
        paths = {"mesh": pathlib.Path("a folder") / "cup.obj", "list": [pathlib.PurePosixPath("/b")]}
        self.assertEqual(tomllib.loads(wh._toml.toml_text(paths)), {"mesh": "a folder/cup.obj", "list": ["/b"]})
        numbers = {"a": [1e-300, -0.0, 1e16, 123456789012345678, float("inf"), True]}
        self.assertEqual(tomllib.loads(wh._toml.toml_text(numbers)), numbers)

    def test_what_no_dict_of_a_scene_has_is_named(self):
        for value, word in (
            (None, "NoneType"),
            (object(), "object"),
            ({1: 2}, "key 1"),
            (b"x", "bytes"),
            (1j, "complex"),
            ("\ud800", "Unicode"),
        ):
            self.assertIn(word, str(self.refused(wh.scene, {"grips": {"height_mm": value}})))
        self.assertIn("key 7", str(self.refused(wh.scene, {7: 1})))

    def test_the_line_of_an_error_is_the_programs(self):
        broken = [
            SEVERAL.replace("wall_mm = 2\n", "wall_mm = -2\n"),
            SEVERAL + "[unknown]\n",
            SEVERAL.replace('name = "low"', 'name = "tall"'),
            "x = \n",
            "\n",
            SEVERAL.replace("fills = [0.25, 0.75]", "fills = [0.75, 0.25]"),
        ]
        for text in broken:
            pathlib.Path("scene.toml").write_text(text)
            code, line = complaint("sweep", "scene.toml", "--on", "core")
            error = self.refused(wh.scene, "scene.toml")
            self.assertEqual((error.exit_code, str(error)), (code, line))
            of_text = self.refused(wh.scene, text, file="scene.toml")
            self.assertEqual(str(of_text), line)
        for name in ("nowhere.toml", "three_beaker", ".", ""):
            if name:
                self.assertEqual((2, str(self.refused(wh.scene, name))), complaint("sweep", name))

    def test_an_error_in_a_dict_shows_the_line_that_it_means(self):
        glass = {"name": "a", "outline": [{"line": [30, 0]}, {"line": [30, 90]}, {"line": [0, 90]}], "wall_mm": 1e6}
        error = self.refused(wh.scene, {"vessel": [glass]})
        self.assertTrue(str(error).startswith("dict:4:"), error)
        self.assertEqual(len(error.__notes__), 1)
        self.assertTrue(error.__notes__[0].endswith("wall_mm = 1000000.0"), error.__notes__)

    def test_other_types_are_a_type_error(self):
        for source in (3, None, [1], b"three_beakers"):
            with self.assertRaises(TypeError):
                wh.scene(source)

    def test_a_pickled_scene_is_the_same_and_so_is_an_error(self):
        scene = pickle.loads(pickle.dumps(wh.scene(SEVERAL)))
        self.assertEqual((scene.text, scene.file, scene.vessels), (SEVERAL, "text", ("tall", "low")))
        error = pickle.loads(pickle.dumps(wh.Error("a line", 3)))
        self.assertEqual((str(error), error.exit_code), ("a line", 3))

    def test_states_and_variables(self):
        scene = wh.scene(SEVERAL)
        np.testing.assert_array_equal(scene.fills("low"), [0.25, 0.75])
        np.testing.assert_allclose(scene.tilts, np.radians([0, 40, 80]), rtol=1e-15)
        known = scene.variables()
        self.assertEqual(known["joints"].dims, ("joint", "xyz"))
        self.assertEqual((known["torque"].units, known["torque"].dims), ("N m", ("fill", "tilt")))
        self.assertIn("worst_effort", known)
        plain = wh.scene(SEVERAL[: SEVERAL.index("[tilts]")]).variables()
        self.assertNotIn("torque", plain)
        self.assertIn("score", plain)

    def test_vessels_are_found_by_name_and_number(self):
        scene = wh.scene(SEVERAL)
        self.assertEqual(
            (2, str(self.refused(scene.fills, "lo"))), complaint("grip", self.written(SEVERAL), "--vessel", "lo", "--height-mm", 30)
        )
        for number in (2, -1, 10**30):
            self.assertIn("allowed: 0 to 1", str(self.refused(scene.fills, number)))
        for wrong in (1.0, None, True, b"low"):
            with self.assertRaises(TypeError):
                scene.fills(wrong)
        np.testing.assert_array_equal(scene.fills(np.int64(1)), scene.fills("low"))

    def written(self, text):
        pathlib.Path("text").write_text(text)
        return "text"

    def test_a_mesh_is_surveyed_as_the_program_does(self):
        pathlib.Path("cup.obj").write_text(cup_obj())
        cup = wh.mesh("cup.obj")
        self.assertAlmostEqual(cup["cavity"]["capacity_ml"], 6 * 9 * 6, delta=1)
        self.assertEqual(cup["keys"]["mesh_scale"], "0.01")
        self.assertIn("cavity: ", str(cup))
        self.assertIn("<svg", cup.plot().svg)
        scene = cup.scene("cup", fill_ml=100, density_kg_m3=1050)
        self.assertIn("density_kg_m3 = 1050", scene.text)
        self.assertEqual(wh.new("cup", mesh="cup.obj", fill_ml=100, density_kg_m3=1050).text, scene.text)
        self.assertIn("part = 2: it has 1 part", str(self.refused(wh.mesh, "cup.obj", part=2)))
        self.assertIn("allowed: 'y' or 'z'", str(self.refused(wh.mesh, "cup.obj", up="x")))

    def test_meshes_are_looked_for_from_the_file_and_their_notes_are_there(self):
        pathlib.Path("deeper").mkdir()
        pathlib.Path("deeper/tube.ply").write_text(tube_ply())
        scene = wh.scene(MESH, file="deeper/scene.toml")
        self.assertTrue(any("tube" in line for line in scene.notes()), scene.notes())
        self.assertIn("tube.ply", str(self.refused(wh.scene(MESH).notes)))


if __name__ == "__main__":
    unittest.main()
