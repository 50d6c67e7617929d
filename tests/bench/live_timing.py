#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Wake-up latency and step time of `wholehand live` beside cyclictest (Debian's rt-tests), in turns in one run.

    tests/bench/live_timing.py [--rate HZ] [--seconds S] [--rounds N] [--haply STAND_IN]

Each round measures both on an idle machine and with every other core loaded, all on core 0. Latency: from the moment a tick was due until
the thread ran. Prints a table in microseconds; exits with 1 where the loop's median or 99th percentile of the latency is more than 1.5
times cyclictest's (by the medians over the rounds), or the step's 99.9th percentile is 50 us or more. Beyond the 99th percentile both see
what else runs on the machine, on a shared one much more than the loop itself: shown, and not judged.

With --haply, the program tests/stand_in_haply_service of a build folder, it compares sessions of Haply's devices with the simulated user's
instead: in turns, the devices doing what that user does, on all cores, because the thread that speaks with the service is not the loop's. Exits
with 1 where the step's 99.9th percentile is more than 1.2 times the user's. On a machine that is shared, either varies by a factor of three.
"""
import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

PROGRAM = os.environ.get("WHOLEHAND_PROGRAM") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../wholehand")
KEYS = ("p50", "p99", "p999", "max")
ON_CORE = ["taskset", "-c", "0"]
PRIORITY = "80"  # of both


def quantile(counts, share):
    """Upper end of the microsecond that `share` of all counts do not exceed."""
    total, passed = sum(counts.values()), 0
    for microseconds in sorted(counts):
        passed += counts[microseconds]
        if passed >= share * total:
            return microseconds + 1
    return float("nan")


def cyclictest(rate, seconds):
    command = ["cyclictest", "-q", "-m", "-t1", "-p", PRIORITY, "-i", str(round(1e6 / rate)), "-D", str(seconds), "-h", "20000"]
    text = subprocess.run(ON_CORE + command, check=True, capture_output=True, text=True).stdout
    counts = {int(at): int(n) for at, n in re.findall(r"^(\d+)\s+(\d+)$", text, re.M) if int(n) > 0}
    largest = max([max(counts)] + [int(x) for x in re.findall(r"# Max Latencies: (\d+)", text)])
    return {"p50": quantile(counts, 0.5), "p99": quantile(counts, 0.99), "p999": quantile(counts, 0.999), "max": largest}


def live(rate, seconds, *device, cores=ON_CORE):
    command = [PROGRAM, "live", "--json", "--rate", str(rate), "--seconds", str(seconds), *device]
    report = json.loads(subprocess.run(cores + command, check=True, capture_output=True, text=True).stdout)
    for note in report["notes"]:
        print("note:", note)
    times = lambda name: {key: report[name][key] * 1e6 for key in KEYS}
    return times("latency_s"), times("step_s")


def loaded(work):
    """`work` while every core but the first is busy."""
    others = [subprocess.Popen(["taskset", "-c", str(core), "sh", "-c", "while :; do :; done"]) for core in range(1, os.cpu_count())]
    try:
        return work()
    finally:
        for other in others:
            other.kill()
            other.wait()


def simulated_motion(seconds, folder):
    """File of what the simulated user does, for the stand-in, after a way there from where the tips were calibrated; its length, s."""
    way, step = 1.5, 20  # s, ticks
    recording, motion = os.path.join(folder, "sim.nc"), os.path.join(folder, "motion.txt")
    subprocess.run([PROGRAM, "live", "--no-clock", "--seconds", str(seconds), "--record", recording], check=True, capture_output=True)
    text = subprocess.run(["ncdump", "-p", "9,17", "-v", "device_position,device_rotation,device_gap", recording], check=True,
                          capture_output=True, text=True).stdout
    head, data = text.split("\ndata:\n")
    closed = float(re.search(r":device_gap_m = ([^,]+),", head)[1])
    numbers = {name: [float(x) for x in re.search(rf" {name} =(.*?);", data, re.S)[1].split(",")]
               for name in ("device_position", "device_rotation", "device_gap")}
    with open(motion, "w", encoding="ascii") as file:
        file.write("0 0 0 0 1 0 0 0\n")
        for tick in range(0, len(numbers["device_gap"]) - 1, step):
            pose = numbers["device_position"][3 * tick:3 * tick + 3] + numbers["device_rotation"][9 * tick:9 * tick + 9:3]
            print(way + tick / 1000, *pose, max(numbers["device_gap"][tick] - closed, 0), file=file)
    return motion, way


def with_haply(stand_in, motion, work):
    """`work` with the address of a service, on other cores than the loop's if there are any, and not kept waiting by what else runs there."""
    others = ["chrt", "-f", "60"] + (["taskset", "-c", f"1-{os.cpu_count() - 1}"] if os.cpu_count() > 1 else [])
    service = subprocess.Popen(others + [stand_in, "--play", motion], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        return work("haply:" + service.stdout.readline().strip())
    finally:
        service.stdin.close()
        service.wait()


def compare_haply(asked):
    rows = {"sim step": [], "haply step": []}
    with tempfile.TemporaryDirectory() as folder:
        motion, way = simulated_motion(asked.seconds, folder)
        rest, tries = 1, 5  # s that the stand-in rests after the calibration; sessions, as a fault ends one in which the machine stood still for 10 ms
        for _ in range(asked.rounds):
            rows["sim step"].append(live(asked.rate, asked.seconds, cores=[])[1])
            for left in reversed(range(tries)):
                try:
                    rows["haply step"].append(with_haply(asked.haply, motion, lambda place: live(
                        asked.rate, asked.seconds + way + rest, "--device", place, cores=[]))[1])
                    break
                except subprocess.CalledProcessError as error:
                    print("again:", error.stderr.splitlines()[-1])
                    if left == 0:
                        raise
    middle = {name: {key: (max if key == "max" else statistics.median)(row[key] for row in found) for key in KEYS} for name, found in rows.items()}
    for name, found in middle.items():
        print(f"{'':10}{name:22}" + "".join(f"{found[key]:>{9 if key == 'max' else 8}.1f}" for key in KEYS))
    ratio = middle["haply step"]["p999"] / middle["sim step"]["p999"]
    print(f"{'':10}ratio at 99.9 %: {ratio:.2f}")
    return ratio <= 1.2


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--rate", type=int, default=1000)
    options.add_argument("--seconds", type=int, default=10)
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("--haply", metavar="STAND_IN")
    asked = options.parse_args()
    if asked.haply:
        print(f"{asked.rate} Hz, {asked.rounds} rounds of {asked.seconds} s each; medians over the rounds, us (largest: of all rounds)")
        print(f"{'':10}{'':22}{'p50':>8}{'p99':>8}{'p99.9':>8}{'largest':>9}")
        holds = compare_haply(asked)
        print("holds" if holds else "does not hold")
        return 0 if holds else 1
    for tool in ("cyclictest", "taskset"):
        if not shutil.which(tool):
            sys.exit(f"{tool} is missing: apt-get install rt-tests util-linux")
    holds = True
    print(f"{asked.rate} Hz, {asked.rounds} rounds of {asked.seconds} s each; medians over the rounds, us (largest: of all rounds)")
    print(f"{'':10}{'':22}{'p50':>8}{'p99':>8}{'p99.9':>8}{'largest':>9}")
    for load, run in (("idle", lambda work: work()), ("loaded", loaded)):
        rows = {"cyclictest latency": [], "live latency": [], "live step": []}
        for _ in range(asked.rounds):
            rows["cyclictest latency"].append(run(lambda: cyclictest(asked.rate, asked.seconds)))
            latency, step = run(lambda: live(asked.rate, asked.seconds))
            rows["live latency"].append(latency)
            rows["live step"].append(step)
        middle = {name: {key: (max if key == "max" else statistics.median)(row[key] for row in found) for key in KEYS} for name, found in rows.items()}
        for name, found in middle.items():
            print(f"{load:10}{name:22}" + "".join(f"{found[key]:>{9 if key == 'max' else 8}.1f}" for key in KEYS))
        ratios = {key: middle["live latency"][key] / middle["cyclictest latency"][key] for key in KEYS}
        print(f"{load:10}{'ratio of latencies':22}" + "".join(f"{ratios[key]:>{9 if key == 'max' else 8}.2f}" for key in KEYS))
        holds = holds and ratios["p50"] <= 1.5 and ratios["p99"] <= 1.5 and middle["live step"]["p999"] < 50
    print("holds" if holds else "does not hold")
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
