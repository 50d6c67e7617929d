#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A hand that is no device: this script plays it, as a game engine or a tracker would, over Open Sound Control. It reaches for beaker1 of the
scene mixing_board, closes until it feels the glass, lifts the beaker, puts it down and lets go. It prints the forces that come back.

    ./wholehand live --device osc:9001 &
    python3 examples/engine/osc_hand.py --port 9001

It needs nothing but Python. docs/devices.md ("A hand over the network") describes the messages.
"""

import argparse
import socket
import struct
import sys
import time

STATES = ["free", "touching", "lift", "tilt", "maintain", "slipped", "released", "let go"]
HELD = (2, 3, 4)
RELEASED = 6
SILENCE = 0.05  # s without a force after which a hand must let go: the other side is gone
ARRIVAL = 10  # s that the other side may take to answer

GAP = (0.02, 0.127)  # m, closed and open
MOST_ARM, MOST_GRIP = 12, 8  # N that this hand can bear
BEAKER = (-0.12, 0.055, 0)  # m, the middle of beaker1
LIFT = 0.08  # m


def osc_text(text):
    data = text.encode() + b"\0"
    return data + bytes(-len(data) % 4)


def osc_message(address, *values):
    """Whole numbers as int32, others as float32."""
    tags = "," + "".join("i" if isinstance(value, int) else "f" for value in values)
    return osc_text(address) + osc_text(tags) + b"".join(struct.pack(">i" if isinstance(v, int) else ">f", v) for v in values)


def osc_bundle(*messages):
    """All at once."""
    return b"#bundle\0" + struct.pack(">Q", 1) + b"".join(struct.pack(">i", len(m)) + m for m in messages)


FORCE = osc_text("/wholehand/gripper/force") + osc_text(",iiffffi")


def is_later(a, b):
    """Whether message a is newer than b: numbers go on from 2^31 - 1 with -2^31."""
    return 0 < (a - b) % 2**32 < 2**31


class Forces:
    """What the hand feels. UDP may change the order of messages, so the newest is the one with the highest number; number 0 takes the force
    away, and once the session has let go, nothing brings it back."""

    def __init__(self):
        self.number = 0
        self.heard = None  # when a force came last, s
        self.state, self.arm, self.grip = 0, (0, 0, 0), 0
        self.is_released = False

    def let_go(self):
        self.arm, self.grip = (0, 0, 0), 0

    def take(self, data, now):
        if self.is_released or not data.startswith(FORCE) or len(data) != len(FORCE) + 28:
            return
        number, _heard, *arm, grip, state = struct.unpack(">iiffffi", data[len(FORCE):])
        if number == 0:  # whatever comes after it: the number stays that of the newest force
            self.heard, self.state = now, state
            self.is_released = state == RELEASED
            self.let_go()
        elif self.number == 0 or is_later(number, self.number):
            self.heard, self.number, self.state, self.arm, self.grip = now, number, state, arm, grip


class Hand:
    """Where it is, and what it feels."""

    def __init__(self, host, port, rate):
        self.to = (host, port)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setblocking(False)
        self.period = 1 / rate
        self.place, self.turn, self.gap, self.buttons = [0, 0, 0], (0, 0, 0, 1), GAP[1], 0
        self.sequence = 0
        self.forces = Forces()
        self.most_grip = 0
        self.next = self.began = self.printed = time.monotonic()

    def frame(self):
        """Once a frame of the engine: says where the hand is, and takes what has come meanwhile."""
        self.sequence += 1
        state = osc_message("/wholehand/gripper/state", self.sequence, *map(float, (*self.place, *self.turn, self.gap)), self.buttons)
        if self.forces.heard is None:  # what the hand is, until somebody answers
            hello = osc_message("/wholehand/gripper/hello", *map(float, (*GAP, MOST_ARM, MOST_GRIP)))
            state = osc_bundle(hello, state)
        self.socket.sendto(state, self.to)
        self.next += self.period
        time.sleep(max(0, self.next - time.monotonic()))
        self.listen()
        self.tell()

    def listen(self):
        """Forces come in every millisecond."""
        now = time.monotonic()
        while True:
            try:
                data = self.socket.recv(2048)
            except BlockingIOError:
                break
            except ConnectionRefusedError:  # nobody listens yet, or any more
                continue
            self.forces.take(data, now)
            self.most_grip = max(self.most_grip, self.forces.grip)
        heard = self.forces.heard
        if heard is None and now > self.began + ARRIVAL:
            raise SystemExit(f"osc_hand: nobody answers at {self.to[0]} port {self.to[1]}; start ./wholehand live --device osc:{self.to[1]}")
        if self.forces.is_released:
            raise SystemExit("osc_hand: the session has let go")
        if heard is not None and now > heard + SILENCE + self.period:
            self.forces.let_go()  # a device would drop its force here
            raise SystemExit("osc_hand: no force for 50 ms: the session is gone, and the hand lets go")

    def tell(self):
        now = time.monotonic()
        forces = self.forces
        if now < self.printed or forces.heard is None:
            return
        self.printed = now + 0.25
        x, y, z = self.place
        print(f"{now - self.began:5.2f} s  {STATES[forces.state] if forces.state >= 0 else '-':9}  at {x * 1e3:6.1f} {y * 1e3:6.1f} {z * 1e3:6.1f} mm"
              f"  gap {self.gap * 1e3:5.1f} mm  arm {forces.arm[0]:5.2f} {forces.arm[1]:5.2f} {forces.arm[2]:5.2f} N  grip {forces.grip:5.2f} N",
              flush=True)

    def move(self, seconds, place=None, gap=None, until=lambda: False):
        """To a place and a gap, without a jerk; ends before if `until` holds."""
        from_place, from_gap, start = list(self.place), self.gap, time.monotonic()
        while not until():
            s = min(1, (time.monotonic() - start) / seconds)
            way = s * s * (3 - 2 * s)
            if place is not None:
                self.place = [a + way * (b - a) for a, b in zip(from_place, place)]
            if gap is not None:
                self.gap = from_gap + way * (gap - from_gap)
            self.frame()
            if s == 1:
                return

    def is_holding(self):
        return self.forces.state in HELD

    def bye(self):
        self.socket.sendto(osc_message("/wholehand/gripper/bye"), self.to)


def play(hand):
    """Whether the beaker was held, carried and put down."""
    x, y, z = BEAKER
    hand.place = [x, y, z + 0.15]  # in front of it, open, the palm towards it
    while hand.forces.heard is None:
        hand.frame()
    hand.move(0.5)
    hand.move(1.2, place=(x, y, z))
    hand.move(1.5, gap=0.080, until=hand.is_holding)
    if not hand.is_holding():
        print("osc_hand: the hand closed, and nothing was held")
        return False
    hand.move(0.3, gap=hand.gap - 0.003)  # firmer
    hand.move(0.8, place=(x, y + LIFT, z))
    hand.move(0.5)
    was_carried = hand.is_holding()
    hand.move(0.8, place=(x, y, z))
    hand.move(0.6, gap=GAP[1])
    hand.move(1.0, place=(x, y, z + 0.15))
    return was_carried and not hand.is_holding()


def main():
    parser = argparse.ArgumentParser(description="Plays a hand over Open Sound Control for `wholehand live --device osc:PORT`.")
    parser.add_argument("--host", default="127.0.0.1", help="where wholehand runs (default: %(default)s)")
    parser.add_argument("--port", type=int, default=9001, help="the port of --device osc:PORT (default: %(default)s)")
    parser.add_argument("--rate", type=float, default=90, help="frames a second (default: %(default)s)")
    arguments = parser.parse_args()
    if not 1 <= arguments.port <= 65535 or not 30 <= arguments.rate <= 1000:
        parser.error("allowed: --port 1 to 65535, --rate 30 to 1000")
    hand = Hand(arguments.host, arguments.port, arguments.rate)
    was_good = play(hand)
    hand.bye()
    print(f"the beaker was {'carried' if was_good else 'not carried'}; the largest grip force was {hand.most_grip:.2f} N")
    return 0 if was_good else 1


if __name__ == "__main__":
    sys.exit(main())
