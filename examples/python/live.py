# SPDX-License-Identifier: MIT
"""A live session in a loop: a hand comes to a beaker, closes on it and lifts it. Those of a real gripper come from its driver."""

# %% The scene says where the vessels stand. The gripper has the gap of the hand itself.
import numpy as np
import wholehand as wh

scene = wh.scene("mixing_board")

with wh.session(scene) as session:
    closed, opened = session.gap
    beaker = np.array([-0.36, 0.05, 0.0])  # a place on the axis of the first vessel, 50 mm above its base

    # %% One second to come near, one to close, one to lift by 10 cm. Each step is a millisecond.
    seen = []
    gap = opened
    for tick in range(3000):
        seconds = tick * session.period
        place = beaker + [0, 0, 0.2 * max(0, 1 - seconds)] + [0, 0.1 * max(0, seconds - 2), 0]
        if 1 < seconds and not (seen and seen[-1] == "lift"):
            gap = max(closed, gap - 0.1 * session.period)  # 10 cm a second, until it is held
        out = session.step(place, None, gap)
        # these go to the gripper, after its own limits: out.arm_force (N), out.grip_force (N)
        if not seen or out.state != seen[-1]:
            print(
                f"{seconds:5.3f} s: {out.state} {out.vessel or ''}, gap {1e3 * out.gap:.1f} mm, grip force {out.grip_force:.2f} N"
            )
            seen.append(out.state)

    # %% The whole hand as it is seen, for your own display.
    hand = session.hand()
    print(f"{sum(hand.touching)} joints touch {out.vessel}; it stands {1e3 * out.vessel_place[1]:.0f} mm above the table")

assert "lift" in seen and out.is_held
