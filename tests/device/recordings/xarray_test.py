# SPDX-License-Identifier: MIT
"""Opens a recording with xarray and selects by name, as its users do: xarray_test.py RECORDING.nc VESSEL"""

import sys

import xarray as xr


def main():
    with xr.open_dataset(sys.argv[1]) as data:
        for name in ["vessel", "liquid", "contact", "xyz"]:
            if data[name].dtype.kind not in "UO":
                sys.exit(f"{name}: {data[name].dtype}, not text")
        vessel = data.sel(vessel=sys.argv[2])
        if str(vessel["vessel"].values) != sys.argv[2] or vessel["force_range"].ndim != 0:
            sys.exit(f"{sys.argv[2]}: not selected by its name")
        if data.sel(contact="index", xyz="y")["coupling_force"].dims != ("tick",):
            sys.exit("a force is not selected by finger and direction")


main()
