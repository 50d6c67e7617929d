#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What a view costs a session: wake-up latency and step time of `wholehand live` without a view and with 0, 1 and 4 viewers, in turns in one
run; frames that a viewer gets, and the processor time beyond that of a session without a view.

    tests/bench/view_timing.py [--rate HZ] [--seconds S] [--rounds N]

Prints a table, medians over the rounds (largest: of all rounds), and the time from `./wholehand live --view` to the first frame. Exits with 1
where one viewer costs 2 % of a core or more, one of any number gets fewer than 55 frames a second, the median or 99th percentile of latency or step is
more than 1.5 times and 10 us above what it is without a view, or the first frame takes 2 s or more. What else runs on the machine is seen in all rows.
"""
import argparse
import json
import os
import re
import socket
import statistics
import subprocess
import sys
import threading
import time

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
PROGRAM = os.path.join(ROOT, "build/default/wholehand")
START = b"\ndata: {\"t\""
KEYS = ("p50", "p99", "p999", "max")


def watch(port, token, counts):
    """Reads frames as they come, without a look at them."""
    with socket.create_connection(("127.0.0.1", port)) as viewer:
        viewer.sendall(f"GET /{token}/frames HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
        frames, began, ended, rest = 0, None, None, b""
        while part := viewer.recv(65536):
            frames += (rest + part).count(START)
            rest = (rest + part)[-len(START) + 1:]
            ended = time.monotonic()
            began = began or ended
        counts.append((frames, ended - began if began else 0))


def address_of(process):
    """Port and token, once they are printed."""
    while not (found := re.match(r"view: http://127\.0\.0\.1:(\d+)/(\w+)/", line := process.stderr.readline())):
        if not line:
            sys.exit("it told no address")
    return int(found[1]), found[2]


def first_frame():
    """Seconds from the start of the launcher to the first frame that a viewer has."""
    began = time.monotonic()
    process = subprocess.Popen([os.path.join(ROOT, "wholehand"), "live", "--view", "--json", "--seconds", "3"], stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
    port, token = address_of(process)
    with socket.create_connection(("127.0.0.1", port)) as viewer:
        viewer.sendall(f"GET /{token}/frames HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
        text = b""
        while START not in text and (part := viewer.recv(65536)):
            text += part
    took = time.monotonic() - began
    process.wait()
    return took


def session(rate, seconds, viewers):
    """Report, frames per second of each viewer, and processor seconds a second; `viewers` None: no view."""
    command = [PROGRAM, "live", "--json", "--rate", str(rate), "--seconds", str(seconds)] + ([] if viewers is None else ["--view"])
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    counts, threads = [], []
    if viewers is not None:
        port, token = address_of(process)
        for _ in range(viewers):
            threads.append(threading.Thread(target=watch, args=(port, token, counts)))
            threads[-1].start()
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    for thread in threads:
        thread.join()
    if status != 0:
        sys.exit(f"live ended with {status}")
    return json.loads(text), [frames / max(length, 1e-9) for frames, length in counts], (usage.ru_utime + usage.ru_stime) / seconds


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--rate", type=int, default=1000)
    options.add_argument("--seconds", type=int, default=10)
    options.add_argument("--rounds", type=int, default=5)
    asked = options.parse_args()
    rows = {None: [], 0: [], 1: [], 4: []}
    for _ in range(asked.rounds):
        for viewers, row in rows.items():
            row.append(session(asked.rate, asked.seconds, viewers))
    middle = lambda row, name, key: (max if key == "max" else statistics.median)(report[name][key] * 1e6 for report, _, _ in row)
    cpu = {viewers: statistics.median(load for _, _, load in row) for viewers, row in rows.items()}
    print(f"{asked.rate} Hz, {asked.rounds} rounds of {asked.seconds} s each; us")
    print(f"{'':12}{'latency p50':>12}{'p99':>8}{'p99.9':>8}{'largest':>9}{'step p50':>10}{'p99':>8}{'p99.9':>8}{'largest':>9}{'missed':>8}{'frames/s':>10}{'% of a core':>13}")
    holds = True
    for viewers, row in rows.items():
        line = f"{'no view' if viewers is None else f'{viewers} viewers':12}"
        for name, widths in (("latency_s", (12, 8, 8, 9)), ("step_s", (10, 8, 8, 9))):
            for key, width in zip(KEYS, widths):
                line += f"{middle(row, name, key):>{width}.1f}"
                if key in ("p50", "p99"):
                    alone = middle(rows[None], name, key)
                    holds = holds and middle(row, name, key) <= max(1.5 * alone, alone + 10)
        rates = [rate for _, found, _ in row for rate in found]
        line += f"{statistics.median(report['missed'] for report, _, _ in row):>8.0f}"
        line += f"{statistics.median(rates):>10.1f}" if rates else f"{'-':>10}"
        line += f"{100 * cpu[viewers]:>8.2f}" + (f" (+{100 * (cpu[viewers] - cpu[None]):.2f})" if viewers is not None else "")
        print(line)
        if rates:
            holds = holds and statistics.median(rates) >= 55
    holds = holds and cpu[1] - cpu[None] < 0.02
    first = statistics.median(first_frame() for _ in range(asked.rounds))
    print(f"from ./wholehand live --view to the first frame: {first:.2f} s")
    holds = holds and first < 2
    print("holds" if holds else "does not hold")
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
