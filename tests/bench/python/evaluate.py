# SPDX-License-Identifier: MIT
"""What wh.evaluate costs over the C++ call for the same variables: evaluate.py WHOLEHAND_EVALUATE [GRIPS [TURNS]]

Both evaluate the same grips on the core, in turns. The first ratio is that of the least CPU time of either side: other work on the
machine adds to the wall time of both, and to neither's least CPU time. Needs the package on the path, and the program of evaluate.cpp.
"""

import resource
import subprocess
import sys
import tempfile
import time

import numpy as np
import wholehand as wh

SETS = {
    "score": ["score"],
    "default reals": ["score", "closure", "gap", "phalanx_depth", "palm_depth", "contact_angles", "peak_feedback_force"],
    "points": ["joints", "posed", "proxies", "separation"],
}


def cpu():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def finite_sum(values):
    """In the order of the C++ side: one number after the other."""
    return sum(float(np.add.reduce(np.where(np.isfinite(one), one, 0).ravel())) for one in values)


def main():
    program, count, turns = sys.argv[1], int((sys.argv[2:] + ["1000000"])[0]), int((sys.argv[3:] + ["3"])[0])
    random = np.random.default_rng(1)
    low, high = np.array([0.005, 0, -0.35, -1.57, -0.01, 0.9]), np.array([0.09, 0, 0.35, 0.5, 0.01, 1.1])
    grips = low + (high - low) * random.random((count, 6))
    scene = wh.scene("three_beakers")
    with tempfile.NamedTemporaryFile(suffix=".f64") as file:
        grips.tofile(file.name)
        for label, names in SETS.items():
            command = [program, "three_beakers", "beaker1", ",".join(names), file.name]
            with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1) as child:
                wh.evaluate(scene, "beaker1", grips[:1000], names, on="core")  # opened, as the other side is
                python, cxx = [], []
                for _ in range(turns):
                    child.stdin.write("\n")
                    wall, used, total = map(float, child.stdout.readline().split())
                    cxx.append((used, wall))
                    wall, used = time.monotonic(), cpu()
                    found = wh.evaluate(scene, "beaker1", grips, names, on="core")
                    python.append((cpu() - used, time.monotonic() - wall))
                    own = finite_sum(found.values())
                    assert abs(own - total) <= 1e-9 * abs(total), (own, total)  # sums of 1e8 numbers, in two orders
                    del found
                child.stdin.close()
            least = [min(side) for side in zip(*python)], [min(side) for side in zip(*cxx)]
            (own_cpu, own_wall), (cxx_cpu, cxx_wall) = least
            print(f"{label}: {count} grips")
            print(f"  CPU:  {own_cpu:.3f} s in Python, {cxx_cpu:.3f} s in C++, ratio {own_cpu / cxx_cpu:.4f}")
            print(f"  wall: {own_wall:.3f} s in Python, {cxx_wall:.3f} s in C++, ratio {own_wall / cxx_wall:.4f}", flush=True)


main()
