# SPDX-License-Identifier: MIT
"""examples/godot-stream: a session's stream moves the nodes of a hand in Godot. Where the nodes are is compared with what was sent.
While a vessel is held, it is also compared with the hand of that grip as `wholehand grip --json` has it."""

import json
import math
import os
import re
import socket
import struct
import subprocess
import threading
import time
import unittest

from netCDF4 import Dataset

from harness import PROGRAM, minus, unit
from support import JOINTS, PATIENCE, EngineTest, distance, environment, grip, inward, own_copy, roll_of, rows_of

SECONDS = 3.5  # of the session: the simulated user holds the beaker after 2 s
HELD = {"lift", "tilt", "maintain"}


def messages_of(packet):
    """Another hand's reader of Open Sound Control: {address: arguments} of a bundle of messages."""
    def text(at):
        end = packet.index(b"\0", at)
        return packet[at:end].decode(), (end // 4 + 1) * 4
    assert packet[:8] == b"#bundle\0"
    found, at = {}, 16
    while at < len(packet):
        size = struct.unpack_from(">i", packet, at)[0]
        address, place = text(at + 4)
        tags, place = text(place)
        values = []
        for tag in tags[1:]:
            if tag == "s":
                value, place = text(place)
            else:
                value = struct.unpack_from(">" + tag, packet, place)[0]
                place += 4
            values.append(value)
        found[address] = values
        at += 4 + size
    return found


def damaged(packet, kind):
    """Three kinds of datagrams with wrong numbers: a reader that takes any part of one shows what was never sent."""
    tags = b",fffffff\0\0\0\0"
    wrong = re.sub(tags + b"....", tags + struct.pack(">f", 77.0), packet, flags=re.DOTALL)
    if kind == 0:  # its last word is missing
        return wrong[:-4]
    if kind == 1:  # the last message with a pose has a number more than its tags say
        return b",ffffff\0\0\0\0\0".join(wrong.rsplit(tags, 1))
    return b",fffdfff\0\0\0\0".join(wrong.rsplit(tags, 1))  # or a type that the stream does not send


def packed(*messages):
    """A bundle of messages, each an address and arguments."""
    def text(value):
        return value.encode() + b"\0" * (4 - len(value) % 4)
    bundle = text("#bundle") + struct.pack(">q", 1)
    for address, *arguments in messages:
        tags = "".join({int: "i", float: "f", str: "s"}[type(value)] for value in arguments)
        body = text(address) + text("," + tags)
        body += b"".join(text(value) if tag == "s" else struct.pack(">" + tag, value) for tag, value in zip(tags, arguments))
        bundle += struct.pack(">i", len(body)) + body
    return bundle


def foreign(number):
    """What another program may send: sound, but with other arguments. Nothing in it is a pose."""
    index = "/wholehand/joint/XR_HAND_JOINT_INDEX_TIP_EXT"
    return [packed(("/wholehand/frame",), (index, 1.0, 2.0), ("/wholehand/end",)),
            packed(("/wholehand/frame", number, 0.0), ("/wholehand/state", 7), (index, *["x"] * 7),
                   ("/wholehand/joint/NONE", *[1.0] * 7), ("/wholehand/joint/XR_HAND_JOINT_WRIST_EXT", *[math.nan] * 7),
                   ("/wholehand/vessel/beaker/pose", *[0.0] * 7), ("/wholehand/end", number))]


class Relay(threading.Thread):
    """Between the program and Godot: keeps what was sent, and hands it on. A damaged copy follows some of it."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.target = ("127.0.0.1", port)
        self.frames = {}  # by the number of the tick
        self.last = []  # datagrams of the newest frame
        self.socket.settimeout(0.2)
        self.ended = threading.Event()

    def run(self):
        while not self.ended.is_set():
            try:
                packet = self.socket.recv(65536)
            except TimeoutError:
                continue
            found = messages_of(packet)
            number = found["/wholehand/frame"][0]
            if number not in self.frames:
                self.last = []
            self.frames.setdefault(number, {}).update(found)
            self.last.append(packet)
            self.socket.sendto(packet, self.target)
            if len(self.last) < 3:  # not the last of a frame, behind which nobody would see it
                self.socket.sendto(damaged(packet, len(self.frames) % 3), self.target)
            if "/wholehand/end" in found:
                for other in foreign(number):
                    self.socket.sendto(other, self.target)

    def send_last(self):
        """Once more: a busy machine may have dropped it, and no frame follows."""
        for packet in self.last:
            self.socket.sendto(packet, self.target)


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class GodotStream(EngineTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.project = own_copy("godot-stream", cls.folder)
        port, places = free_port(), os.path.join(cls.folder, "places.jsonl")
        godot = cls.start(f"--port={port}", f"--write={places}", "--until=released")
        cls.addClassCleanup(godot.kill)
        cls.said = [godot.stdout.readline()]
        while cls.said[-1] and not cls.said[-1].startswith("listens"):
            cls.said.append(godot.stdout.readline())
        relay = Relay(port)
        relay.start()
        live = subprocess.run([PROGRAM, "live", cls.scene, "--device", "sim", "--seconds", str(SECONDS), "--record", "session.nc",
                               "--stream", f"osc://127.0.0.1:{relay.port}"],
                              cwd=cls.folder, capture_output=True, text=True, timeout=PATIENCE)
        if live.returncode:
            raise AssertionError(live.stderr)
        deadline = time.monotonic() + PATIENCE
        while godot.poll() is None and time.monotonic() < deadline:
            time.sleep(0.1)
            relay.send_last()
        relay.ended.set()
        relay.join()
        relay.socket.close()
        rest, _ = godot.communicate(timeout=PATIENCE)
        cls.said = "".join(cls.said) + rest
        cls.code = godot.returncode
        cls.sent = relay.frames
        with open(places) as file:
            cls.shown = [json.loads(line) for line in file]

    @classmethod
    def start(cls, *arguments):
        return subprocess.Popen(["godot3-server", "--path", cls.project, *arguments], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, env=environment(cls.folder))

    def test_runs_without_a_word_of_error(self):
        self.assertEqual(self.code, 0, self.said)
        self.assertNotIn("ERROR", self.said)

    def test_shows_many_frames_and_the_last_one(self):
        # sixty frames a second were sent; on a busy machine it may be fewer, and datagrams get lost
        self.assertGreater(len({frame["tick"] for frame in self.shown}), 3)
        last = [frame for frame in self.shown if frame["state"]][-1]
        self.assertEqual((last["tick"], last["state"]), (max(self.sent), "released"))

    def test_nodes_are_where_the_stream_says(self):
        whole = 0
        for frame in self.shown:
            sent = self.sent[frame["tick"]]
            self.assertIn(frame["state"], ("", sent["/wholehand/state"][1]))
            poses = {f"/wholehand/joint/{name}": pose for name, pose in frame["joints"].items()}
            poses.update({f"/wholehand/vessel/{name}/pose": pose for name, pose in frame["vessels"].items()})
            whole += len(poses) == 26  # 24 joints, the wrist, a vessel
            for address, pose in poses.items():
                # a place is the float32 that was sent, written with 12 digits after the point
                self.assertLess(distance(pose[:3], sent[address][:3]), 1e-11, address)
                # a turn became a matrix of float32 and a quaternion again: some units of 6e-8
                turn = sent[address][3:]
                apart = min(distance(pose[3:], turn), distance(pose[3:], [-x for x in turn]))
                self.assertLess(apart, 1e-5, address)
        self.assertGreater(whole, 0)

    def test_a_held_hand_is_that_of_the_grip(self):
        with Dataset(os.path.join(self.folder, "session.nc")) as data:
            ticks = [int(tick) for tick in data["tick"][:]]
            states = data["state"].flag_meanings.split()
            first = next(k for k in range(len(ticks)) if states[data["state"][k]] in HELD)
            # thumb, index finger and gripper in the frame of the vessel
            rows, place = data["vessel_rotation"][first].tolist(), data["vessel_place"][first].tolist()
            thumb, index = (inward(rows, place, tip) for tip in data["proxies"][first].tolist())
            gripper = data["hand_rotation"][first].tolist()
            self.assertLess(max(abs(rows[k][n] - (k == n)) for k in range(3) for n in range(3)), 1e-12, "it stood upright")
        place = [",".join(f"{1e3 * x:.12g}" for x in tip) for tip in (thumb, index)]
        roll = roll_of(unit(minus(index, thumb)), gripper)
        self.assertGreater(abs(roll), 1, "degrees: a hand that is not level would be told apart from one that is")
        known = grip(self.scene, f"--thumb-mm={place[0]}", f"--index-mm={place[1]}", f"--roll-deg={roll:.12g}")
        self.assertTrue(known["feasible"])
        # A session takes a tip that is within the contact tolerance for one that touches. The hand of a grip touches. The tip's own
        # place shows by how much they differ. A finger that turns alone may carry that on tenfold.
        apart = max(distance(known["posed_m"][JOINTS.index(f"XR_HAND_JOINT_{finger}_TIP_EXT")], tip)
                    for finger, tip in (("THUMB", thumb), ("INDEX", index)))
        self.assertLess(apart, 4.1e-6)
        # a session that is over keeps what it last had in its hand: the last frame, which always comes, is one of these
        held = [frame for frame in self.shown if frame["state"] in HELD | {"released"} and frame["tick"] > ticks[first]
                and len(frame["joints"]) == 25 and frame["vessels"]]
        self.assertEqual(held[-1]["state"], "released")
        for frame in held:
            beaker = frame["vessels"]["beaker"]
            seen = [inward(rows_of(beaker[3:]), beaker[:3], frame["joints"][name][:3]) for name in JOINTS]
            # 1e-7 m, to which a session finds the hand of a grip (tests/device/session/hand_view_test.cpp), and some units of 3e-8 of places
            # below 0.5 m and of turns in float32
            self.assert_places(seen, known["proxies_m"], 1e-6 + 10 * apart)

    def test_names_of_the_network_reach_only_the_hand_and_some_vessels(self):
        pose = [0.125, 0.25, 0.5, 0.0, 0.0, 0.0, 1.0]
        hand = [*JOINTS, "XR_HAND_JOINT_WRIST_EXT"]
        paths = ["..", "../Vessels", ".", JOINTS[0] + "/..", "/root"]  # each leads to a node
        frame = packed(("/wholehand/frame", 7, 0.0), ("/wholehand/state", 6, "released"),
                       *((f"/wholehand/joint/{path}", *[9.0] * 3, *pose[3:]) for path in paths),
                       *((f"/wholehand/vessel/{k}/pose", *pose) for k in range(100)),
                       *((f"/wholehand/joint/{joint}", *pose) for joint in hand), ("/wholehand/end", 7))
        port, places = free_port(), os.path.join(self.folder, "named.jsonl")
        godot = self.start(f"--port={port}", f"--write={places}", "--until=released")
        self.addCleanup(godot.kill)
        said = godot.stdout.readline()
        while not said.split("\n")[-2].startswith("listens"):
            line = godot.stdout.readline()
            self.assertTrue(line, said)
            said += line
        deadline = time.monotonic() + PATIENCE
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            while godot.poll() is None and time.monotonic() < deadline:
                sender.sendto(frame, ("127.0.0.1", port))
                time.sleep(0.1)
        said += godot.communicate(timeout=PATIENCE)[0]
        self.assertEqual(godot.returncode, 0, said)
        self.assertNotIn("ERROR", said)
        with open(places) as file:
            shown = json.loads(file.readline())
        self.assertEqual(sorted(shown["joints"]), sorted(hand))
        self.assertEqual(len(shown["vessels"]), 16)
        for name, place in [*shown["joints"].items(), *shown["vessels"].items()]:
            self.assertEqual(place, pose, name)  # numbers that float32 has; a node that holds others was not moved

    def test_a_port_that_another_has_is_an_error_in_one_line(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", 0))
            port = other.getsockname()[1]
            godot = self.start(f"--port={port}")
            said, _ = godot.communicate(timeout=PATIENCE)
        self.assertEqual(godot.returncode, 3, said)
        self.assertIn(f"port {port} of 127.0.0.1 cannot be opened", said)


if __name__ == "__main__":
    unittest.main(verbosity=2)
