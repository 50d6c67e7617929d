#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Plants faults, one at a time, and says which test finds each.

    tests/bench/planted_faults.py [--seed N] [--faults N] [--from PLACE [--skip N]] [--later] [--list]

Each fault lies in another folder of the product: a statement of one of its files, changed in its sign, bound, index or order. Folders, files and
statements are drawn by the seed. What does not compile is drawn again. Run it in a clone of its own, where `./wholehand test` has passed: it
edits the sources and puts them back. --later asks the later tier too where the fast one finds nothing. A fault that nothing finds is either
equivalent or lacks a test.
"""

import argparse
import pathlib
import random
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "default"
NO_PRODUCT = {"build", "cmake", "docs", "examples", "tests"}
# What a changed line may not be: no statement, or a text that is printed.
PASSED_BY = re.compile(r'^\s*(//|\*|/\*|#|using |template|namespace |static_assert|"|layout\()|operator|"""')
# An assignment or a call: what comes after it may depend on it.
STATEMENT = re.compile(r"^ +(\w+)[\w.\[\]]*( [+*/-]?= |(\.|->)\w+\(|\().*;$")
CHANGES = {
    "sign": [(r" \+ ", " - "), (r" - ", " + "), (r"(return|=|\(|,) -(?=[a-z(])", r"\1 "), (r" \+= ", " -= ")],
    "bound": [(r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > ")],
    "index": [(r"\[0\]", "[1]"), (r"\[1\]", "[0]"), (r"\[2\]", "[1]"), (r"\[(\w+) [+-] 1\]", r"[\1]"), (r"(?<=[a-z] = )0(?=; \w+ <)", "1")],
    "order": [(r"(?<=[a-z])\(([\w.]+), ([\w.]+)(?=[,)])", r"(\2, \1")],
}


def folders():
    """Folders of the product with code, and their files."""
    found = {}
    for path in sorted(ROOT.rglob("*")):
        folder = path.parent.relative_to(ROOT).as_posix()
        if path.suffix in {".cpp", ".h", ".comp", ".glsl", ".py"} and folder.split("/")[0] not in NO_PRODUCT and path.parent != ROOT:
            found.setdefault(folder, []).append(path)
    return found


def changes_of(path):
    """Every change of a file: (kind, number of the line, the line changed)."""
    lines = path.read_text(encoding="utf-8").split("\n")
    for number, line in enumerate(lines):
        code = line.split(" //")[0]
        if PASSED_BY.search(line) or not code.strip():
            continue
        for kind, rules in CHANGES.items():
            for pattern, replacement in rules:
                for match in re.finditer(pattern, code):
                    if code[: match.start()].count('"') % 2 == 0:
                        yield kind, number, line[: match.start()] + match.expand(replacement) + line[match.end() :]
    for number in range(len(lines) - 1):  # two statements of a block, exchanged
        first, second = lines[number], lines[number + 1]
        indent = len(first) - len(first.lstrip())
        set_first = STATEMENT.match(first)
        if set_first and STATEMENT.match(second) and re.search(rf"\b{set_first[1]}\b", second) and len(second) - len(second.lstrip()) == indent:
            yield "order", number, second + "\n" + first


def draws(seed):
    """The folders in drawn order, each with its endless draws (path, kind, number, text)."""
    found = folders()
    order = sorted(found)
    random.Random(seed).shuffle(order)

    def of_folder(folder):
        chance = random.Random(f"{seed} {folder}")
        while True:
            path = chance.choice(found[folder])
            kind = chance.choice(sorted(CHANGES))
            possible = [change for change in changes_of(path) if change[0] == kind]
            if possible:
                yield (path, *chance.choice(possible))

    return [(folder, of_folder(folder)) for folder in order]


def ctest(*args):
    """The tests that fail, by name: empty if all pass."""
    done = subprocess.run(["ctest", "-j2", "--stop-on-failure", *args], cwd=BUILD, capture_output=True, text=True)
    return re.findall(r"\d+ - (\S+) \(", done.stdout.split("The following tests FAILED")[1]) if done.returncode else []


def own_suites(folder):
    """The suites of a folder's tests, as a pattern: they find most of its faults, in seconds."""
    names = set()
    for path in (ROOT / "tests" / folder).glob("*.cpp"):
        names |= set(re.findall(r"^TEST(?:_F|_P)?\((\w+),", path.read_text(encoding="utf-8"), re.MULTILINE))
    return "^(" + "|".join(sorted(names)) + ")$"


def judge(path, number, text, later):
    """What finds the change: a line of the table, or None where it does not compile."""
    before = path.read_text(encoding="utf-8")
    lines = before.split("\n")
    lines[number : number + text.count("\n") + 1] = text.split("\n")
    try:
        path.write_text("\n".join(lines), encoding="utf-8")
        if subprocess.run(["ninja", "-C", BUILD], capture_output=True).returncode:
            return None
        fast = ["-LE", "later"]
        tiers = [("fast", [*fast, "-R", own_suites(path.parent.relative_to(ROOT).as_posix())]), ("fast", fast), ("later", ["-L", "later"])]
        for tier, args in tiers[: 3 if later else 2]:
            if names := ctest(*args):
                return f"{tier}: {names[0]}"
        return "found by neither" if later else "not by the fast tier"
    finally:
        path.write_text(before, encoding="utf-8")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--seed", type=int, default=47)
    options.add_argument("--faults", type=int, default=20)
    options.add_argument("--from", type=int, default=1, dest="begin", help="the first place to plant")
    options.add_argument("--skip", type=int, default=0, help="draws of that place to pass by: equivalent ones")
    options.add_argument("--later", action="store_true")
    options.add_argument("--list", action="store_true", help="print the first draw of each place, and plant nothing")
    given = options.parse_args()
    for place, (_, drawn) in enumerate(draws(given.seed)[: given.faults], start=1):
        if place < given.begin:
            continue
        for _ in range(given.skip if place == given.begin else 0):
            next(drawn)
        for path, kind, number, text in drawn:
            answer = "-" if given.list else judge(path, number, text, given.later)
            if answer is not None:
                print(f"{place} | {path.relative_to(ROOT)}:{number + 1} | {kind} | `{text.strip()}` | {answer}", flush=True)
                break
    if not given.list:
        subprocess.run(["ninja", "-C", BUILD], capture_output=True, check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
