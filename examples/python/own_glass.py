# SPDX-License-Identifier: MIT
"""Your own glass, your own score, your own plot: which grips of a wine glass let many points of the hand touch it."""

# %% A scene is a dict with the keys of docs/scene.md. The outline is half of the glass, [r, y] in mm, from the base to the mouth.
import matplotlib

matplotlib.use("Agg")  # in a notebook, leave this line out
import matplotlib.pyplot as plt
import numpy as np
import wholehand as wh

outline = [(34, 0), (34, 2), (6, 9), (5, 70), (36, 110), (37, 135), (32, 165), (0, 165)]
scene = wh.scene(
    {
        "scene": {"name": "wine_glass"},
        "vessel": [
            {
                "name": "glass",
                "outline": [{"line": list(point)} for point in outline],
                "inner_outline": [{"line": [0, 78]}, {"line": [33, 110]}, {"line": [34, 135]}, {"line": [29.5, 165]}],
                "density_kg_m3": 2500,
            }
        ],
        "liquid": {"fills": [0, 0.4]},
        "grips": {"height_mm": np.linspace(40, 150, 23), "roll_deg": np.linspace(-90, 15, 8), "obliquity_deg": [-10, 0, 10]},
        "tilts": {"deg": [0, 30, 60]},
        "table": {},
    }
)

# %% Every grip, as a Dataset.
data = wh.sweep(scene, on="core")
print(f"{int((data.reason == 0).sum())} of {data.reason.size} grips are feasible, {int((data.plausible == 1).sum())} plausible")

# %% Your own score: many points that touch, little force, and no joint deep in the glass.
own = data.points_touching / 24 - 0.05 * data.peak_feedback_force.max("fill") - 50 * data.phalanx_depth
best = wh.best(data, n=3, apart_mm=25, by=own)
for k in range(best.sizes["grip"]):
    one = best.isel(grip=k)
    print(
        f"{float(one.height) * 1e3:.0f} mm, roll {np.degrees(float(one['roll'])):.0f} deg: {int(one.points_touching)} points touch"
    )
assert best.sizes["grip"] >= 1

# %% Your own plot: how much of the hand touches at each height and roll.
touching = data.points_touching.where(data.plausible == 1).max(["obliquity", "azimuth", "offset", "hand_scale"]).isel(vessel=0)
figure, axes = plt.subplots()
mesh = axes.pcolormesh(1e3 * data.height, np.degrees(data["roll"]), touching.transpose("roll", "height"), shading="nearest")
figure.colorbar(mesh, label="points that touch")
axes.set(xlabel="height, mm", ylabel="roll, deg")
figure.savefig("own_glass.png")

# %% The best grip with everything, and its drawing. A notebook shows the drawing of `grip` by itself.
grip = wh.grip(scene, "glass", at=best.isel(grip=0))
grip.svg("own_glass.svg")
grip.glb("own_glass.glb")
print(repr(grip), grip["fingers_used"])
