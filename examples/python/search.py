# SPDX-License-Identifier: MIT
"""A search for the best grip with scipy.optimize over wh.evaluate, which takes a whole population at once."""

# %% What is searched: height, obliquity, roll and offset of a grip of a beaker, within these ends.
import numpy as np
import wholehand as wh
from scipy.optimize import differential_evolution

scene = wh.scene("three_beakers")
names = ["height", "obliquity", "roll", "offset"]
asked: list[int] = []
bounds = [(0.01, 0.10), np.radians((-20, 20)), np.radians((-90, 30)), (-0.01, 0.01)]


# %% scipy hands over one grip a column. All of them are evaluated at once, on all cores.
def cost(columns: np.ndarray) -> np.ndarray:
    asked.append(columns.shape[1])
    return -wh.evaluate(scene, "beaker1", dict(zip(names, columns)), "score")["score"]


found = differential_evolution(cost, bounds, vectorized=True, updating="deferred", seed=1, popsize=12, maxiter=15, polish=False)

# %% The same within a grid of the same ends, for comparison.
axes = [np.linspace(low, high, 7) for low, high in bounds]
grid = np.array([axis.ravel() for axis in np.meshgrid(*axes)])
searched = sum(asked)
on_grid = -cost(grid).min()
print(f"search: {-found.fun:.4f} after {searched} grips; grid of {grid.shape[1]}: {on_grid:.4f}")
assert -found.fun > 0.85

# %% What it is.
grip = wh.grip(scene, "beaker1", at={name: [value] for name, value in zip(names, found.x)})
print(repr(grip), grip["fingers_used"])
assert abs(grip.score + found.fun) < 1e-12  # the same arithmetic, whether one grip is asked for or many
