# SPDX-License-Identifier: MIT
"""A headless Chromium that a test drives: DevTools' protocol over its pipe, with nothing but Python's standard library.

    with Browser() as browser:
        page = browser.open("http://127.0.0.1:8000/", width=1200, height=800)
        page.evaluate("document.title")

WebGL is rendered in software, so that it is the same everywhere.
"""

import base64
import json
import os
import queue
import shutil
import subprocess
import tempfile
import threading
import time

PROGRAMS = ["chromium-headless-shell", "chromium"]
FLAGS = ["--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--disable-dev-shm-usage", "--hide-scrollbars", "--mute-audio", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-default-apps", "--disable-sync", "--force-color-profile=srgb",
         "--webgl-antialiasing-mode=none"]  # drawn in software: 12 % of the time of a test
KEYS = {"ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40, "Tab": 9, "Enter": 13, "Escape": 27, "Home": 36,
        "End": 35, "PageUp": 33, "PageDown": 34, " ": 32}
SHIFT = 8


class BrowserError(Exception):
    pass


class Browser:
    def __init__(self, patience=60):
        self.patience = patience  # s that an answer may take: a machine with much else to do is slow, not wrong
        program = next((found for found in map(shutil.which, PROGRAMS) if found), None)
        if not program:
            raise BrowserError("no Chromium: apt-get install " + PROGRAMS[0])
        self.folder = tempfile.mkdtemp(prefix="wholehand_browser_")
        to_browser, ours_out = os.pipe()
        ours_in, from_browser = os.pipe()

        def as_three_and_four():  # the descriptors on which Chromium listens; it may have been given either already
            a, b = os.dup(to_browser), os.dup(from_browser)
            os.dup2(a, 3)
            os.dup2(b, 4)

        self.process = subprocess.Popen(
            [program, *FLAGS, "--remote-debugging-pipe", f"--user-data-dir={self.folder}", "about:blank"], pass_fds=(3, 4),
            preexec_fn=as_three_and_four, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, env={**os.environ, "HOME": self.folder})
        os.close(to_browser)
        os.close(from_browser)
        self.out = os.fdopen(ours_out, "wb", buffering=0)
        self.answers, self.pages, self.number, self.lock = {}, {}, 0, threading.Lock()
        self.reader = threading.Thread(target=self._read, args=(os.fdopen(ours_in, "rb"),), daemon=True)
        self.reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.call("Browser.close")
        except BrowserError:
            pass
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.out.close()
        self.reader.join(10)
        shutil.rmtree(self.folder, ignore_errors=True)

    def _read(self, stream):
        rest = b""
        while True:
            some = stream.read1(1 << 16)
            if not some:
                break
            *messages, rest = (rest + some).split(b"\0")
            for text in messages:
                message = json.loads(text)
                if "id" in message:
                    waiting = self.answers.get(message["id"])
                    if waiting:
                        waiting.put(message)
                elif message.get("sessionId") in self.pages:
                    self.pages[message["sessionId"]].hear(message["method"], message["params"])
        stream.close()
        for waiting in list(self.answers.values()):
            waiting.put({"error": {"message": "the browser is gone"}})

    def call(self, method, session=None, **parameters):
        with self.lock:
            self.number += 1
            number = self.number
            answer = self.answers[number] = queue.Queue()
            message = {"id": number, "method": method, "params": parameters}
            if session:
                message["sessionId"] = session
            try:
                self.out.write(json.dumps(message).encode() + b"\0")
            except OSError as error:
                raise BrowserError("the browser is gone") from error
        try:
            message = answer.get(timeout=self.patience)
        except queue.Empty:
            raise BrowserError(f"no answer to {method} in {self.patience} s") from None
        finally:
            del self.answers[number]
        if "error" in message:
            raise BrowserError(f"{method}: {message['error']['message']}")
        return message["result"]

    def open(self, address, width=1200, height=800, scale=1, **emulation):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        page = Page(self, session, target)
        self.pages[session] = page
        for domain in ["Page", "Runtime", "Log", "Network"]:
            page.call(f"{domain}.enable")
        page.resize(width, height, scale)
        page.emulate(**emulation)
        page.go(address)
        return page


class Page:
    def __init__(self, browser, session, target):
        self.browser, self.session, self.target = browser, session, target
        self.errors, self.requests, self.loaded = [], [], threading.Event()

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def hear(self, method, what):
        if method == "Page.loadEventFired":
            self.loaded.set()
        elif method == "Runtime.exceptionThrown":
            details = what["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and what["type"] in ("error", "warning", "assert"):
            self.errors.append(" ".join(str(a.get("value", a.get("description", ""))) for a in what["args"]))
        elif method == "Log.entryAdded" and what["entry"]["level"] in ("error", "warning"):
            self.errors.append(what["entry"]["text"] + " " + what["entry"].get("url", ""))
        elif method == "Network.requestWillBeSent":
            self.requests.append(what["request"]["url"])

    def go(self, address):
        self.loaded.clear()
        result = self.call("Page.navigate", url=address)
        if result.get("errorText"):
            raise BrowserError(f"{address}: {result['errorText']}")
        if not self.loaded.wait(self.browser.patience):
            raise BrowserError(f"{address} did not load in {self.browser.patience} s")

    def close(self):
        self.browser.call("Target.closeTarget", targetId=self.target)

    def resize(self, width, height, scale=1, mobile=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=mobile)

    def emulate(self, dark=False, still=False):
        self.call("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
            {"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"}])

    def evaluate(self, expression):
        """The value of a JavaScript expression; a promise is waited for."""
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True, userGesture=True)
        if "exceptionDetails" in result:
            details = result["exceptionDetails"]
            raise BrowserError(details.get("exception", {}).get("description", details["text"]))
        return result["result"].get("value")

    def wait(self, expression, seconds=None, what=None):
        """Until the expression, or what it promises, is true."""
        seconds = seconds or self.browser.patience
        end = time.monotonic() + seconds
        while True:
            if self.evaluate(f"Promise.resolve({expression}).then(Boolean)"):
                return
            if time.monotonic() > end:
                raise BrowserError(f"{what or expression}: not in {seconds} s; errors: {self.errors}")
            time.sleep(0.05)

    def picture(self, x=None, y=None, width=1, height=1):
        """The page as a PNG, or a piece of it: bytes."""
        piece = {} if x is None else {"clip": {"x": x, "y": y, "width": width, "height": height, "scale": 1}}
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", **piece)["data"])

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(self.picture())

    def mouse(self, kind, x, y, button="left", **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, buttons=0 if kind == "mouseReleased" else 1,
                  clickCount=1, **more)

    def click(self, x, y):
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y)

    def drag(self, start, end, steps=8):
        self.mouse("mousePressed", *start)
        for k in range(1, steps + 1):
            self.mouse("mouseMoved", *(a + (b - a) * k / steps for a, b in zip(start, end)))
        self.mouse("mouseReleased", *end)

    def touch(self, kind, points):
        self.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)])

    def key(self, key, modifiers=0):
        self.press(key, modifiers=modifiers)
        self.let_go(key, modifiers=modifiers)

    def press(self, key, modifiers=0, repeats=False):
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", autoRepeat=repeats, **text, **self._about(key, modifiers))

    def let_go(self, key, modifiers=0):
        self.call("Input.dispatchKeyEvent", type="keyUp", **self._about(key, modifiers))

    @staticmethod
    def _about(key, modifiers):
        return dict(key=key, windowsVirtualKeyCode=KEYS.get(key, ord(key[0].upper())), modifiers=modifiers, code=key if len(key) > 1 else "")
