# SPDX-License-Identifier: MIT
"""One grip against `wholehand grip`: every value, its table and its drawings."""

import json
import pathlib
import pickle
import unittest

import numpy as np
import wholehand as wh

from harness import complaint, run
from installed import MESH, SEVERAL, InFolder, tube_ply

AT = {"height_mm": 40.5, "azimuth_deg": 12, "obliquity_deg": -5, "roll_deg": -33, "offset_mm": 3, "hand_scale": 0.95}


def options(named):
    return [one for name, value in named.items() for one in (f"--{name.replace('_', '-')}", value)]


def plain(value):
    return value.tolist() if isinstance(value, np.ndarray) else [plain(one) for one in value] if isinstance(value, list) else value


class OneGrip(InFolder):
    def setUp(self):
        super().setUp()
        pathlib.Path("scene.toml").write_text(SEVERAL)

    def same(self, grip, *arguments):
        expected = json.loads(run("grip", *arguments, "--json", code=0 if grip.feasible else 1))
        self.assertEqual(list(grip), list(expected))
        for name, value in expected.items():
            if name != "states":
                self.assertEqual(plain(grip[name]), value, name)
        self.assertEqual(grip._values, expected)
        return expected

    def test_it_is_what_the_program_says(self):
        for vessel, named in (
            ("low", AT),
            ("tall", AT | {"height_mm": 80}),
            ("low", {"height_mm": 300}),
            ("tall", {"height_mm": 50, "roll_deg": 170}),
        ):
            grip = wh.grip("scene.toml", vessel, **named)
            expected = self.same(grip, "scene.toml", "--vessel", vessel, *options(named))
            code = 0 if grip.feasible else 1
            self.assertEqual(str(grip), run("grip", "scene.toml", "--vessel", vessel, *options(named), code=code))
            self.assertEqual(
                (grip.feasible, grip.reason, grip.score), (expected["feasible"], expected["reason"], expected.get("score", 0))
            )
            for points in (grip.joints, grip.posed, grip.proxies):
                self.assertEqual(points.shape, (24, 3))
                self.assertEqual(np.isnan(points).any(), not grip.feasible)
            self.assertEqual(grip.separation.shape, (24,))
            if grip.feasible:
                np.testing.assert_array_equal(grip.joints, expected["joints_m"])
                np.testing.assert_array_equal(grip.posed, expected["posed_m"])

    def test_states_asked_for(self):
        asked = {"fills": [0.1, 0.5], "tilts_deg": [0, 20, 85]}
        grip = wh.grip("scene.toml", "low", **AT, **asked)
        arguments = ["scene.toml", "--vessel", "low", *options(AT), "--fill", 0.1, 0.5, "--tilt-deg", 0, 20, 85]
        expected = self.same(grip, *arguments)["states"]
        states = grip.states
        self.assertEqual(dict(states.sizes), {"fill": 2, "tilt": 3, "xyz": 3})
        for k, one in enumerate(expected):
            at = states.isel(fill=k // 3, tilt=k % 3)
            self.assertEqual((float(at.fill), float(at.tilt)), (one["fill"], one["tilt_rad"]))
            self.assertEqual(float(at.torque), one["torque_Nm"])
            self.assertEqual(float(at.effort), one["effort"])
            self.assertEqual(at.com.values.tolist(), one["com_m"])
        self.assertEqual(
            [states[name].attrs["units"] for name in ("torque", "mass", "hold_force", "poured", "effort")],
            ["N m", "kg", "N", "m3", "1"],
        )
        self.same(
            wh.grip("scene.toml", "low", **AT, fills_ml=50, tilts_deg=10),
            "scene.toml",
            "--vessel",
            "low",
            *options(AT),
            "--fill-ml",
            50,
            "--tilt-deg",
            10,
        )

    def test_other_ways_to_say_where(self):
        ends = {"thumb_mm": (-40, 35, 2), "index_mm": (40, 30, 4)}
        self.same(
            wh.grip("scene.toml", "low", **ends, roll_deg=-20),
            "scene.toml",
            "--vessel",
            "low",
            "--thumb-mm=-40,35,2",
            "--index-mm=40,30,4",
            "--roll-deg",
            -20,
        )
        expected = wh.grip("scene.toml", "low", **AT)
        row = [
            expected["grip"][name] for name in ("height_m", "azimuth_rad", "obliquity_rad", "roll_rad", "offset_m", "hand_scale")
        ]
        structured = np.array([tuple(row)], wh.GRIP)
        for at in (
            row,
            tuple(row),
            np.array(row),
            np.array([row]),
            structured,
            structured[0],
            {"height": row[0], "azimuth": row[1], "obliquity": row[2], "roll": row[3], "offset": row[4], "hand_scale": row[5]},
        ):
            self.assertEqual(wh.grip("scene.toml", "low", at=at)._values, expected._values)

    def test_names_in_si_mean_the_same_as_names_with_units(self):
        rad = np.pi / 180
        si = {"height": 40.5 / 1e3, "azimuth": 12 * rad, "obliquity": -5 * rad, "roll": -33 * rad, "offset": 3 / 1e3}
        expected = wh.grip("scene.toml", "low", **AT)
        self.assertEqual(wh.grip("scene.toml", "low", **si, hand_scale=0.95)._values, expected._values)
        mixed = {"height_mm": 40.5, "azimuth_deg": 12, "obliquity_deg": -5, "roll": -33 * rad, "offset": 3 / 1e3, "hand_scale": 0.95}
        self.assertEqual(wh.grip("scene.toml", "low", **mixed)._values, expected._values)
        self.assertEqual(wh.grip("scene.toml", "low", at=AT)._values, expected._values)
        ends = {"thumb_mm": (-40, 35, 2), "index_mm": (40, 30, 4)}
        turned = wh.grip("scene.toml", "low", **ends, roll=-20 * rad)["grip"]["roll_rad"]
        self.assertAlmostEqual(turned, -20 * rad, 15)
        # what a scene says of its states can be asked for again
        scene = wh.scene("scene.toml")
        again = wh.grip(scene, "low", **AT, fills=scene.fills("low"), tilts=scene.tilts).states
        np.testing.assert_allclose(again.torque.values, expected.states.torque.values, rtol=1e-12)
        for named, words in (
            ({"height": 0.04, "height_mm": 40}, "both height and height_mm are given"),
            ({"height": 0.04, **ends}, "height excludes --thumb-mm"),
            ({"roll": 1, "at": [0.04, 0, 0, 0, 0, 1]}, "roll excludes at"),
            ({"roll": 1}, "'height' is missing (or 'height_mm')"),
            ({"height": 0.04, "tilts": 0.1, "tilts_deg": 5}, "both tilts and tilts_deg are given"),
        ):
            self.assertIn(words, str(self.refused(wh.grip, "scene.toml", "low", **named)))

    def test_on_a_device_and_with_its_quality(self):
        self.same(wh.grip("scene.toml", "low", **AT, on="vulkan"), "scene.toml", "--vessel", "low", *options(AT), "--on", "vulkan")
        few = {"fills": 0.25, "tilts_deg": 0}
        grip = wh.grip("scene.toml", "low", **AT, **few, quality=True)
        self.assertTrue((grip["epsilon"] >= 0).all())
        self.same(grip, "scene.toml", "--vessel", "low", *options(AT), "--fill", 0.25, "--tilt-deg", 0, "--quality")
        shares = grip.states.finger_share
        self.assertEqual(shares.dims, ("fill", "tilt", "finger"))
        self.assertEqual(shares.finger.values.tolist(), ["index", "middle", "ring", "little"])
        self.assertEqual(shares.values.ravel().tolist(), grip["states"][0]["finger_share"])
        self.assertTrue((grip.states.finger_share_low <= shares).all() and (shares <= grip.states.finger_share_high).all())

    def test_drawings_are_the_programs(self):
        grip = wh.grip("scene.toml", "low", **AT)
        grip.svg("own.svg")
        grip.glb(pathlib.Path("own.glb"))
        run("grip", "scene.toml", "--vessel", "low", *options(AT), "--svg", "other.svg", "--glb", "other.glb")
        self.assertEqual(pathlib.Path("own.svg").read_bytes(), pathlib.Path("other.svg").read_bytes())
        self.assertEqual(pathlib.Path("own.glb").read_bytes(), pathlib.Path("other.glb").read_bytes())
        self.assertEqual(grip.plot()._repr_svg_(), pathlib.Path("own.svg").read_text())
        self.assertEqual(grip._repr_svg_(), pathlib.Path("own.svg").read_text())
        grip.svg("own.svg")  # its own drawing is overwritten, other files are not
        pathlib.Path("mine.svg").write_text("<svg/>")
        self.assertEqual(
            (2, str(self.refused(grip.svg, "mine.svg"))),
            complaint("grip", "scene.toml", "--vessel", "low", *options(AT), "--svg", "mine.svg"),
        )
        self.assertEqual(pathlib.Path("mine.svg").read_text(), "<svg/>")
        far = wh.grip("scene.toml", "low", height_mm=300)
        self.assertIsNone(far._repr_svg_())
        for draw in (far.plot, lambda: far.svg("far.svg"), lambda: far.glb("far.glb")):
            self.refused(draw)
        self.assertFalse(pathlib.Path("far.svg").exists())

    def test_of_a_mesh(self):
        pathlib.Path("tube.ply").write_text(tube_ply())
        pathlib.Path("mesh.toml").write_text(MESH)
        named = {"height_mm": 45, "roll_deg": -30}
        self.same(wh.grip("mesh.toml", "tube", **named), "mesh.toml", "--vessel", "tube", *options(named))

    def test_what_is_wrong_is_said_as_the_program_says_it(self):
        for wrong in (
            {"height_mm": 1e9},
            {"height_mm": 40, "roll_deg": -1000},
            {"height_mm": 40, "obliquity_deg": 91},
            {"height_mm": 40, "hand_scale": 0.01},
            {"height_mm": 40, "offset_mm": 1e5},
            {"height_mm": 40, "azimuth_deg": 361.5},
        ):
            error = self.refused(wh.grip, "scene.toml", "low", **wrong)
            code, line = complaint("grip", "scene.toml", "--vessel", "low", *options(wrong))
            self.assertEqual(str(error).split("'")[0::2], line.split("'")[0::2])  # numbers may be written in two ways
        for named in ({}, {"thumb_mm": [1, 2, 3]}, {"height_mm": 1, "index_mm": [1, 2, 3]}):
            self.assertIn("the place of the grip", str(self.refused(wh.grip, "scene.toml", "low", **named)))
        for named in (
            {"at": [1, 2, 3]},
            {"at": np.zeros((2, 6))},
            {"at": [np.nan] * 6},
            {"thumb_mm": [1, 2], "index_mm": [1, 2, 3]},
            {"height_mm": 40, "fills": [2]},
            {"height_mm": 40, "fills": 1, "fills_ml": 1},
            {"height_mm": 40, "tilts_deg": [np.nan]},
            {"height_mm": float("nan")},
        ):
            self.refused(wh.grip, "scene.toml", "low", **named)
        for named, words in (
            ({"height_mm": "40"}, "grip: height_mm is str; allowed: a number"),
            ({"height_mm": 40, "roll_deg": [1, 2]}, "grip: roll_deg is list; allowed: a number"),
            ({"height_mm": 40, "fills": "half"}, "grip: fills is str; allowed: a number, or a list of numbers"),
            ({"height_mm": 40, "quality": 1}, "grip: quality is int; allowed: True or False"),
        ):
            with self.assertRaises(TypeError) as caught:
                wh.grip("scene.toml", "low", **named)
            self.assertEqual(str(caught.exception), words)

    def test_two_ways_to_say_where_exclude_each_other(self):
        ends = {"thumb_mm": [-40, 35, 2], "index_mm": [40, 30, 4]}
        texts = ["--thumb-mm=-40,35,2", "--index-mm=40,30,4"]
        for name in ("height_mm", "azimuth_deg", "obliquity_deg", "offset_mm"):
            error = self.refused(wh.grip, "scene.toml", "low", **ends, **{name: 0})
            code, line = complaint("grip", "scene.toml", "--vessel", "low", *texts, *options({name: 0}))
            self.assertEqual((error.exit_code, str(error)), (code, line.partition(";")[0]))
        at = [0.04, 0, 0, 0, 0, 1]
        for name in ("height_mm", "azimuth_deg", "obliquity_deg", "roll_deg", "offset_mm", "hand_scale"):
            self.assertEqual(str(self.refused(wh.grip, "scene.toml", "low", at=at, **{name: 1})), f"{name} excludes at")
        self.assertEqual(str(self.refused(wh.grip, "scene.toml", "low", at=at, **ends)), "thumb_mm excludes at")

    def test_equal_grips_and_pickled_ones(self):
        grip, same, other = (wh.grip("scene.toml", "low", **AT | {"height_mm": height}) for height in (40.5, 40.5, 41))
        self.assertTrue(grip == same)
        self.assertFalse(grip == other)
        self.assertFalse(grip == 3)
        again = pickle.loads(pickle.dumps(grip))
        self.assertEqual(again, grip)
        self.assertEqual(again.plot().svg, grip.plot().svg)


if __name__ == "__main__":
    unittest.main()
