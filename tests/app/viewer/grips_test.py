# SPDX-License-Identifier: MIT
"""Grips in the viewer: one of `grip --view`, the best of a sweep; what is drawn against `grip --json`."""

import json
import math
import os

from harness import minus, run
from support import ViewerTest, color_at, drawn, main, projected, slide, still, turned_back

GRIP = ["three_beakers", "--vessel", "beaker1", "--height-mm", "58.5", "--roll-deg", "22"]
DIGITS = 2e-7     # m: frames have the digits of a float, of places up to a meter
ON_SCREEN = 0.5   # px: the page projects in float where the test does in double
THUMB_TIP, INDEX_TIP = 3, 8
STRENGTH = 25 * 158 / 236  # N, of the index finger at an opening of 80 mm: the weaker one of the two tips
BRACKETS = 2e-3   # relative: an effort is found to 1e-3, and a tilt that is rounded otherwise may end elsewhere in that


class AGrip(ViewerTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.grip = cls.serve("grip", *GRIP, "--view")

    def check_joints_on_screen(self, page, what):
        still(page)
        camera = page.evaluate("wholehand.camera()")
        found = page.evaluate("wholehand.frame.joints.map((_, k) => wholehand.project(k)).map(({x, y}) => [x, y])")
        joints = page.evaluate("wholehand.frame.joints")
        self.assertEqual(len(joints), 24)
        for k, joint in enumerate(joints):
            self.assert_near(found[k], projected(camera, joint), ON_SCREEN, f"{what}, joint {k}")

    def test_the_page_asks_for_nothing_from_elsewhere(self):
        page = self.open(self.grip)
        self.assertGreater(len(page.requests), 10)
        self.assertEqual([request for request in page.requests if not request.startswith(self.grip.address)], [])

    def test_joints_are_where_grip_json_says(self):
        reported = json.loads(run("grip", *GRIP, "--json"))
        page = self.open(self.grip)
        for tilt in [0, 40]:
            slide(page, "tilt", tilt)
            page.wait(f"Math.abs(wholehand.frame.tilt - {math.radians(tilt)}) < 1e-6")
            frame = page.evaluate("wholehand.frame")
            vessel = frame["vessels"][frame["vessel"]]
            for joints, expected in [("joints", "proxies_m"), ("rigged", "joints_m")]:
                for k, joint in enumerate(frame[joints]):
                    in_vessel = turned_back(vessel["rotation"], minus(joint, vessel["place"]))
                    self.assert_near(in_vessel, reported[expected][k], 2 * DIGITS, f"{joints} {k} at {tilt} degrees")
        touching = [letter in "tpK" for letter in frame["contacts"]]
        self.assertEqual(touching, reported["touching"])
        self.assertEqual([letter == "p" for letter in frame["contacts"]], [role is not None for role in reported["projected"]])

    def test_joints_on_screen_are_where_the_camera_sees_them(self):
        page = self.open(self.grip)
        self.check_joints_on_screen(page, "home")
        for view in ["front", "side", "top"]:
            page.evaluate(f"document.querySelector('[data-view={view}]').click()")
            self.check_joints_on_screen(page, view)
        page.evaluate("document.querySelector('[data-view=home]').click()")
        still(page)
        box = page.evaluate("wholehand.camera().rectangle")
        middle = (box["left"] + box["width"] * 0.8, box["top"] + box["height"] * 0.3)
        before = page.evaluate("wholehand.camera().position")
        page.drag(middle, (middle[0] - 120, middle[1] + 60))
        page.wait(f"Math.hypot(...wholehand.camera().position.map((v, k) => v - {before}[k])) > 0.02", what="a turned view")
        self.check_joints_on_screen(page, "turned")
        page.resize(700, 900)
        page.wait("wholehand.camera().rectangle.width <= 700")
        self.check_joints_on_screen(page, "resized")

    def test_a_fixed_view_looks_along_an_axis(self):
        page = self.open(self.grip)
        for view, axis in [("front", 2), ("side", 0), ("top", 1)]:
            page.evaluate(f"document.querySelector('[data-view={view}]').click()")
            still(page)
            camera = page.evaluate("wholehand.camera()")
            away = minus(camera["position"], camera["target"])
            self.assertAlmostEqual(away[axis] / math.hypot(*away), 1, places=5, msg=view)  # the top view leans by a thousandth

    def test_a_mark_in_its_color_is_drawn_where_a_tracked_tip_is(self):
        page = self.open(self.grip)
        still(page)
        drawn(page)
        wanted = page.evaluate("getComputedStyle(document.documentElement).getPropertyValue('--contact-4').trim()")
        wanted = [int(wanted[k:k + 2], 16) for k in (1, 3, 5)]
        self.assertEqual(page.evaluate("wholehand.frame.contacts[8]"), "K")
        at = page.evaluate(f"wholehand.project({INDEX_TIP})")
        self.assert_near(color_at(page, at["x"], at["y"]), wanted, 12, f"index tip at {at}")

    def test_no_mark_is_drawn_where_points_and_forces_are_switched_off(self):
        page = self.open(self.grip)
        page.evaluate("document.getElementById('points').click(), document.getElementById('arrows').click()")
        still(page)
        drawn(page)
        at = page.evaluate(f"wholehand.project({INDEX_TIP})")
        red, green, blue = color_at(page, at["x"], at["y"])
        self.assertTrue(red > green > blue, "skin")

    def test_a_hand_that_reaches_under_the_base_is_seen_through_the_table(self):
        page = self.open(self.grip)
        scene, frame = page.evaluate("[wholehand.scene, wholehand.frame]")
        vessel = scene["vessels"][frame["vessel"]]
        self.assertEqual(frame["vessels"][frame["vessel"]]["place"], vessel["place"], "it stands")
        self.assertEqual(page.evaluate("wholehand.view.stage.table.position.y"), vessel["place"][1] + vessel["base"])
        page.evaluate("document.getElementById('points').click(), document.getElementById('arrows').click()")

        def color(joints, with_hand, with_table):
            """At the index finger's tip, of the hand alone on or under the table."""
            page.evaluate(f"""(({{view, frame}}) => {{ view.show({{...frame, joints: {joints}}});
              for (const {{group, shade}} of view.vessels.list) group.visible = shade.visible = false;
              view.hand.skin.mesh.visible = {with_hand};
              view.stage.table.visible = {with_table};
              if (!{with_table}) view.hand.skin.uniforms.table.value = -9; }})(wholehand)""".replace("True", "true").replace("False", "false"))
            drawn(page)
            at = page.evaluate(f"wholehand.view.project({joints[INDEX_TIP]})")
            return color_at(page, at["x"], at["y"])

        lower = frame["joints"][INDEX_TIP][1] - vessel["place"][1] + 0.08
        for elevation, down in [(0.5, lower), (-0.3, 0)]:
            joints = [[x, y - down, z] for x, y, z in frame["joints"]]
            x, y, z = joints[INDEX_TIP]
            page.evaluate(f"wholehand.view.orbit.go({{elevation: {elevation}, x: {x}, y: {y}, z: {z}}}), wholehand.view.orbit.jump(), wholehand.view.stage.invalidate()")
            hand, table, through, neither = (color(joints, *which) for which in [(True, False), (False, True), (True, True), (False, False)])
            # a quarter of the hand over the table, or half of the table over all
            expected = [t + 0.25 * (h - t) for t, h in zip(table, hand)] if down else [t + 0.5 * (h - n) for t, h, n in zip(table, hand, neither)]
            self.assert_near(through, expected, 4, f"hand {hand}, table {table}, at {elevation}")
            for what, other in [("the hand is seen", table), ("the table is before it", hand)]:
                self.assertGreater(max(abs(a - b) for a, b in zip(through, other)), 8, f"{what}, at {elevation}")

    def test_sliders_show_liquid_and_force_at_once(self):
        page = self.open(self.grip)
        for fill, tilt in [(0.5, 60), (0.75, 30)]:
            reported = json.loads(run("grip", *GRIP, "--json", "--fill", str(fill), "--tilt-deg", str(tilt)))["states"][0]
            slide(page, "fill", fill)
            slide(page, "tilt", tilt)
            page.wait(f"Math.abs(wholehand.frame.tilt - {math.radians(tilt)}) < 1e-6 && "
                      f"Math.abs(wholehand.frame.vessels[0].volume - {reported['liquid_volume_m3']}) < 1e-9", what=f"{fill}, {tilt}")
            forces = page.evaluate("wholehand.frame.forces")
            for name, key in [("feedback", "feedback_force_N"), ("normal", "normal_force_N")]:
                self.assertAlmostEqual(forces[name], reported[key], delta=1e-6 * max(1, reported[key]), msg=name)
            hold = STRENGTH * reported["effort"]
            self.assertAlmostEqual(forces["hold"], hold, delta=BRACKETS * hold, msg="hold")
            page.wait(f"document.querySelector('.force-value').textContent === '{reported['feedback_force_N']:.2f}'", what="the number")

    def test_the_curve_over_the_tilt_is_that_of_grip_json(self):
        page = self.open(self.grip)
        fill = page.evaluate("Number(document.getElementById('fill').value)")
        page.wait("wholehand.charts.records.length > 0", what="the curve")
        records = page.evaluate("wholehand.charts.records.map(({x, feedback, hold}) => [x, feedback, hold])")
        tilts = [f"{record[0]:.9g}" for record in records]
        reported = json.loads(run("grip", *GRIP, "--json", "--fill", str(fill), "--tilt-deg", *tilts))["states"]
        for record, state in zip(records, reported):
            hold = STRENGTH * state["effort"]
            self.assertAlmostEqual(record[1], state["feedback_force_N"], delta=1e-4, msg=f"{record[0]} degrees")
            self.assertAlmostEqual(record[2], hold, delta=BRACKETS * hold, msg=f"{record[0]} degrees")

    def test_arrows_are_the_contact_forces_of_grip_json(self):
        page = self.open(self.grip)
        reported = json.loads(run("grip", *GRIP, "--json", "--fill", "0.5", "--tilt-deg", "0"))["states"][0]
        slide(page, "fill", 0.5)
        page.wait(f"Math.abs(wholehand.frame.vessels[0].volume - {reported['liquid_volume_m3']}) < 1e-9", what="the fill")
        still(page)
        drawn(page)
        frame = page.evaluate("wholehand.frame")
        holding, vessel = frame["holding"], frame["vessels"][0]
        pressing = [contact for contact in reported["contacts"] if any(contact["force_N"])]
        largest = max(math.hypot(*contact["force_N"]) for contact in pressing)
        self.assertEqual(len(holding["contacts"]), len(pressing))
        for seen, contact in zip(holding["contacts"], pressing):
            place = turned_back(vessel["rotation"], minus(seen["place"], vessel["place"]))
            self.assert_near(place, contact["point_m"], 2 * DIGITS, "place")
            self.assert_near(turned_back(vessel["rotation"], seen["force"]), contact["force_N"], 1e-5 * largest, "force")
        arrows = page.evaluate("""wholehand.view.arrows.list.filter(({arrow}) => arrow.visible).map(({arrow, parts: [, head]}) => {
          const end = head.position.clone().setY(head.position.y + head.scale.y);
          return {length: end.y, place: arrow.localToWorld(end).toArray()}; })""")
        self.assertEqual(len(arrows), len(pressing))
        for arrow, seen, contact in zip(arrows, holding["contacts"], pressing):
            self.assert_near(arrow["place"], seen["place"], 2 * DIGITS, "the head is at the contact")
            self.assertAlmostEqual(arrow["length"] / 0.045, math.hypot(*contact["force_N"]) / largest, delta=1e-4)
        shown = page.evaluate("(({effort, tipsEffort, arrow}) => [effort, tipsEffort, arrow].map((place) => place.textContent))"
                              "(wholehand.panels.forceRows)")
        percent = [f"{100 * effort:.{1 if effort < 0.1 else 0}f} %" for effort in (holding["effort"], holding["tips_effort"])]
        self.assertEqual(shown, percent + [f"{largest:.2f}"])


class TheBestOfASweep(ViewerTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        run("sweep", "small", "-o", "small.nc", "--on", "core", folder=cls.folder)
        cls.best = cls.serve("view", "small.nc")

    def test_the_list_has_each_grip_with_its_score(self):
        page = self.open(self.best)
        scene = self.best.get("scene.json")
        rows = page.evaluate("[...document.querySelectorAll('[role=option]')].map((row) => row.textContent)")
        self.assertEqual(len(rows), len(scene["grips"]))
        for row, grip in zip(rows, scene["grips"]):
            self.assertIn(grip["label"], row)
            self.assertIn(f"{grip['score']:.3f}", row)
            self.assertIn(f"obliquity {math.degrees(grip['obliquity_rad']):.0f}°".replace("-", "−").replace("−0°", "0°"), row)
        # azimuth and offset where a grip of the list has one
        said = page.evaluate("""(({grips}) => { const {about} = grips, of = (more) => {
          grips.about = {...about, grips: about.grips.map((grip, k) => ({...grip, azimuth_rad: 0, offset_m: 0, ...(k === 1 ? more : {})}))};
          return grips.placeOf(grips.about.grips[0]) + '; ' + grips.placeOf(grips.about.grips[1]); };
          const found = [of({}), of({azimuth_rad: Math.PI / 6}), of({offset_m: -2.5e-3})];
          grips.about = about;
          return found; })(wholehand)""")
        self.assertFalse("azimuth" in said[0] or "offset" in said[0], said[0])
        self.assertRegex(said[1], "azimuth 0°; .*azimuth 30°$")
        self.assertRegex(said[2], "offset 0.0 mm; .*offset −2.5 mm$")

    def test_the_refined_grip_is_reported_beside_the_swept_one(self):
        page = self.open(self.best)
        scene = self.best.get("scene.json")
        moved = next(k for k, grip in enumerate(scene["grips"]) if grip["refined"]["score"] > grip["score"] + 1e-4)
        page.evaluate(f"wholehand.grips.choose({moved})")
        refined = scene["grips"][moved]["refined"]
        said = page.evaluate("document.querySelector('.facts').textContent")
        self.assertIn(f"Refined score{refined['score']:.3f}", said)
        self.assertIn(f"Refined grip{1e3 * refined['height_m']:.1f} mm, roll ", said)
        self.assertIn(f"{1e3 * scene['grips'][moved]['height_m']:.1f} mm", page.evaluate(f"document.getElementById('grip-{moved}').textContent"))

    def test_a_click_or_a_key_shows_another_grip(self):
        page = self.open(self.best)
        first = page.evaluate("wholehand.frame.joints")
        page.evaluate("document.getElementById('grip-2').click()")
        page.wait(f"wholehand.grips.chosen === 2 && JSON.stringify(wholehand.frame.joints) !== '{json.dumps(first, separators=(',', ':'))}'")
        self.assertEqual(page.evaluate("document.getElementById('grip-2').getAttribute('aria-selected')"), "true")
        terms = page.evaluate("document.querySelector('.terms').textContent")
        for name, value in self.best.get("scene.json")["grips"][2]["terms"].items():
            self.assertIn(f"{name}{value + 1e-9:.2f}", terms)  # the page rounds halves up
        page.evaluate("document.querySelector('[role=listbox]').focus()")
        page.key("ArrowDown")
        page.wait("wholehand.grips.chosen === 3")
        page.key("Home")
        page.wait("wholehand.grips.chosen === 0")

    def test_a_left_hand_is_drawn_with_its_scale(self):
        page = self.open(self.best)
        scene = self.best.get("scene.json")
        self.assertEqual(scene["handedness"], "left")
        ball = page.evaluate("wholehand.view.hand.skin.uniforms.ball.value.slice(0, 24).map(({x, y, z, w}) => [x, y, z, w])")
        joints = page.evaluate("wholehand.frame.joints")
        scale = scene["grips"][0]["hand_scale"]
        for k, joint in enumerate(joints):
            self.assert_near(ball[k], joint + [scene["joints"][k]["radius"] * scale], DIGITS, f"joint {k}")


class TheBestOfSeveralHands(ViewerTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        shipped = os.path.join(os.path.dirname(__file__), "../../../examples/scenes/small.toml")
        with open(shipped) as scene, open(os.path.join(cls.folder, "hands.toml"), "w") as file:
            text = scene.read().replace('name = "tumbler"', f'name = "{"glass_" * 10}"')
            file.write(text.replace("offset_mm = 3 ", "hand_scale = [0.9, 1, 1.125]\noffset_mm = 3 "))
        run("sweep", "hands.toml", "-o", "hands.nc", "--on", "core", folder=cls.folder)
        cls.best = cls.serve("view", "hands.nc")

    def test_each_entry_shows_its_hand_scale_and_rank(self):
        page = self.open(self.best, width=1280)
        entries = page.evaluate("""[...document.querySelectorAll('.grip')].map((row) => {
          const name = row.querySelector('b'), range = document.createRange();
          range.selectNodeContents(name);
          return [name.textContent, range.getBoundingClientRect(), name.getBoundingClientRect(), row.getBoundingClientRect()]
            .map((it) => it.right ? {left: it.left, right: it.right, top: it.top, bottom: it.bottom} : it); })""")
        names = [entry[0] for entry in entries]
        for scale in ("0.9", "1", "1.125"):
            self.assertIn(f"{'glass_' * 10}, hand scale {scale}, rank 1", names)
        for name, text, element, row in entries:
            for inner, outer in ((text, element), (element, row)):
                for side, sign in (("left", 1), ("top", 1), ("right", -1), ("bottom", -1)):
                    self.assertGreaterEqual(sign * (inner[side] - outer[side]), -1, f"{name}: {side}")


if __name__ == "__main__":
    main()
