# SPDX-License-Identifier: MIT
"""The ghost of the advised hand, and its words, while a hand comes near a vessel."""

from support import PATIENCE, Served, ViewerTest, main, patient_board

# The first frame with a better grip in picture and words, and what the page shows with it. A page that comes late may first see a
# held vessel, whose words are about tilts
WATCH = """(() => {
  const look = () => {
    const {frame, view} = window.wholehand || {};
    if (frame && frame.advice && frame.advice.joints && frame.advice.words.includes('effort')) {
      window.seen = {words: frame.advice.words, shown: document.getElementById('advice').textContent,
        isShown: !document.getElementById('advice-panel').hidden, isDrawn: view.hand.advised.mesh.visible,
        tips: [3, 8].map((k) => frame.advice.joints[k]), ball: view.hand.advised.uniforms.ball.value[3].toArray(),
        vessel: frame.vessels[frame.advice.vessel], from: frame.advice.from, to: frame.advice.to};
      if (window.seen.words === window.seen.shown) return;
    }
    setTimeout(look, 10);
  };
  look();
})()"""


class Advice(ViewerTest):
    scale = 0.5

    def test_the_advised_hand_is_a_ghost_on_the_vessel(self):
        served = Served("live", patient_board(self.folder), "--view", "--advise", "--advise-on", "core")
        self.addCleanup(served.stop)
        page = self.open(served)
        page.evaluate(WATCH)
        page.wait("window.seen && window.seen.words === window.seen.shown", PATIENCE)
        seen = page.evaluate("window.seen")
        self.assertTrue(seen["isShown"] and seen["isDrawn"])
        self.assertTrue(0 < seen["to"] < 1)
        self.assertTrue(seen["from"] is None or seen["from"] > seen["to"])
        for place in seen["tips"]:  # on the glass of the vessel that the words are about
            x, _, z = (a - b for a, b in zip(place, seen["vessel"]["place"]))
            self.assertLess((x * x + z * z) ** 0.5, 0.07)
        for a, b in zip(seen["ball"], seen["tips"][0]):
            self.assertAlmostEqual(a, b, 5)

    def test_without_advice_there_is_none(self):
        served = Served("live", patient_board(self.folder), "--view", "--device", "view")  # which has no end
        self.addCleanup(served.stop)
        page = self.open(served)
        page.wait("window.wholehand && window.wholehand.frame && window.wholehand.frame.t > 1.5", PATIENCE)
        self.assertTrue(page.evaluate("document.getElementById('advice-panel').hidden"))
        self.assertFalse(page.evaluate("wholehand.view.hand.advised.mesh.visible"))


if __name__ == "__main__":
    main()
