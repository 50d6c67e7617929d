# SPDX-License-Identifier: MIT
"""The page as the gripper: by sliders, keys, pointer and touch."""

from support import ViewerTest, main, patient_board, slide, still

FAR = 0.02  # m: what follows smoothly has arrived, all but this
POURED = 1e-6  # m3


class ThePageAsGripper(ViewerTest):
    scale = 0.5

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.live = cls.serve("live", patient_board(cls.folder), "--view", "--device", "view")

    def hand(self, page):
        """Middle between the tips of thumb and index finger, as drawn."""
        tips = page.evaluate("[3, 8].map((k) => wholehand.frame.rigged[k])")
        return [(a + b) / 2 for a, b in zip(*tips)]

    def wait_for_hand(self, page, place):
        page.wait(f"((a, b) => Math.hypot(...[0, 1, 2].map((k) => (a[k] + b[k]) / 2 - {place}[k])) < {FAR})(wholehand.frame.rigged[3], wholehand.frame.rigged[8])",
                  what=f"the hand at {place}")

    def go(self, page, across, height, depth):
        for name, value in [("across", across), ("height", height), ("depth", depth)]:
            slide(page, f"control-{name}", value)
        self.wait_for_hand(page, [across / 1e3, height / 1e3, depth / 1e3])

    def test_a_beaker_is_grasped_lifted_tilted_and_let_go(self):
        page = self.open(self.live, 900, 700)
        self.go(page, -120, 60, 150)  # in front of it, then towards it
        self.go(page, -120, 60, 0)
        page.evaluate("document.activeElement.blur()")
        page.key(" ")
        page.wait("wholehand.frame.state === 'lift'", what="a grasp")
        self.assertEqual(page.evaluate("wholehand.scene.vessels[wholehand.frame.vessel].name"), "beaker1")
        page.wait("wholehand.control.motion === 0", what="the end of closing")
        page.wait("wholehand.frame.forces.opening > 0.5", what="a squeeze")
        self.assertLess(page.evaluate("wholehand.frame.forces.feedback"), 8)
        slide(page, "control-height", 160)
        page.wait("wholehand.frame.vessels[1].place[1] > 0.08", what="the lift")
        slide(page, "control-tilt", 75)
        page.wait("wholehand.frame.tilt > 1.2", what="the tilt")
        page.wait(f"wholehand.frame.spilled > {POURED}", what="something spilled: there is nothing below")
        slide(page, "control-tilt", 0)
        page.wait("wholehand.frame.tilt < 0.1", what="upright again")
        page.evaluate("document.querySelector('.grasp').click()")
        page.wait("!['lift', 'tilt', 'maintain'].includes(wholehand.frame.state)", what="letting go")
        page.evaluate("document.querySelector('.grasp').blur()")

    def test_keys_move_close_and_tilt(self):
        page = self.open(self.live)
        page.wait("wholehand.control")
        before = page.evaluate("({...wholehand.control.state(), tilt: wholehand.control.tilt})")
        for key in "eeddx":
            page.key(key)
        page.key("t")
        after = page.evaluate("({...wholehand.control.state(), tilt: wholehand.control.tilt})")
        self.assertGreater(after["position"][1], before["position"][1])
        self.assertGreater(after["position"][0], before["position"][0])
        self.assertLess(after["gap"], before["gap"])
        self.assertGreater(after["tilt"], before["tilt"])
        self.assertGreater(after["sequence"], before["sequence"])
        self.wait_for_hand(page, after["position"])

    def test_held_keys_glide_until_they_are_let_go(self):
        page = self.open(self.live)
        page.wait("wholehand.control && wholehand.control.isAtHand")
        page.evaluate("""(() => { window.steps = []; window.looks = true;
          const look = (now) => { const {position, tilt} = wholehand.control; steps.push([now / 1000, position.x, tilt]); if (looks) requestAnimationFrame(look); };
          requestAnimationFrame(look); })()""")
        page.wait("steps.length > 4")
        for key in "dt":
            page.press(key)
        page.wait("[1, 2].every((k) => steps[steps.length - 4][k] > steps[0][k])", what="a hand under way")
        for _ in range(20):  # the keyboard's own repeats change nothing
            page.press("d", repeats=True)
        steps = page.evaluate("steps")
        page.let_go("d")
        page.let_go("t")
        for value, speed in [(1, 0.15), (2, 0.8)]:  # m/s and rad/s: in each picture as much as the one before it took
            moving = [k for k in range(2, len(steps)) if steps[k - 2][value] > steps[0][value]]
            self.assertGreater(len(moving), 1)
            for k in moving:
                took = min(0.1, steps[k - 1][0] - steps[k - 2][0])
                self.assertAlmostEqual(steps[k][value] - steps[k - 1][value], speed * took, delta=1e-9)
        at = "[wholehand.control.position.x, wholehand.control.tilt]"
        rest = page.evaluate(at)
        self.assertGreater(rest[0], steps[-1][1])
        page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))))")
        self.assertEqual(page.evaluate(at), rest, "let go")
        page.press("a")
        page.wait(f"wholehand.control.position.x < {rest[0]} - 0.01", what="the way back")
        rest = page.evaluate(f"dispatchEvent(new Event('blur')), {at}")
        page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))))")
        self.assertEqual(page.evaluate(at), rest, "another window has the focus")
        page.press("a", repeats=True)  # what comes of a key that is held still
        page.let_go("a")
        self.assertEqual(page.evaluate(at), rest)
        page.evaluate("looks = false")
        slide(page, "control-tilt", 0)

    def test_the_picture_follows_the_hand(self):
        page = self.open(self.live)
        self.assertEqual(page.evaluate("document.getElementById('follow').getAttribute('aria-pressed')"), "true")
        self.go(page, 100, 150, 200)
        page.wait("Math.hypot(...wholehand.camera().target.map((v, k) => v - wholehand.view.middle.toArray()[k])) < 5e-3", what="the hand in the middle")

    def test_a_drag_moves_the_hand_with_the_pointer(self):
        page = self.open(self.live)
        self.go(page, 0, 150, 200)
        start = page.evaluate("(({x, y}) => [x, y])(wholehand.view.project(wholehand.view.middle.toArray()))")
        page.mouse("mousePressed", *start)
        still(page)  # it follows the hand no more
        tips = page.evaluate("wholehand.control.position.toArray()")
        seen = page.evaluate(f"(({{x, y}}) => [x, y])(wholehand.view.project({tips}))")
        camera = page.evaluate("wholehand.camera().position")
        page.mouse("mouseMoved", start[0] + 60, start[1] - 40)
        moved = page.evaluate("wholehand.control.position.toArray()")
        self.wait_for_hand(page, moved)
        after = page.evaluate(f"(({{x, y}}) => [x, y])(wholehand.view.project({moved}))")
        # the drag is at the distance of the hand's middle, the tips are some centimeters nearer or farther
        self.assert_near(after, [seen[0] + 60, seen[1] - 40], 15, "pixels")
        self.assertEqual(page.evaluate("wholehand.camera().position"), camera, "the view has not turned, nor followed")
        page.mouse("mouseReleased", start[0] + 60, start[1] - 40)

    def test_a_page_that_is_loaded_again_goes_on_where_it_was(self):
        page = self.open(self.live)
        self.go(page, -40, 140, 180)
        slide(page, "control-tilt", 25)
        before = page.evaluate("(({position, gap, tilt}) => ({position, gap, tilt}))(wholehand.control)")
        page.go(self.live.address)
        page.wait("window.wholehand && wholehand.frame", what="the first frame")
        self.assertEqual(page.evaluate("(({position, gap, tilt}) => ({position, gap, tilt}))(wholehand.control)"), before)
        self.wait_for_hand(page, [-0.04, 0.14, 0.18])

    def test_a_second_page_begins_where_the_hand_is(self):
        page = self.open(self.live)
        self.go(page, 60, 160, 170)
        other = self.open(self.live)
        self.assert_near(other.evaluate("wholehand.control.position.toArray()"), [0.06, 0.16, 0.17], FAR)

    def test_a_second_page_keeps_the_hand_as_it_is_turned(self):
        page = self.open(self.live)
        self.go(page, 60, 160, 170)
        for tilt, turn in [(110, -35), (0, 0)]:
            slide(page, "control-tilt", tilt)
            slide(page, "control-turn", turn)
            wanted = page.evaluate("""(() => { const {tilt, turn} = wholehand.control, a = turn / 2, b = -tilt / 2;
              return [Math.cos(a) * Math.sin(b), Math.sin(a) * Math.cos(b), -Math.sin(a) * Math.sin(b), Math.cos(a) * Math.cos(b)]; })()""")
            # either of the two quaternions of that turn, but for 3e-4 rad
            page.wait(f"Math.abs({wanted}.reduce((sum, v, k) => sum + v * wholehand.frame.rotation[k], 0)) > 1 - 1e-8", what=f"a hand tilted by {tilt}")
            other = self.open(self.live)
            found = other.evaluate("[wholehand.control.tilt, wholehand.control.turn].map((v) => v * 180 / Math.PI)")
            self.assert_near(found, [tilt, turn], 0.1, "degrees")

    def test_a_grasp_goes_on_closing_from_where_it_held(self):
        page = self.open(self.live)
        page.wait("wholehand.control")
        stiffness = page.evaluate("wholehand.scene.control_limits.opening_N_m")
        self.assertAlmostEqual(stiffness, 600, delta=1e-6)  # the method's, as this gripper's gap is the hand's
        for n_m, squeezed in [(600, 0.005), (6000, 0.0005), (0, 0)]:
            gap = page.evaluate(f"""(() => {{ const {{control, frame}} = wholehand;
              control.limits.opening_N_m = {n_m};
              control.motion = -1;
              control.show({{...frame, state: 'lift', gap: 0.06, forces: {{...frame.forces, opening: 3}}}});
              return control.gap; }})()""")
            self.assertAlmostEqual(gap, 0.06 + squeezed - 0.004, delta=1e-9)
        page.evaluate("wholehand.control.limits.opening_N_m = 600")
        slide(page, "control-close", 0)

    def test_an_error_is_over_when_a_control_is_taken(self):
        page = self.open(self.live)
        page.wait("wholehand.control")
        page.evaluate("wholehand.control.showError('one line')")
        self.assertFalse(page.evaluate("document.getElementById('error').hidden"))
        page.key("e")
        page.wait("document.getElementById('error').hidden")

    def test_touch_does_the_same(self):
        page = self.open(self.live, 420, 800)
        page.resize(420, 800, mobile=True)
        page.evaluate("document.getElementById('follow').click()")
        self.go(page, 0, 150, 200)
        still(page)
        page.evaluate("window.scrollTo(0, 0)")
        x, y = page.evaluate("(({x, y}) => [x, y])(wholehand.view.project(wholehand.view.middle.toArray()))")
        before = page.evaluate("wholehand.control.position.x")
        page.touch("touchStart", [(x, y)])
        for k in range(1, 6):
            page.touch("touchMove", [(x + 8 * k, y)])
        page.touch("touchEnd", [])
        self.assertGreater(page.evaluate("wholehand.control.position.x"), before + 0.01)

    def test_a_drag_beside_the_hand_turns_the_view(self):
        page = self.open(self.live)
        page.evaluate("document.getElementById('follow').click()")
        self.go(page, 0, 150, 200)
        still(page)
        position = page.evaluate("wholehand.control.position.toArray()")
        camera = page.evaluate("wholehand.camera().position")
        box = page.evaluate("wholehand.camera().rectangle")
        corner = (box["left"] + box["width"] - 20, box["top"] + 80)
        page.drag(corner, (corner[0] - 80, corner[1] + 10))
        page.wait(f"Math.hypot(...wholehand.camera().position.map((v, k) => v - {camera}[k])) > 0.05", what="a turned view")
        self.assertEqual(page.evaluate("wholehand.control.position.toArray()"), position)


if __name__ == "__main__":
    main()
