# SPDX-License-Identifier: MIT
"""What the viewer's tests share: the program with its view, places on the screen worked out anew, pictures."""

import json
import math
import os
import re
import shutil
import signal
import struct
import subprocess
import tempfile
import unittest
import urllib.request
import zlib

from browser import Browser
from harness import PROGRAM, cross, dot, minus, unit

PATIENCE = 180  # s


def patient_board(folder):
    """The scene mixing_board, whose session no busy machine ends by late ticks."""
    shipped = os.path.join(os.path.dirname(__file__), "../../../examples/scenes/mixing_board.toml")
    path = os.path.join(folder, "mixing_board.toml")
    with open(shipped) as scene, open(path, "w") as file:
        file.write(scene.read() + "\n[live]\nlate_steps = 1000\n")
    return path


class Served:
    """A command that serves a view."""

    def __init__(self, *arguments, folder=None):
        self.process = subprocess.Popen([PROGRAM, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True)
        said = []
        for line in self.process.stdout:
            said.append(line)
            found = re.search(r"http://127\.0\.0\.1:\d+/[0-9a-f]+/", line)
            if found:
                self.address = found.group()
                return
        self.process.communicate()
        raise AssertionError("no address: " + "".join(said))

    def get(self, path):
        with urllib.request.urlopen(self.address + path, timeout=PATIENCE) as answer:
            return json.load(answer)

    def stop(self):
        """Interrupts it; its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.process.communicate(timeout=PATIENCE)
        return self.process.returncode


class ViewerTest(unittest.TestCase):
    """One browser and a folder for all tests of a class."""

    # Device pixels a CSS pixel. Pictures are drawn in software: where no test checks one, half as many a side cost a quarter.
    scale = 1

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="wholehand_viewer_")
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.browser = Browser(PATIENCE)
        cls.addClassCleanup(cls.browser.__exit__)

    @classmethod
    def serve(cls, *arguments):
        served = Served(*arguments, folder=cls.folder)
        cls.addClassCleanup(served.stop)
        return served

    def open(self, served, width=1200, height=800, **emulation):
        """A page that shows its first frame, with nothing to complain about by the test's end."""
        page = self.browser.open(served.address, width, height, self.scale, **emulation)
        self.addCleanup(page.close)
        page.wait("window.wholehand && wholehand.frame", what="the first frame")
        self.addCleanup(lambda: self.assertEqual(complaints(page), []))
        return page

    def assert_near(self, found, expected, tolerance, what=""):
        self.assertEqual(len(found), len(expected), what)
        worst = max(abs(a - b) for a, b in zip(found, expected))
        self.assertLessEqual(worst, tolerance, what)


def complaints(page):
    """The page's errors, less those of a stream of frames that the server cut as nothing was read for seconds: the page asks for it anew."""
    return [error for error in page.errors if not ("ERR_INCOMPLETE_CHUNKED_ENCODING" in error and error.endswith("/frames"))]


def still(page):
    """Waits until the camera has come to rest."""
    page.wait("wholehand.camera().isStill", what="the camera at rest")


def drawn(page):
    """Waits until what was asked for is in the picture."""
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def color_at(page, x, y):
    """Color of the page at CSS pixel x, y."""
    return Picture(page.picture(int(x), int(y))).color(0, 0)


def slide(page, name, value):
    """Moves a slider as a hand does: its value, and the event."""
    page.evaluate(f"(() => {{ const slider = document.getElementById('{name}'); slider.value = {value};"
                  " slider.dispatchEvent(new Event('input', {bubbles: true})); })()")


def projected(camera, place):
    """Where a place of the world is in the window, px: from where the camera is, what it looks at, and its vertical field of view alone."""
    forward = unit(minus(camera["target"], camera["position"]))
    right = unit(cross(forward, [0, 1, 0]))
    up = cross(right, forward)
    way = minus(place, camera["position"])
    box = camera["rectangle"]
    scale = box["height"] / 2 / math.tan(camera["fov"] / 2) / dot(way, forward)
    return [box["left"] + box["width"] / 2 + dot(way, right) * scale, box["top"] + box["height"] / 2 - dot(way, up) * scale]


def turned_back(rotation, v):
    """A vector of the world in a frame that is turned by a quaternion x, y, z, w."""
    axis, w = [-c for c in rotation[:3]], rotation[3]
    t = [2 * c for c in cross(axis, v)]
    return [v[k] + w * t[k] + cross(axis, t)[k] for k in range(3)]


class Picture:
    """A PNG as Chromium writes it: 8 bits, RGB or RGBA."""

    def __init__(self, data):
        at, packed = 8, b""
        while at < len(data):
            length, kind = struct.unpack(">I4s", data[at:at + 8])
            part = data[at + 8:at + 8 + length]
            if kind == b"IHDR":
                self.width, self.height, depth, color = struct.unpack(">IIBB", part[:10])
                assert depth == 8 and color in (2, 6)
                self.channels = 3 if color == 2 else 4
            elif kind == b"IDAT":
                packed += part
            at += 12 + length
        self.rows = self._unfilter(zlib.decompress(packed))

    def _unfilter(self, raw):
        n, rows, above = self.channels, [], bytearray(self.width * self.channels)
        for y in range(self.height):
            start = y * (len(above) + 1)
            kind, row = raw[start], bytearray(raw[start + 1:start + 1 + len(above)])
            for x in range(len(row)):
                a, b, c = row[x - n] if x >= n else 0, above[x], above[x - n] if x >= n else 0
                if kind == 1:
                    row[x] = (row[x] + a) & 255
                elif kind == 2:
                    row[x] = (row[x] + b) & 255
                elif kind == 3:
                    row[x] = (row[x] + (a + b) // 2) & 255
                elif kind == 4:
                    p = a + b - c
                    nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
                    row[x] = (row[x] + nearest) & 255
            rows.append(row)
            above = row
        return rows

    def color(self, x, y):
        at = int(x) * self.channels
        return list(self.rows[int(y)][at:at + 3])


def main():
    unittest.main(verbosity=2)
