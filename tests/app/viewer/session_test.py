# SPDX-License-Identifier: MIT
"""A live session in the viewer, from reach to return; then the same session as a recording, played and scrubbed."""

import os
import re

from netCDF4 import Dataset

from support import PATIENCE, ViewerTest, complaints, main, slide

SCENE = """
[scene]
name = "one_beaker"

[[vessel]]
name = "beaker"
shape = "cylinder"
diameter_mm = 80
height_mm = 110
wall_mm = 1.5
force_range_N = 2
place_mm = [60, 0, 0]
liquid = { name = "red", fill = 0.8 }
guidance_mm = [[65, 0]]

[liquid]
fills = [0, 0.8]

[task]
target = { place_mm = [0, 60, -200], diameter_mm = 120 }
amounts_ml = { red = 20 }
destination_mm = [-200, 0, 0]
tolerance_ml = 5

[force]
torsion_mm = 30  # so that the gripper's 8 N hold it at any tilt

[live]
late_steps = 1000  # on however busy a machine
slide = true
"""
HELD = ["lift", "tilt", "maintain"]
# What the page shows, kept at each picture: states in their order, and the largest of what changes
WATCH = """(() => {
  const seen = window.seen = {states: [], arrived: 0, tilt: 0, streams: 0, feedback: 0, texts: new Set()};
  const look = () => {
    const {frame} = wholehand;
    if (seen.states[seen.states.length - 1] !== frame.state) seen.states.push(frame.state);
    seen.arrived = Math.max(seen.arrived, frame.amounts[0].arrived);
    seen.tilt = Math.max(seen.tilt, frame.tilt || 0);
    seen.feedback = Math.max(seen.feedback, frame.forces.feedback);
    if (frame.stream && wholehand.view.pour.stream.visible) seen.streams += 1;
    seen.texts.add(document.querySelector('#amounts output').textContent);
    setTimeout(look, 10);
  };
  look();
})()"""


class ASession(ViewerTest):
    scale = 0.5

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        with open(os.path.join(cls.folder, "one.toml"), "w") as file:
            file.write(SCENE)
        cls.live = cls.serve("live", "one.toml", "--view", "--record", "one.nc")
        cls.page = cls.browser.open(cls.live.address, 700, 600, cls.scale)
        cls.page.wait("window.wholehand && wholehand.frame", what="the first frame")
        cls.page.evaluate(WATCH)
        cls.page.wait("document.getElementById('link').dataset.status === 'over'", 3 * PATIENCE, "the session's end")
        cls.seen = cls.page.evaluate("({...seen, texts: [...seen.texts]})")
        cls.last = cls.page.evaluate("wholehand.frame")
        cls.live_limit = 8  # N: the simulated gripper's
        cls.said = cls.page.evaluate("document.getElementById('link').textContent")
        cls.recording = cls.serve("view", "one.nc")
        cls.data = Dataset(os.path.join(cls.folder, "one.nc"))
        cls.addClassCleanup(cls.data.close)

    def value(self, name, t):
        """What the recording has at that moment: of its newest tick."""
        times = self.data["time"][:]
        return self.data[name][max(k for k in range(len(times)) if times[k] <= t + 1e-9)]

    # ---- live ----

    def test_runs_from_reach_to_return(self):
        states = self.seen["states"]
        self.assertIn(states[0], ["free", "touching"] + HELD)  # the page may open late
        first_held = next(k for k, state in enumerate(states) if state in HELD)
        self.assertIn("tilt", states[first_held:])
        last_held = max(k for k, state in enumerate(states) if state in HELD)
        self.assertTrue(set(states[last_held + 1:]) & {"free", "touching", "let go", "released"}, states)

    def test_amounts_change_while_it_pours(self):
        self.assertGreater(self.seen["streams"], 0)
        self.assertGreater(self.seen["tilt"], 0.5)
        self.assertAlmostEqual(self.seen["arrived"], 20e-6, delta=5e-6)
        self.assertGreater(len(self.seen["texts"]), 3, self.seen["texts"])

    def test_forces_are_felt(self):
        self.assertGreater(self.seen["feedback"], 0.8)
        self.assertLessEqual(self.seen["feedback"], 8)

    def test_the_target_shows_what_is_in_it(self):
        volume = self.last["target_volume"]
        self.assertGreater(volume, 15e-6)
        level = self.page.evaluate("wholehand.view.pour.filling.level.value")
        self.assertAlmostEqual(level, volume / (3.141592653589793 * 0.06 ** 2), delta=1e-9)

    def test_less_than_is_seen_is_not_drawn(self):
        for volume, flow, is_seen in [(1e-15, 9.5e-9, False), (1.1e-8, 1.1e-8, True)]:
            drawn = self.page.evaluate(f"""(({{view, frame}}) => {{
              const stream = {{from: [0, 0.2, -0.2], to: [0, 0, -0.2], flow: {flow}}};
              view.show({{...frame, vessel: 0, stream, target_volume: {volume}, vessels: frame.vessels.map((state) => ({{...state, volume: {volume}, up: [0, 1, 0], level: 0.0015}}))}});
              return [...view.liquids[0].parts, ...view.pour.filling.parts, view.pour.stream].map((part) => part.visible); }})(wholehand)""")
            self.assertEqual(set(drawn), {is_seen}, f"{volume} m3, {flow} m3/s")
        self.page.evaluate("wholehand.view.show(wholehand.frame)")

    def test_what_stands_higher_has_a_table_of_its_own(self):
        tables = "(({view}) => { view.frameHome(); return view.stage.tables.map(({position}) => position.toArray()); })(wholehand)"
        lift = "wholehand.scene.vessels[0].place[1] += {}"
        self.assertEqual([at[1] for at in self.page.evaluate(tables)], [0])
        self.page.evaluate(lift.format(0.25))
        self.assertEqual(self.page.evaluate(tables)[1:], [[0.06, 0.25, 0]])
        self.page.evaluate(lift.format(-0.25))
        self.assertEqual(len(self.page.evaluate(tables)), 1)

    def test_the_force_is_what_is_written_and_the_clamp_is_reported(self):
        most = self.page.evaluate("wholehand.scene.force.most")
        self.assertEqual(most, self.live_limit)
        for forces, said in [({"feedback": 10.93, "written": 8, "normal": 0, "opening": 0, "base": 0}, "clamped to 8.00 N, 10.93 N asked for"),
                             ({"feedback": 8, "written": 8, "normal": 6, "opening": 3.5, "base": 0.8}, "clamped to 8.00 N, 9.50 N asked for"),
                             ({"feedback": 5, "written": 5, "normal": 4, "opening": 3, "base": 0.8}, "clamped to 5.00 N, 7.00 N asked for"),
                             ({"feedback": 5, "written": 2, "normal": 2.5, "opening": 2.5, "base": 0.8}, "2.00 N so far, 5.00 N asked for"),
                             ({"feedback": 3.8, "written": 3.8, "normal": 0.8, "opening": 3, "base": 0.8}, "")]:
            shown = self.page.evaluate(f"""((forces) => {{ wholehand.panels.showForce(forces);
              const bar = document.querySelector('.force-bar').getBoundingClientRect();
              const parts = [...document.querySelectorAll('.part:not(.asked)')].map((part) => part.getBoundingClientRect()).filter(({{width}}) => width > 0);
              return [document.querySelector('.force-value').textContent, document.querySelector('.clamp').textContent,
                (Math.max(...parts.map(({{right}}) => right)) - bar.left) / bar.width * {most}]; }})({forces})""")
            self.assertEqual(shown[:2], [f"{forces['written']:.2f}", said])
            self.assertAlmostEqual(shown[2], forces["written"], delta=0.01, msg="the bar ends there")

    def test_margin_and_slip_are_shown(self):
        rows = "((slip) => { wholehand.panels.showSlip(slip); return ['margin', 'slip', 'slipTurn'].map((key) => wholehand.panels.forceRows[key].textContent); })"
        for slip, shown in [('{"margin": 0.524, "distance": 0, "angle": 0, "speed": 0}', ["0.52", "0.0 mm", "0.0°"]),
                            ('{"margin": -0.25, "distance": 0.00321, "angle": -0.1, "speed": 0.02}', ["−0.25", "3.2 mm, slips", "−5.7°"]),
                            ('{"margin": null, "distance": 0.01, "angle": 0.5, "speed": 0.1}', ["−∞", "10.0 mm, slips", "28.6°"]),
                            ("undefined", ["–", "–", "–"])]:
            self.assertEqual(self.page.evaluate(f"{rows}({slip})"), shown, slip)

    def test_the_page_says_that_it_is_over(self):
        self.assertRegex(self.said, "^over")

    def test_there_is_nothing_to_complain_about(self):
        self.assertEqual(complaints(self.page), [])

    def test_the_chart_has_the_last_ten_seconds(self):
        records = self.page.evaluate("wholehand.history.records.map((r) => r.x)")
        self.assertEqual(records, sorted(records))
        self.assertAlmostEqual(records[-1], self.last["t"], delta=1e-9)
        self.assertGreater(records[0], self.last["t"] - 11)

    # ---- recorded ----

    def test_scrubbing_shows_what_was_recorded(self):
        page = self.open(self.recording)
        duration = self.recording.get("scene.json")["duration"]
        for share in [0.1, 0.45, 0.5, 0.9, 0.3]:
            t = round(share * duration, 2)
            slide(page, "scrub", t)
            page.wait(f"wholehand.frame.t <= {t} + 1e-9 && wholehand.frame.t > {t} - 0.02", what=f"the frame of {t} s")
            shown = page.evaluate("wholehand.frame")
            at = shown["t"]
            self.assertEqual(shown["tick"], self.value("tick", at))
            for name, variable, tolerance in [("closure", "closure", 1e-6), ("gap", "gap", 1e-7), ("tilt", "tilt", 1e-6)]:
                self.assertAlmostEqual(shown[name], self.value(variable, at), delta=tolerance, msg=f"{name} at {at}")
            for name, variable in [("feedback", "feedback_force"), ("normal", "normal_force"), ("opening", "opening_force"), ("user", "grip_force")]:
                self.assertAlmostEqual(shown["forces"][name], self.value(variable, at), delta=1e-5, msg=f"{name} at {at}")
            self.assertAlmostEqual(shown["vessels"][0]["volume"], self.value("liquid_volume", at)[0], delta=1e-10)
            self.assertAlmostEqual(shown["amounts"][0]["arrived"], self.value("arrived_volume", at)[0], delta=1e-10)
            if shown["state"] in HELD + ["touching"]:  # thumb and index finger are drawn at what was felt
                for joint, tip in [(3, 0), (8, 1)]:
                    self.assert_near(shown["joints"][joint], self.value("proxies", at)[tip], 5e-4, f"tip {tip} at {at}")
            self.assertAlmostEqual(shown["forces"]["written"], self.value("written_gripper_force", at), delta=1e-5, msg=f"written at {at}")
            text = f"{self.value('written_gripper_force', at):.2f}".replace("-0.00", "0.00").replace("-", "−")
            page.wait(f"document.querySelector('.force-value').textContent === '{text}'", what=f"{text} N")

    def test_play_and_pause(self):
        page = self.open(self.recording)
        page.evaluate("document.activeElement.blur()")
        page.key(" ")
        page.wait("wholehand.playback.t > 0.3", what="playing")
        page.key(" ")
        at = page.evaluate("[wholehand.playback.isPlaying, wholehand.playback.t]")
        self.assertFalse(at[0])
        self.assertEqual(page.evaluate("new Promise((done) => setTimeout(() => done(wholehand.playback.t), 300))"), at[1])
        page.key(".")
        page.wait(f"Math.abs(wholehand.playback.t - {at[1]} - 0.1) < 1e-6")

    def test_the_end_is_the_end(self):
        page = self.open(self.recording)
        duration = self.recording.get("scene.json")["duration"]
        page.evaluate("document.getElementById('speed').value = 4, document.getElementById('speed').dispatchEvent(new Event('change'))")
        slide(page, "scrub", duration - 0.4)
        page.evaluate("document.getElementById('play').click()")
        page.wait("!wholehand.playback.isPlaying", what="the end")
        self.assertAlmostEqual(page.evaluate("wholehand.playback.t"), duration, delta=1e-6)
        clock = page.evaluate("document.getElementById('clock').textContent")
        self.assertEqual(len(set(re.findall(r"\d+:\d\d\.\d", clock))), 1, clock)


if __name__ == "__main__":
    main()
