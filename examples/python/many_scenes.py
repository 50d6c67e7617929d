# SPDX-License-Identifier: MIT
"""A Dask map over scenes: how wide a beaker may be for this hand."""

# %% One scene a radius. A scene is a dict, so it is easily changed.
import dask
import numpy as np
import wholehand as wh

RADII = np.arange(20, 56, 5)  # mm


def scene(radius: float) -> dict:
    outline = [{"line": [radius, 0]}, {"line": [radius, 100]}, {"line": [0, 100]}]
    return {
        "scene": {"name": f"r{radius}"},
        "vessel": [{"name": "beaker", "outline": outline, "wall_mm": 2}],
        "grips": {"height_mm": np.linspace(20, 90, 15), "roll_deg": np.linspace(-90, 20, 12)},
        "tilts": {"deg": [0, 45, 90]},
    }


# %% What is wanted of each. Threads are enough: sweeps wait for each other, as each uses all cores, and evaluate runs without the
# interpreter's lock. On a cluster the same function runs on other machines, as scenes and Datasets travel.
@dask.delayed
def best_score(radius: float) -> float:
    data = wh.sweep(scene(radius), on="core", best=0, keep=["score", "reason", "plausible"])
    return float(data.score.max())


scores = dask.compute(*[best_score(float(radius)) for radius in RADII], scheduler="threads")

# %% Very wide beakers leave the hand less and less to close.
for radius, score in zip(RADII, scores):
    print(f"radius {radius} mm: {score:.3f}")
assert max(scores) > 0.7 and scores[0] > 0 and min(scores) >= 0
