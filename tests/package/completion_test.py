# SPDX-License-Identifier: MIT
"""Completion of the installed program in bash, zsh and fish: what the shells offer, against what the program says of itself."""

import os
import pty
import re
import select
import signal
import subprocess
import tempfile
import time
import unittest

from harness import STAGED, all_commands, ask, commands, help_of, run

SHARE = os.path.join(STAGED, "usr/share")
BASH_SCRIPT = os.path.join(SHARE, "bash-completion/completions/wholehand")
FOLDER = ["a b.toml", "mine.toml", "result.nc", "notes.txt", "list.csv", "folder/inner.nc"]  # files that a shell sees
# The longest that a shell may take to show what it completed; a busy machine needs some seconds.
PATIENCE_S = 60

folder = None


def setUpModule():
    global folder
    folder = tempfile.TemporaryDirectory()
    for name in FOLDER:
        path = os.path.join(folder.name, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        open(path, "w").close()


def tearDownModule():
    folder.cleanup()


def environment():
    return {"PATH": "/usr/bin:/bin", "HOME": folder.name, "LC_ALL": "C.UTF-8", "TERM": "dumb",
            "XDG_CONFIG_HOME": folder.name + "/.config", "XDG_DATA_HOME": folder.name + "/.data"}


def in_shell(*command):
    return subprocess.run(command, cwd=folder.name, env=environment(), capture_output=True, text=True)


def options(words):
    return {name for names in re.findall(r"^  (-\S+)", help_of(*words), re.MULTILINE) for name in names.split(",")}


def scenes():
    return re.findall(r"^(\S+)", run("scenes"), re.MULTILINE)


def bash_run(text, *arguments):
    done = in_shell("bash", "--norc", "-c", f"source '{BASH_SCRIPT}'\n{text}", "bash", *arguments)
    return done.stdout, done.stderr


def bash(line):
    """What bash offers for the end of the line, which it splits at spaces, '=' and ':'."""
    words = re.findall(r"[=:]|[^\s=:]+", line) + ([""] if line.endswith(" ") else [])
    text = 'COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _wholehand; printf "%s\\n" "${COMPREPLY[@]}"'
    output, errors = bash_run(text, *words)
    assert errors == "", errors
    return sorted(filter(None, output.split("\n")))


def fish(line):
    script = SHARE + "/fish/vendor_completions.d/wholehand.fish"
    done = in_shell("fish", "--no-config", "-c", f"source {script}; complete -C $argv[1]", line)
    assert done.stderr == "", done.stderr
    return sorted(row.split("\t")[0] for row in done.stdout.splitlines())


class Terminal:
    """A shell at a terminal. `wholehand` is a function of it that prints its arguments between marks."""

    def __init__(self, command, setup):
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.chdir(folder.name)
            os.execvpe(command[0], command, environment())
        self.seen = ""
        self.send(setup + "\necho re''ady\n")
        self.wait(r"ready\r?\n")

    def send(self, text):
        os.write(self.terminal, text.encode())

    def wait(self, pattern):
        """What the pattern found; it and everything before it are used up."""
        end = time.monotonic() + PATIENCE_S
        while not (found := re.search(pattern, self.seen)):
            assert time.monotonic() < end, f"{pattern}: not in {self.seen!r}"
            if select.select([self.terminal], [], [], 1)[0]:
                self.seen += os.read(self.terminal, 65536).decode(errors="replace")
        self.seen = self.seen[found.end():]
        return found

    def complete(self, line):
        """The arguments that the shell has after the line and a tab."""
        self.send(line + "\t\n")
        return self.wait(r"<<(.*)>>")[1].split("|")[:-1]

    def close(self):
        os.kill(self.process, signal.SIGKILL)
        os.waitpid(self.process, 0)
        os.close(self.terminal)


SHOW = r"""wholehand() { printf '<''<'; printf '%s|' "$@"; echo '>''>'; }"""


class Bash(unittest.TestCase):
    def test_terms_are_no_files(self):
        open(os.path.join(folder.name, "ends."), "w").close()
        self.assertEqual(bash("wholehand rank none.nc --weights "), [])

    def test_commands_and_options_are_those_of_help(self):
        self.assertGreater(len(all_commands()), 15)
        for words in all_commands():
            line = " ".join(("wholehand", *words))
            self.assertEqual(set(bash(line + " -")), options(words), words)
            self.assertLessEqual(set(commands(*words)), set(bash(line + " ")), words)

    def test_values_are_those_that_the_program_allows(self):
        needed = {"sweep": ["small"], "grip": ["small", "--vessel", "tumbler", "--height-mm", "50"],
                  "trials": ["small", "-o", "nowhere"], "rank": ["none.nc"],
                  "new": ["cup", "--diameter-mm", "70", "--height-mm", "120"], "mesh": ["none.stl"], "study": ["-o", "nowhere"],
                  "live": []}
        table = bash_run("declare -f _wholehand_value")[0]
        rows = re.findall(r"'(\S+) (--\S+)'[^)]*\)\s*echo '\w+ ([^-'].*)'", table)
        checked = 0
        for command, option, offered in rows:
            words = [word for word in offered.split(" -")[0].split() if word]
            if option in ("--on", "--advise-on"):  # besides the names of devices
                self.assertLessEqual(set(words), {"auto", "core", "vulkan"})
                continue
            message = ask(command, *needed[command], option, "nonsense").stderr
            allowed = re.search(r"allowed: (.*)", message)
            self.assertTrue(allowed, message)
            names = re.findall(r"[^\s,;]+", re.sub(r"; .*", "", allowed[1]))
            whole = {name for name in names if ":" not in name} - {"or"}
            # replay:FILE is offered up to its colon, and hid:PATH as hid, which is enough
            names = whole | {name.split(":")[0] + ":" for name in names if ":" in name and name.split(":")[0] not in whole}
            self.assertEqual(set(words), names, f"{command} {option}: {message}")
            checked += 1
        self.assertEqual(checked, 10)

    def test_scenes_and_files(self):
        own = ["a b.toml", "mine.toml"]
        self.assertEqual(bash("wholehand sweep "), sorted(scenes() + own + ["folder"]))
        self.assertEqual(bash("wholehand sweep sm"), ["small"])
        self.assertEqual(bash("wholehand sweep small "), [])
        self.assertEqual(bash("wholehand sweep --best 5 m"), ["mine.toml", "mixing_board"])
        self.assertEqual(bash("wholehand trials r"), ["result.nc"])
        self.assertEqual(bash("wholehand view "), ["folder", "result.nc"])
        self.assertEqual(bash("wholehand view folder/"), ["folder/inner.nc"])
        self.assertEqual(bash("wholehand session result.nc f"), ["folder"])
        self.assertEqual(bash("wholehand rank result.nc -o "), ["folder", "list.csv"])
        self.assertEqual(bash("wholehand sweep -o "), sorted({name.split("/")[0] for name in FOLDER}))
        self.assertEqual(bash("wholehand trials small -o "), ["folder"])
        self.assertEqual(bash("wholehand live --device replay:r"), ["result.nc"])
        self.assertEqual(bash("wholehand live --device re"), ["replay:"])
        self.assertEqual(bash("wholehand live --device replay:"), ["folder", "result.nc"])
        self.assertEqual(bash("wholehand live --device=replay:r"), ["result.nc"])
        self.assertEqual(bash("wholehand live --device os"), ["osc:"])
        for device in ("osc:", "hid:", "hid:r", "usb:r", "osc:replay:r"):
            self.assertEqual(bash("wholehand live --device " + device), [], device)
        self.assertEqual(bash("wholehand live --device=si"), ["sim"])
        self.assertEqual(bash("wholehand grip small --tilt-deg 0 30 --on c"), ["core"])
        self.assertEqual(bash("wholehand sweep --on nothing:"), [])
        self.assertEqual(bash("wholehand help st"), ["stability", "study"])
        self.assertEqual(bash("wholehand stability wall --fin"), ["--finger"])
        self.assertEqual(bash("wholehand sweep --best "), [])

    def test_at_a_terminal(self):
        setup = f"PS1=; bind 'set bell-style none'; source '{BASH_SCRIPT}'; {SHOW}"
        shell = Terminal(["bash", "--norc", "--noprofile", "-i"], setup)
        self.addCleanup(shell.close)
        self.assertEqual(shell.complete("wholehand swe"), ["sweep"])
        self.assertEqual(shell.complete("wholehand sweep a"), ["sweep", "a b.toml"])
        self.assertEqual(shell.complete("wholehand live --device replay:r"), ["live", "--device", "replay:result.nc"])
        self.assertEqual(shell.complete("wholehand live --device=si"), ["live", "--device=sim"])


class Zsh(unittest.TestCase):
    def test_at_a_terminal(self):
        subprocess.run(["zsh", "-n", f"{SHARE}/zsh/vendor-completions/_wholehand"], check=True)
        setup = (f"PS1=; unsetopt beep; fpath=({SHARE}/zsh/vendor-completions $fpath); autoload -Uz compinit; compinit -u -D; "
                 f"{SHOW}")
        shell = Terminal(["zsh", "-f", "-i"], setup)
        self.addCleanup(shell.close)
        for line, expected in [
                ("wholehand swe", ["sweep"]),
                ("wholehand sweep sma", ["sweep", "small"]),
                ("wholehand sweep mine", ["sweep", "mine.toml"]),
                ("wholehand sweep a", ["sweep", "a b.toml"]),
                ("wholehand sweep --prec", ["sweep", "--precision"]),
                ("wholehand sweep --precision fl", ["sweep", "--precision", "float"]),
                ("wholehand sweep --precision=fl", ["sweep", "--precision=float"]),
                ("wholehand trials res", ["trials", "result.nc"]),
                ("wholehand trials small -o fol", ["trials", "small", "-o", "folder"]),
                ("wholehand live --device replay:res", ["live", "--device", "replay:result.nc"]),
                ("wholehand live --device hid:res", ["live", "--device", "hid:res"]),
                ("wholehand live --device os", ["live", "--device", "osc:"]),
                ("wholehand stability wa", ["stability", "wall"]),
                ("wholehand stability wall --fin", ["stability", "wall", "--finger"]),
                ("wholehand help tri", ["help", "trials"])]:
            self.assertEqual(shell.complete(line), expected, line)


class Fish(unittest.TestCase):
    def test_commands_and_options_are_those_of_help(self):
        for words in all_commands():
            line = " ".join(("wholehand", *words))
            self.assertEqual(set(fish(line + " --")), {name for name in options(words) if name.startswith("--")}, words)
            self.assertLessEqual(set(commands(*words)), set(fish(line + " ")), words)

    def test_values_scenes_and_files(self):
        self.assertEqual(fish("wholehand sweep sm"), ["small"])
        self.assertEqual(fish("wholehand sweep mi"), ["mine.toml", "mixing_board"])
        self.assertEqual(fish("wholehand sweep --precision "), ["double", "float"])
        self.assertEqual(fish("wholehand view res"), ["result.nc"])
        self.assertEqual(fish("wholehand trials small -o fol"), ["folder/"])
        self.assertEqual(fish("wholehand live --device replay:res"), ["replay:result.nc"])
        self.assertEqual(fish("wholehand live --device hid:res"), [])
        self.assertEqual(fish("wholehand live --device os"), ["osc:"])
        self.assertEqual(fish("wholehand stability wa"), ["wall"])
        self.assertEqual(fish("wholehand stability wall --fin"), ["--finger"])


if __name__ == "__main__":
    unittest.main()
