#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What advice costs a session: wake-up latency and step time of `wholehand live` without and with `--advise`, in turns in one run; updates a
second, and the longest time between two.

    tests/bench/advice_timing.py [--rate HZ] [--seconds S] [--rounds N] [--on DEVICE ...]

Prints a table, medians over the rounds (largest: of all rounds). `stress` is a session without advice beside as many busy processes of the
advice's own priority as there are cores: what any such load costs on this machine. Exits with 1 where the median or 99th percentile of latency
or step with advice is more than 1.5 times and 10 us above what it is without, or where there are fewer than 5 updates a second (the median).
The last line names these; nothing else of the table is judged.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
PROGRAM = os.path.join(ROOT, "build/default/wholehand")
KEYS = ("p50", "p99", "p999", "max")
NICENESS = 10  # of the advice's threads


def busy():
    """A process that does nothing but compute."""
    return subprocess.Popen([sys.executable, "-c", "while True: pass"], preexec_fn=lambda: os.nice(NICENESS))


def session(rate, seconds, row):
    """The report of one session."""
    more = [] if row in ("without", "stress") else ["--advise", "--advise-on", row]
    others = [busy() for _ in range(os.cpu_count())] if row == "stress" else []
    try:
        done = subprocess.run([PROGRAM, "live", "--json", "--rate", str(rate), "--seconds", str(seconds), *more], capture_output=True, text=True)
    finally:
        for other in others:
            other.kill()
            other.wait()
    if done.returncode:
        sys.exit(f"live ended with {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--rate", type=int, default=1000)
    options.add_argument("--seconds", type=int, default=20)
    options.add_argument("--rounds", type=int, default=3)
    options.add_argument("--on", nargs="+", default=["core", "vulkan"])
    asked = options.parse_args()
    rows = {name: [] for name in ["without", *asked.on, "stress"]}
    for _ in range(asked.rounds):
        for name, row in rows.items():
            row.append(session(asked.rate, asked.seconds, name))
    middle = lambda row, name, key: (max if key == "max" else statistics.median)(report[name][key] * 1e6 for report in row)
    print(f"{asked.rate} Hz, {asked.rounds} rounds of {asked.seconds} s each; us")
    print(f"{'':10}{'latency p50':>12}{'p99':>8}{'p99.9':>8}{'largest':>9}{'step p50':>10}{'p99':>8}{'p99.9':>8}{'largest':>9}{'missed':>8}"
          f"{'updates/s':>11}{'grips':>7}{'longest s':>11}")
    holds = True
    for name, row in rows.items():
        line = f"{name:10}"
        for part, widths in (("latency_s", (12, 8, 8, 9)), ("step_s", (10, 8, 8, 9))):
            for key, width in zip(KEYS, widths):
                line += f"{middle(row, part, key):>{width}.1f}"
                alone = middle(rows["without"], part, key)
                if key in ("p50", "p99") and name in asked.on:
                    holds = holds and middle(row, part, key) <= max(1.5 * alone, alone + 10)
        line += f"{statistics.median(report['missed'] for report in row):>8.0f}"
        if name in asked.on:
            advice = [report["advice"] for report in row]
            rates = statistics.median(one["updates_per_s"] for one in advice)
            line += f"{rates:>11.1f}{sum(one['grips'] for one in advice) / sum(one['updates'] for one in advice):>7.0f}{max(one['longest_s'] for one in advice):>11.2f}"
            holds = holds and rates >= 5
        print(line)
    judged = f"latency and step at p50 and p99, and updates a second, of {', '.join(asked.on)}; not p99.9, largest, missed, grips, longest"
    print(f"{'holds' if holds else 'does not hold'}: {judged}")
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
