# SPDX-License-Identifier: MIT
"""The manual pages that are installed: one for every command, with all that its --help says, and without a warning of man."""

import filecmp
import glob
import os
import re
import subprocess
import tempfile
import unittest

from harness import PROGRAM, SOURCE, STAGED, all_commands, help_of, run

PAGES = os.path.join(STAGED, "usr/share/man/man1")
SCRIPT = os.path.join(SOURCE, "cmake/package/manual.sh")
WIDE = 1000  # columns: few lines are broken


def page_of(words):
    return os.path.join(PAGES, "-".join(("wholehand", *words)) + ".1.gz")


def man(path, columns=WIDE):
    environment = {"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8", "MANWIDTH": str(columns), "HOME": "/nonexistent"}
    return subprocess.run(["man", "--warnings=w", "-l", path], check=True, capture_output=True, text=True, env=environment)


class Manual(unittest.TestCase):
    def test_every_command_has_a_page_and_every_page_a_command(self):
        self.assertGreater(len(all_commands()), 15)
        self.assertEqual(sorted(glob.glob(PAGES + "/*")), sorted(page_of(words) for words in all_commands()))

    def test_pages_are_the_same_wherever_the_build_folder_lies(self):
        with tempfile.TemporaryDirectory(prefix="it's a folder ") as folder:
            os.symlink(os.path.realpath(PROGRAM), folder + "/a program")
            version = run("--version").split()[1]
            subprocess.run(["sh", SCRIPT, "a program", version, "man pages"], cwd=folder, check=True)
            for words in all_commands():
                theirs = folder + "/man pages/" + os.path.basename(page_of(words))
                self.assertTrue(filecmp.cmp(page_of(words), theirs, shallow=False), words)

    def test_no_page_makes_man_warn(self):
        for words in all_commands():
            self.assertEqual(man(page_of(words), columns=80).stderr, "", words)

    def test_pages_say_all_that_help_says(self):
        for words in all_commands():
            page = " ".join(man(page_of(words)).stdout.split()).replace("‐", "-").replace("’", "'").replace("‘", "`")
            entries = re.findall(r"^  (-\S+|[a-z][a-z-]*)(?: .*?)??(?: {2,}|\n {10,})(\S.*)$", help_of(*words), re.MULTILINE)
            self.assertGreater(len(entries), 0, words)
            for name, meaning in entries:
                self.assertIn(name.replace(",--", ", --"), page, words)
                self.assertIn(" ".join(meaning.split()), page, words)

    def test_pages_end_with_exit_codes_and_other_pages(self):
        for words in all_commands():
            page = man(page_of(words)).stdout
            codes = r"EXIT STATUS\n +0 +done\n\n +1 +the answer is no \(check; grip: not feasible\)\n\n +2 +wrong usage or input\n"
            self.assertRegex(page, codes, words)
            named = re.findall(r"(wholehand[a-z-]*)\(1\)", page.split("SEE ALSO")[1].replace("‐", "-").rsplit("\n", 2)[0])
            self.assertGreaterEqual(len(named), 1, words)
            for name in named:
                self.assertTrue(os.path.exists(f"{PAGES}/{name}.1.gz"), f"{words}: {name}(1)")


if __name__ == "__main__":
    unittest.main()
