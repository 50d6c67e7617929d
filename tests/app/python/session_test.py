# SPDX-License-Identifier: MIT
"""A live session against a recording of the program: the same measurements give the same forces, to the bit."""

import pathlib
import threading
import unittest

import numpy as np
import wholehand as wh
import xarray as xr

from harness import complaint, run
from installed import SEVERAL, InFolder

OPEN = 0.12
# what a step has, and the recording's variable of it
RECORDED = [
    ("arm_force", "wanted_arm_force"),
    ("grip_force", "wanted_gripper_force"),
    ("tilt", "tilt"),
    ("weight", "weight"),
    ("torque", "torque"),
    ("normal_force", "normal_force"),
    ("feedback_force", "feedback_force"),
    ("hold_force", "hold_force"),
    ("user_force", "grip_force"),
    ("safety_margin", "safety_margin"),
    ("slip_distance", "slip_distance"),
    ("slip_angle", "slip_angle"),
    ("slip_speed", "slip_speed"),
    ("closure", "closure"),
    ("gap", "gap"),
    ("middle", "hand_midpoint"),
    ("hand_rotation", "hand_rotation"),
    ("tips", "tips"),
    ("vessel_place", "vessel_place"),
    ("vessel_rotation", "vessel_rotation"),
    ("volume", "liquid_volume"),
    ("arrived", "arrived_volume"),
    ("spilled", "spilled_volume"),
    ("flow", "flow"),
    ("grasp_height", "grasp_height"),
    ("touch_mask", "touch_mask"),
    ("used_mask", "used_mask"),
    ("grasps", "grasps"),
    ("lost", "grips_lost"),
    ("destinations", "destinations"),
    ("is_task_done", "task_done"),
]


class Live(InFolder):
    def replay(self, session, recorded, vessels, states):
        """Steps through a recording's measurements, up to where the loop lets go, which no session does."""
        for k, tick in enumerate(recorded["tick"].astype(int)):
            state = states[recorded["state"][k]]
            if state == "released":
                return
            measured = [recorded["device_" + name][k] for name in ("position", "rotation", "gap")]
            step = session.step(*measured, int(recorded["device_buttons"][k]), tick=int(tick))
            self.assertEqual(step.tick, tick)
            # a meaning of a flag has no spaces
            self.assertEqual(step.state, state.replace("_", " "))
            index = recorded["vessel_index"][k]
            self.assertEqual(step.vessel, None if np.isnan(index) or index < 0 else vessels[int(index)])
            yield step

    def test_it_is_what_the_program_recorded(self):
        run("live", "mixing_board", "--no-clock", "--rate", 500, "--record", "own.nc")
        text = wh.scene("mixing_board").text
        # the recorded rate is the program's option, which a scene has in [live]
        self.assertNotIn("[live]", text)
        scene = wh.scene(text + "\n[live]\nrate_Hz = 500\n")
        with xr.open_dataset("own.nc", decode_times=False) as ticks, wh.session(scene) as session:
            recorded = {name: ticks[name].values for name in ticks.variables}
            states = ticks["state"].attrs["flag_meanings"].split()
            held, reported, efforts = 0, [], []
            for step in self.replay(session, recorded, scene.vessels, states):
                reported.append([getattr(step, own) for own, _ in RECORDED])
                held += step.is_held
                if step.tick % 100 == 0:  # an effort is solved when it is asked for
                    self.assertEqual(np.isnan(step.effort), not step.is_held)
                    efforts += [step.effort] if step.is_held else []
            self.assertGreater(len(reported), 2000)
            for (own, other), values in zip(RECORDED, zip(*reported)):
                np.testing.assert_array_equal(np.array(values, float), recorded[other][: len(reported)].astype(float), own)
            self.assertGreater(held, 500)
            self.assertEqual(step.grasps, 4)
            self.assertTrue(step.is_task_done)
            self.assertGreater(max(efforts), min(efforts))
            self.assertTrue(0 < min(efforts) < 1)
            self.assertAlmostEqual(step.target_volume, step.arrived.sum(), 15)
            self.assertGreater(step.target_volume, 100e-6)

    def approach(self, session, count=30):
        for k in range(count):
            yield session.step([0.02, 0.1 - 1e-3 * k, 0], np.eye(3), OPEN - 1e-4 * k)

    def test_the_hand_is_that_of_the_step(self):
        with wh.session() as session:
            self.refused(session.hand)
            steps = list(self.approach(session))
            hand = session.hand()
            np.testing.assert_array_equal(hand.joints, steps[-1].joints)
            self.assertEqual(
                (hand.joints.shape, hand.posed.shape, hand.rigged.shape, hand.wrist.shape, hand.rotation.shape, len(hand.touching)),
                ((24, 3), (24, 3), (24, 3), (3,), (3, 3), 24),
            )
            # a step that is kept stays what it was, and so does its hand
            self.assertEqual([one.tick for one in steps], list(range(len(steps))))
            self.assertGreater(np.abs(steps[0].joints - steps[-1].joints).max(), 0.02)
            # the tips that the session tracks are the hand's own: thumb tip 3, index tip 8
            np.testing.assert_allclose(hand.rigged[[3, 8]], steps[-1].tips, atol=1e-6)  # the float of a display has 1e-7 of 1 m
            np.testing.assert_allclose(hand.rotation @ hand.rotation.T, np.eye(3), atol=1e-12)
        self.assertEqual(steps[3].joints.shape, (24, 3))

    def test_defaults(self):
        with wh.session("mixing_board", gap=(0.0, 0.1)) as session:
            self.assertEqual((session.gap, session.period), ((0.0, 0.1), 1e-3))
            first = session.step([0, 0.3, 0.2])
            with wh.session("mixing_board", gap=(0.0, 0.1)) as other:
                second = other.step((0, 0.3, 0.2), np.eye(3).tolist(), 0.1, 0)
            np.testing.assert_array_equal(first.joints, second.joints)
            self.assertEqual(session.step([0, 0.3, 0.2], tick=10).tick, 10)
            self.assertEqual(session.step([0, 0.3, 0.2]).tick, 11)
        self.assertIn("1000 Hz", repr(wh.session()))

    def test_what_is_wrong_is_said_and_changes_nothing(self):
        wrong = [
            {"position": [1, 2]},
            {"position": [[1, 2, 3]]},
            {"position": 3},
            {"position": [np.nan, 0, 0]},
            {"position": [0, np.inf, 0]},
            {"position": "here"},
            {"position": None},
            {"position": [1j, 0, 0]},
            {"position": ["0", "0.07", "0"]},
            {"position": [True, False, True]},
            {"position": np.ma.array([0, 0.07, 0], mask=[0, 1, 0])},
            {"position": [[0], 0.07, 0]},
            {"rotation": np.eye(3, dtype=bool)},
            {"rotation": np.eye(3, dtype=complex)},
            {"rotation": np.eye(2)},
            {"rotation": np.zeros((3, 3))},
            {"rotation": 2 * np.eye(3)},
            {"rotation": np.diag([1, 1, -1])},
            {"rotation": np.full((3, 3), np.nan)},
            {"rotation": [1] * 9},
            {"gap": np.nan},
            {"gap": "wide"},
            {"gap": [0.1]},
            {"buttons": -1},
            {"buttons": 1 << 40},
            {"buttons": 0.5},
            {"tick": 1},
            {"tick": -5},
            {"tick": 1 << 70},
            {"tick": (1 << 53) + 1},
            {"tick": (1 << 63) - 1},
            {"tick": "x"},
        ]
        with wh.session() as session, wh.session() as other:
            for one in (session, other):
                for _ in self.approach(one):
                    pass
            for named in wrong:
                with self.subTest(named):
                    self.refused(session.step, **({"position": [0, 0.07, 0], "rotation": None, "gap": OPEN} | named))
            good = {"position": [0.02, 0.07, 0], "gap": 0.115}
            np.testing.assert_array_equal(session.step(**good).joints, other.step(**good).joints)
        for gap in ((0.1, 0.1), (0.2, 0.1), (np.nan, 1), (0,), (0, 1, 2)):
            self.refused(wh.session, gap=gap)

    def test_the_last_tick(self):
        with wh.session() as session:
            self.assertEqual(session.step([0, 0.3, 0.2], tick=1 << 53).tick, 1 << 53)
            for _ in range(2):
                self.assertIn("allowed: up to 9007199254740992", str(self.refused(session.step, [0, 0.3, 0.2])))

    def test_whole_numbers_and_floats_are_numbers(self):
        with wh.session() as session, wh.session() as other:
            first = session.step(np.array([0, 1, 0], np.int16), np.eye(3, dtype=np.float32), 0.1)
            np.testing.assert_array_equal(first.joints, other.step([0.0, 1.0, 0.0], None, 0.1).joints)

    def test_what_no_arm_reaches_is_refused(self):
        line = "session: the measurement is out of reach; allowed: a position up to 25 m, a gap up to 10 m"
        with wh.session() as session:
            for size in (26, 1e3, 1e10, 1e100, 1e300, -1e300):
                self.assertEqual(str(self.refused(session.step, [size, -size, size], None, 0.1)), line)
                self.assertEqual(str(self.refused(session.step, [0, 0.3, 0.2], None, abs(size))), line)
            joints = session.step([25, -25, 25], None, 10).hand().joints  # as far as it goes
            self.assertTrue(np.isfinite(joints).all())

    def test_a_closed_session_says_so(self):
        session = wh.session()
        kept = session.step([0, 0.3, 0.2])
        with session:
            pass
        self.assertTrue(session.closed)
        for call in (lambda: session.step([0, 0.3, 0.2]), session.hand):
            self.assertEqual(str(self.refused(call)), "session: it is closed")
        session.close()
        self.assertEqual((kept.state, kept.joints.shape), ("free", (24, 3)))
        self.assertIn("closed", repr(session))

    def test_another_thread_is_refused(self):
        session, seen = wh.session(), []

        def work():
            try:
                session.step([0, 0.3, 0.2])
            except wh.Error as error:
                seen.append(str(error))

        session.step([0, 0.3, 0.2])
        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        self.assertEqual(seen, ["session: it belongs to the thread of its first step, and this is another one"])
        self.assertEqual(session.step([0, 0.3, 0.2]).tick, 1)

    def test_a_scene_that_cannot_be_played_is_refused_as_by_the_program(self):
        pathlib.Path("scene.toml").write_text(SEVERAL)
        code, line = complaint("live", "scene.toml", "--no-clock")
        self.assertEqual(code, 2)
        self.assertEqual(line, f"{self.refused(wh.session, 'scene.toml')}; shipped scenes whose vessels have places: mixing_board")


if __name__ == "__main__":
    unittest.main()
