# SPDX-License-Identifier: MIT
"""Opens a result file as its users do, with xarray, and checks that it explains itself: xarray_test.py RESULT.nc"""

import sys

import numpy as np
import xarray as xr

GRIP_AXES = ["azimuth", "obliquity", "roll", "offset", "hand_scale", ("height", "height_fraction")]
UNITS = {"m", "rad", "1", "N", "N m", "kg", "m3"}


def check(what, is_true):
    if not is_true:
        sys.exit(f"{sys.argv[1]}: {what}")


def check_attributes(data):
    for name in ["Conventions", "title", "program", "version", "scene", "backend", "device", "driver", "precision", "seed"]:
        check(f"attribute {name}", name in data.attrs)
    check("wall time", float(data.attrs["wall_time_s"]) > 0)
    for name, variable in data.variables.items():
        check(f"{name}: long_name", variable.attrs.get("long_name"))
        if variable.dtype.kind != "O":
            check(f"{name}: units", variable.attrs.get("units") in UNITS)
        if variable.dtype.kind == "f":
            check(f"{name}: _FillValue", "_FillValue" in variable.encoding)


def check_dimensions(data, score):
    is_sobol = data.attrs["sampling"] == "sobol"
    check("dimensions of the score", score.dims[0] == "vessel" and len(score.dims) == (2 if is_sobol else 7))
    for k, axis in enumerate(GRIP_AXES):
        names = axis if isinstance(axis, tuple) else (axis,)
        found = [name for name in names if name in score.coords and data[name].ndim == 1]
        check(f"coordinate {axis}", len(found) == 1)
        check(f"dimension {axis}", is_sobol or score.dims[k + 1] == found[0])


def check_missing_values(data, score, feasible):
    """What an infeasible grip lacks is missing, what every grip has is not."""
    check("a reason for every grip, a whole number", data["reason"].dtype.kind == "i")
    check("a score for every grip", not np.isnan(score.values).any())
    check("no score where infeasible", (score.values[~feasible] == 0).all())
    check("closure where feasible", np.array_equal(~np.isnan(data["closure"].values), feasible))
    check("fingers used where feasible", np.array_equal(~np.isnan(data["fingers_used"].values), feasible))
    meanings = data["reason"].attrs["flag_meanings"].split()
    check("a meaning for every reason", len(meanings) == len(data["reason"].attrs["flag_values"]))


def check_score_terms(data, score):
    """The score is the weighted sum of its terms."""
    weights, terms = score.attrs["score_weights"], score.attrs["score_terms"].split()
    total = sum(w * data[term].values for w, term in zip(weights, terms) if term in data)
    plausible = data["plausible"].values == 1
    if data.attrs["device"] != "fake device":
        check("score and terms", np.allclose(score.values[plausible], total[plausible], atol=1e-6))


def check_masks(data, feasible):
    """Masks are whole numbers, and an infeasible grip has no bit."""
    masks = [name for name in data.data_vars if name.endswith("_mask")]
    check("masks", "touch_mask" in masks and "used_mask" in masks)
    for name in masks:
        mask = data[name]
        check(f"{name}: whole numbers", mask.dtype.kind == "i")
        check(f"{name}: no bits where infeasible", (mask.values[~feasible] == 0).all())
        check(f"{name}: names of the bits", len(mask.attrs["flag_masks"]) == len(mask.attrs["flag_meanings"].split()))
    bits = sum(((data.touch_mask & int(bit)) != 0).astype(int) for bit in data.touch_mask.attrs["flag_masks"])
    check("bits of the touch mask", (bits.values[feasible] == data["points_touching"].values[feasible]).all())


def check_coordinates(data, score):
    """Coordinates that are no dimensions."""
    check("height in m", data["height"].dims[0] == "vessel" and "height" in score.coords)
    spans = data["vessel_height"] - data["vessel_base"]
    check("its values", np.allclose(data["height"], data["vessel_base"] + data["height_fraction"] * spans))
    check("radii of the joints", "joint_radius" in data.coords and data["joint_radius"].dims == ("joint",))
    check("ranks", list(data["rank"].values) == list(range(1, data.sizes["rank"] + 1)) and data["rank"].dtype.kind == "i")
    check("fills", {"fill_fraction", "fill_volume"} <= set(data["peak_feedback_force"].coords))
    check("volumes", np.allclose(data["fill_volume"], data["fill_fraction"] * data["capacity"]))
    check("the best grip's place is a whole number", data["best_grip"].dtype.kind == "i")


def check_best_grips(data, score):
    """Selects by name and value, and finds the best grips in their place."""
    best = data["best_grip"].isel(vessel=0).sel(rank=1)
    check("the best score", float(score.isel(vessel=0).max()) == float(data["best_score"].isel(vessel=0, rank=0)))
    check("its place", score.isel(vessel=0).values.ravel()[int(best)] == float(data["best_score"].isel(vessel=0, rank=0)))
    check("its roll", float(data["best_roll"].isel(vessel=0, rank=0)) in data["roll"].values)
    check("a vessel by its name", score.sel(vessel=str(data["vessel"].values[0])).ndim == score.ndim - 1)
    check("the joints' names", str(data["joint"].values[8]) == "index_tip")


def main():
    with xr.open_dataset(sys.argv[1]) as data:
        score, feasible = data["score"], (data["reason"] == 0).values
        check_attributes(data)
        check_dimensions(data, score)
        check_missing_values(data, score, feasible)
        check_score_terms(data, score)
        check_masks(data, feasible)
        check_coordinates(data, score)
        check_best_grips(data, score)


main()
