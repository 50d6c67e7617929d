# SPDX-License-Identifier: MIT
"""The page for everyone: every width, dark mode, reduced motion, the keyboard alone, a reader of the screen, a server that is gone."""

from harness import run
from support import ViewerTest, color_at, main, patient_board, slide, still

GRIP = ["three_beakers", "--vessel", "beaker2", "--height-mm", "95", "--roll-deg", "30"]
RECORDING = "a_recording_whose_name_is_longer_than_a_narrow_window_is_wide.nc"
WIDTHS = [400, 560, 800, 861, 1024, 1280, 1366, 2000]
# Whatever a person may use
USABLE = "[...document.querySelectorAll('button, input, select, [tabindex=\"0\"], a[href]')].filter((e) => e.offsetParent !== null || e.id === 'view')"
# Texts that reach out of their part of the page, or are cut by what holds them; and those of the charts, which are in their canvas
CUT = """[...document.querySelectorAll('#panels section, #legend, header')].filter((part) => part.offsetParent).flatMap((part) => {
  const found = [], texts = document.createTreeWalker(part, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const range = document.createRange();
    range.selectNodeContents(texts.currentNode);
    for (const at of range.getClientRects()) {
      if (at.width < 1) continue;
      for (let holds = texts.currentNode.parentElement; holds !== part.parentElement; holds = holds.parentElement) {
        if (holds !== part && getComputedStyle(holds).overflowX === 'visible') continue;
        const box = holds.getBoundingClientRect();
        if (at.left < box.left - 0.5 || at.right > box.right + 0.5) found.push(texts.currentNode.data);
      }
    }
  }
  return found;
})"""
CUT_IN_CHARTS = """(({canvas, texts}) => canvas.clientWidth === 0 ? [] :
  texts.filter(({left, right, top, bottom}) => left < 0 || right > canvas.clientWidth || top < 0 || bottom > canvas.clientHeight))(wholehand.charts)"""
# Vessels that are in the picture, as boxes about them, [left, top, right, bottom], px
BOXES = """(({view, scene, frame}) => { const {left, top, width, height} = wholehand.camera().rectangle;
  return scene.vessels.flatMap(({height: tall, radius}, k) => {
    const {place, rotation} = frame.vessels[k] || {};
    if (!place) return [];
    const [ax, ay, az, w] = rotation, points = [];
    for (const y of [0, tall]) for (let n = 0; n < 8; ++n) {
      const v = [radius * Math.cos(n * Math.PI / 4), y, radius * Math.sin(n * Math.PI / 4)], q = [ax, ay, az];
      const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
      const t = cross(q, v).map((c) => 2 * c), u = cross(q, t);
      points.push(view.project(v.map((c, i) => place[i] + c + w * t[i] + u[i])));
    }
    const box = [Math.max(left, Math.min(...points.map((p) => p.x))), Math.max(top, Math.min(...points.map((p) => p.y))),
      Math.min(left + width, Math.max(...points.map((p) => p.x))), Math.min(top + height, Math.max(...points.map((p) => p.y)))];
    return box[0] < box[2] && box[1] < box[3] ? [box] : [];
  }); })(wholehand)"""


def luminance(color):
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]


class ThePage(ViewerTest):
    scale = 0.5

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        run("live", "mixing_board", "--no-clock", "--record", RECORDING, "--seconds", "4", folder=cls.folder)
        cls.pages = {"grips": cls.serve("grip", *GRIP, "--view"), "recording": cls.serve("view", RECORDING),
                     "control": cls.serve("live", patient_board(cls.folder), "--view", "--device", "view")}

    def test_no_width_scrolls_sideways(self):
        for name, served in self.pages.items():
            page = self.open(served)
            for width in WIDTHS:
                page.resize(width, 800, self.scale)
                page.wait(f"innerWidth === {width}")
                wide = page.evaluate("Math.max(document.documentElement.scrollWidth, document.body.scrollWidth, document.getElementById('panels').scrollWidth)")
                self.assertLessEqual(wide, width, f"{name} at {width}")
                over = page.evaluate(f"{USABLE}.filter((e) => !e.classList.contains('skip')).map((e) => e.getBoundingClientRect())"
                                     f".filter((box) => box.left < -1 || box.right > {width} + 1).length")
                self.assertEqual(over, 0, f"{name} at {width}")
                seen = page.evaluate("(({width, height}) => [width, height])(wholehand.camera().rectangle)")
                self.assertTrue(seen[0] >= min(width, 400) and seen[1] >= 200, f"{name} at {width}: {seen}")
                page.wait("Math.abs(wholehand.charts.canvas.width - wholehand.charts.canvas.clientWidth * devicePixelRatio) < 1", what="the charts' new size")
                if width >= 1280:  # narrower, the header's names and the list's may be shortened
                    self.assertEqual(page.evaluate(CUT), [], f"{name} at {width}")
                self.assertEqual(page.evaluate(CUT_IN_CHARTS), [], f"{name} at {width}")
                legend = page.evaluate("(({left, top, right, bottom}) => [left, top, right, bottom])(document.getElementById('legend').getBoundingClientRect())")
                boxes = page.evaluate(BOXES)
                self.assertTrue(boxes, f"{name} at {width}: no vessel is seen")
                for box in boxes:
                    apart = box[2] <= legend[0] or box[0] >= legend[2] or box[3] <= legend[1] or box[1] >= legend[3]
                    self.assertTrue(apart, f"{name} at {width}: {box} under the legend {legend}")

    def test_dark_mode_is_dark_and_light_is_light(self):
        for dark in [False, True]:
            page = self.open(self.pages["grips"], dark=dark)
            still(page)
            for what, x, y in [("backdrop", 500, 130), ("header", 500, 20), ("panels", 1192, 500)]:
                light = luminance(color_at(page, x, y))
                self.assertTrue(light < 60 if dark else light > 200, f"{what} {light}")

    def test_a_change_of_the_scheme_is_followed(self):
        page = self.open(self.pages["grips"])
        tint = "wholehand.view.vessels.list[0].materials[0].uniforms.tint.value.getHex()"
        before = page.evaluate(tint)
        page.emulate(dark=True)
        page.wait(f"{tint} !== {before}")

    def test_reduced_motion_does_not_glide(self):
        page = self.open(self.pages["grips"], still=True)
        still(page)
        pictures = page.evaluate("wholehand.view.stage.pictures")
        page.evaluate("document.querySelector('[data-view=top]').click()")
        page.wait(f"wholehand.view.stage.pictures > {pictures}")
        self.assertGreater(page.evaluate("wholehand.view.orbit.now.elevation"), 1.5)
        self.assertLessEqual(page.evaluate("wholehand.view.stage.pictures"), pictures + 2)

    def test_reduced_motion_follows_a_jump(self):
        page = self.open(self.pages["recording"], still=True)
        page.evaluate("document.getElementById('follow').click()")
        for seconds in [3.5, 0.5]:
            slide(page, "scrub", seconds)
            page.wait(f"Math.abs(wholehand.frame.t - {seconds}) < 0.05", what="the frame")
            page.wait("(({view}) => ['x', 'y', 'z'].every((axis) => Math.abs(view.orbit.now[axis] - view.middle[axis]) < 1e-3))(wholehand)", what="the hand in the middle")
            still(page)

    def test_nothing_is_drawn_while_nothing_changes(self):
        page = self.open(self.pages["grips"])
        still(page)
        page.wait("new Promise((done) => { const before = wholehand.view.stage.pictures;"
                  " setTimeout(() => done(wholehand.view.stage.pictures === before), 700); })", what="rest")

    def test_the_keyboard_reaches_everything(self):
        for name, served in self.pages.items():
            page = self.open(served)
            wanted = page.evaluate(f"{USABLE}.length")
            page.evaluate("window.reached = new Set(), document.body.focus()")
            for _ in range(wanted + 3):
                page.key("Tab")
                page.evaluate("reached.add(document.activeElement)")
            missed = page.evaluate(f"{USABLE}.filter((e) => !reached.has(e)).map((e) => e.id || e.textContent)")
            self.assertEqual(missed, [], name)

    def test_everything_that_can_be_used_has_a_name(self):
        for name, served in self.pages.items():
            page = self.open(served)
            page.call("Accessibility.enable")
            nodes = page.call("Accessibility.getFullAXTree")["nodes"]
            roles = {"button", "slider", "combobox", "listbox", "option", "img", "image", "dialog", "link", "toolbar", "group"}
            nameless = [node["role"]["value"] for node in nodes if not node.get("ignored") and node.get("role", {}).get("value") in roles
                        and not node.get("name", {}).get("value")]
            self.assertEqual(nameless, [], name)

    def test_keys_turn_and_the_help_lists_them(self):
        page = self.open(self.pages["grips"])
        still(page)
        page.evaluate("document.getElementById('view').focus()")
        before = page.evaluate("wholehand.view.orbit.aim.azimuth")
        page.key("ArrowRight")
        self.assertGreater(page.evaluate("wholehand.view.orbit.aim.azimuth"), before)
        near = page.evaluate("wholehand.view.orbit.aim.distance")
        page.key("+")
        self.assertLess(page.evaluate("wholehand.view.orbit.aim.distance"), near)
        page.key("1")
        self.assertEqual(page.evaluate("wholehand.view.orbit.aim.elevation"), 0)
        page.key("g")
        self.assertTrue(page.evaluate("wholehand.view.hand.ghost.mesh.visible"))
        self.assertTrue(page.evaluate("wholehand.view.arrows.group.visible"))
        page.key("h")
        self.assertFalse(page.evaluate("wholehand.view.arrows.group.visible"))
        page.key("?")
        self.assertTrue(page.evaluate("document.getElementById('help').open"))
        self.assertGreater(page.evaluate("document.querySelectorAll('#help-keys kbd').length"), 15)
        page.key("Escape")
        page.wait("!document.getElementById('help').open")

    def test_arrows_turn_with_the_focus_on_a_button_of_the_picture(self):
        page = self.open(self.pages["grips"])
        still(page)
        page.evaluate("document.querySelector('[data-view=front]').focus()")
        before = page.evaluate("wholehand.view.orbit.aim.azimuth")
        page.key("ArrowRight")
        self.assertGreater(page.evaluate("wholehand.view.orbit.aim.azimuth"), before)

    def test_there_is_nothing_to_go_back_to_before_the_first_frame(self):
        page = self.open(self.pages["grips"])
        still(page)
        page.evaluate("wholehand.view.orbit.home = null")
        for _ in range(2):
            page.evaluate("document.getElementById('follow').click(), document.querySelector('[data-view=home]').click()")

    def test_the_clock_rounds_up_to_the_minute(self):
        page = self.open(self.pages["recording"])
        said = page.evaluate("import('./format.js').then(({clock}) => [0, 9.94, 59.94, 59.96, 60, 3599.97].map(clock))")
        self.assertEqual(said, ["0:00.0", "0:09.9", "0:59.9", "1:00.0", "1:00.0", "60:00.0"])

    def test_the_timeline_has_all_of_the_recording(self):
        page = self.open(self.pages["recording"])
        page.wait("wholehand.playback.frames && wholehand.playback.frames.length > 500")
        # whatever the rate, and whichever way the duration is rounded on its way: one frame less than the most
        asked = page.evaluate("""import('./stream.js').then(({Recording}) => [[1.5015015, 333], [2.0006667, 1500], [100.0000006, 8000]].map(([duration, rate]) => {
          const recording = new Recording(duration, rate, () => {});
          recording.fetch = (from, to, at) => Number(to.toFixed(6)) * at + 1;
          return recording.overview();
        }))""")
        self.assertEqual([frames <= 600 for frames in asked], [True] * 3, asked)

    def test_the_ghost_has_the_wrist_of_the_rigged_hand(self):
        page = self.open(self.pages["recording"])
        page.evaluate("wholehand.playback.seek(3)")
        page.wait("wholehand.frame.state === 'lift'")
        page.evaluate("document.getElementById('ghost').click()")
        for name, wrist in [("ghost", "rigged_wrist"), ("skin", "wrist")]:
            middle = page.evaluate(f"import('./hand_shape.js').then(({{WRIST_THUMB, WRIST_LITTLE}}) => (([a, b]) => ['x', 'y', 'z'].map((k) => (a[k] + b[k]) / 2))"
                                   f"([WRIST_THUMB, WRIST_LITTLE].map((k) => wholehand.view.hand.{name}.uniforms.ball.value[k])))")
            self.assert_near(middle, page.evaluate(f"wholehand.frame.{wrist}"), 1e-9, name)  # m: in double, but for the middle's rounding
        apart = page.evaluate("Math.hypot(...wholehand.frame.wrist.map((v, k) => v - wholehand.frame.rigged_wrist[k]))")
        self.assertGreater(apart, 1e-5, "the hand is squeezed")

    def test_an_error_is_over_when_a_frame_is_shown_again(self):
        page = self.open(self.pages["recording"])
        page.evaluate("wholehand.playback.showError('one line')")
        self.assertFalse(page.evaluate("document.getElementById('error').hidden"))
        page.evaluate("wholehand.playback.seek(1)")
        page.wait("document.getElementById('error').hidden")

    def test_without_a_picture_the_reason_stays(self):
        page = self.browser.open("about:blank")
        self.addCleanup(page.close)
        page.call("Page.addScriptToEvaluateOnNewDocument", source="""const {getContext} = HTMLCanvasElement.prototype;
          HTMLCanvasElement.prototype.getContext = function(kind, ...rest) { return kind.includes('webgl') ? null : getContext.call(this, kind, ...rest); };""")
        page.go(self.pages["recording"].address)
        page.wait("window.wholehand && wholehand.frame", what="the numbers")
        said = page.evaluate("document.getElementById('error').textContent")
        self.assertIn("WebGL", said)
        page.evaluate("wholehand.playback.showError('one line')")
        page.evaluate("wholehand.playback.seek(1)")
        page.wait(f"wholehand.frame.t > 0.9 && document.getElementById('error').textContent === {said!r}")

    def test_playing_stops_where_the_server_is_gone(self):
        served = self.serve("view", RECORDING)
        page = self.browser.open(served.address)
        self.addCleanup(page.close)
        page.wait("window.wholehand && wholehand.frame && wholehand.playback.frames")
        served.stop()
        page.evaluate("wholehand.playback.recording.ready.clear(), wholehand.playback.recording.stretches.clear()")
        page.evaluate("document.getElementById('play').click()")
        page.wait("!wholehand.playback.isPlaying", what="a pause")
        self.assertIn("does not answer", page.evaluate("document.getElementById('error').textContent"))
        self.assertEqual(page.evaluate("document.getElementById('play').getAttribute('aria-label')"), "Play")

    def test_a_change_of_state_is_said(self):
        page = self.open(self.pages["recording"])
        page.wait("document.getElementById('said').textContent === 'free'")
        page.evaluate("wholehand.playback.seek(3)")
        page.wait("document.getElementById('said').textContent === 'lift, tutorial'")

    def test_a_server_that_is_gone_is_reported(self):
        served = self.serve("grip", *GRIP, "--view")
        page = self.browser.open(served.address)
        self.addCleanup(page.close)
        page.wait("window.wholehand && wholehand.frame")
        self.assertEqual(served.stop(), 0)
        page.evaluate("document.getElementById('tilt').value = 20, document.getElementById('tilt').dispatchEvent(new Event('input'))")
        page.wait("!document.getElementById('error').hidden")
        self.assertIn("does not answer", page.evaluate("document.getElementById('error').textContent"))


if __name__ == "__main__":
    main()
