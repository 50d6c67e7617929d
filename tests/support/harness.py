# SPDX-License-Identifier: MIT
"""What tests in Python share: the program and its answers, its commands, small geometry. tests/CMakeLists.txt puts this folder on the path."""

import math
import os
import re
import subprocess

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
STAGED = os.environ.get("STAGED", "")  # where the packages are unpacked
PROGRAM = os.environ.get("WHOLEHAND_PROGRAM") or STAGED + "/usr/bin/wholehand"
PATIENCE = 900  # s: on however busy a machine


def ask(*arguments, folder=None):
    """How a command of the program ends."""
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=PATIENCE)


def run(*arguments, code=0, folder=None):
    """A command's standard output; `code` is how it has to end."""
    done = ask(*arguments, folder=folder)
    assert done.returncode == code, (arguments, done.returncode, done.stderr)
    return done.stdout


def complaint(*arguments, folder=None):
    """Exit code and last line of what the program says as it refuses."""
    done = ask(*arguments, folder=folder)
    assert done.returncode != 0, arguments
    return done.returncode, done.stderr.splitlines()[-1].removeprefix("wholehand: ")


def text(path):
    with open(path) as file:
        return file.read()


# ---- the program's commands ----

def help_of(*words):
    return run(*words, "--help")


def commands(*words):
    part = re.search(r"^Subcommands:\n((?:  .*\n)+)", help_of(*words), re.MULTILINE)
    return re.findall(r"^  (\S+)", part[1], re.MULTILINE) if part else []


def all_commands():
    """The words of each command, the program's own first: (), ("sweep",), ("stability", "wall") ..."""
    found = [()]
    for words in found:
        found += [(*words, name) for name in commands(*words)]
    return found


# ---- vectors, as lists ----

def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]
