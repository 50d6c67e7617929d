# SPDX-License-Identifier: MIT
"""Many grips, some variables."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import Error, warn
from ._scene import SceneLike, check_types, names_of, scene as as_scene, vessel_number

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

_COLUMNS: tuple[str, ...] = _core.GRIP_COLUMNS
_DEFAULTS = (None, 0.0, 0.0, 0.0, 0.0, 1.0)  # of a column that is not given
_IN_UNITS = ("height_mm", "azimuth_deg", "obliquity_deg", "roll_deg", "offset_mm")  # a scene file's names of columns


def grip_dtype() -> np.dtype[np.void]:
    """``wh.GRIP``, the structured dtype of grips: height (m), azimuth, obliquity, roll (rad), offset (m), hand_scale."""
    import numpy as np

    return np.dtype([(name, np.float64) for name in _COLUMNS])


def _array(name: str, values: Any) -> npt.NDArray[Any]:
    """Raises Error for what NumPy makes no array of, and for a masked one, whose mask would be lost."""
    import numpy as np

    if isinstance(values, np.ma.MaskedArray):
        raise Error(f"grips: {name} is a masked array; allowed: plain arrays, say one of .compressed()")
    try:
        return np.asarray(values)
    except (TypeError, ValueError):
        raise Error(f"grips: {name} makes no array ({type(values).__name__}); allowed: rows of one length") from None


def _numbers(name: str, values: Any) -> npt.NDArray[np.float64]:
    """Doubles as they lie, where they are doubles; else copied."""
    import numpy as np

    array = _array(name, values)
    if array.dtype.kind not in "fiu":
        raise Error(f"grips: {name} is {array.dtype}; allowed: real numbers")
    return np.asarray(array, dtype=np.float64)


def _of_fields(given: Mapping[str, Any]) -> list[npt.NDArray[np.float64]]:
    """A column each, those that are missing repeated without room (stride 0)."""
    import numpy as np

    unknown = [name for name in given if name not in _COLUMNS and name not in _IN_UNITS]
    if unknown:
        raise Error(f"grips: no column {', '.join(map(repr, unknown))}; allowed: {', '.join([*_COLUMNS, *_IN_UNITS])}")
    given = dict(given)
    for name in _IN_UNITS:
        if name not in given:
            continue
        column, _, unit = name.partition("_")
        if column in given:
            raise Error(f"grips: both {column} and {name} are given; allowed: one of the two")
        numbers = _numbers(name, given.pop(name))
        given[column] = numbers / 1e3 if unit == "mm" else numbers * (math.pi / 180)
    if "height" not in given:
        raise Error("grips: the column 'height' is missing (or 'height_mm'); the others have defaults")
    columns = [_numbers(name, given.get(name, default)) for name, default in zip(_COLUMNS, _DEFAULTS)]
    try:
        shape = np.broadcast_shapes(*(column.shape for column in columns))
    except ValueError:
        lengths = ", ".join(f"{name} {column.shape}" for name, column in zip(_COLUMNS, columns))
        raise Error(f"grips: the columns have different shapes: {lengths}") from None
    if len(shape) > 1:
        raise Error(f"grips: the columns have the shape {shape}; allowed: (N,)")
    return [np.broadcast_to(column, shape or (1,)) for column in columns]


def grip_columns(grips: Any) -> list[npt.NDArray[np.float64]]:
    """The six columns of grips, float64, one dimension each. Nothing is copied that is float64 already. Raises Error."""
    if hasattr(grips, "data_vars"):
        grips = grips_of(grips)
    if isinstance(grips, Mapping):
        return _of_fields(grips)
    if hasattr(grips, "columns") and hasattr(grips, "to_numpy"):  # pandas, or what behaves like it
        names = list(grips.columns)
        if len(set(names)) != len(names):
            raise Error("grips: the table has two columns of one name")
        return _of_fields({name: grips[name].to_numpy() for name in names})
    array = _array("the array", grips)
    if array.dtype.names is not None:
        return _of_fields({name: array[name] for name in array.dtype.names})
    table = _numbers("the array", array)
    if table.ndim != 2 or table.shape[1] != len(_COLUMNS):
        raise Error(f"grips: an array of shape {table.shape}; allowed: (N, 6), a structured array or a dict of columns")
    return [table[:, column] for column in range(len(_COLUMNS))]


def grips_of(data: Any) -> npt.NDArray[np.void]:
    """The grips of a Dataset as a structured array (``wh.GRIP``), in the order of the dimensions of its variables.

    So the n-th grip is that of ``data.score.values.ravel()[n]``, also after ``data.transpose(...)``.

    Parameters
    ----------
    data : xarray.Dataset
        From ``wh.best``, or from ``wh.sweep`` with one vessel selected.

    Returns
    -------
    numpy.ndarray
        Shape (N,), with the fields of ``wh.GRIP``.
    """
    import numpy as np
    import xarray as xr

    missing = [name for name in _COLUMNS if name not in data.coords]
    if missing:
        raise Error(f"grips: the dataset has no coordinate {', '.join(map(repr, missing))}")
    columns = [data[name].reset_coords(drop=True) for name in _COLUMNS]
    if any("vessel" in column.dims for column in columns):
        raise Error("grips: the dataset has several vessels, whose heights differ; select one: data.sel(vessel='...')")
    columns = list(xr.broadcast(*columns))
    order = _order(data, {str(dim) for dim in columns[0].dims})
    grips = np.empty(columns[0].size, grip_dtype())
    for name, column in zip(_COLUMNS, columns):
        grips[name] = column.transpose(*order).values.ravel()
    return grips


def _order(data: Any, dims: set[str]) -> list[str]:
    """These dimensions as the dataset's variables have them."""
    for variable in [*(data[name] for name in ("reason",) if name in data), *data.data_vars.values()]:
        if dims <= set(variable.dims):
            return [str(dim) for dim in variable.dims if dim in dims]
    return [str(dim) for dim in data.dims if dim in dims]


def evaluate(
    scene: SceneLike,
    vessel: str | int,
    grips: Any,
    variables: str | Iterable[str] | None = None,
    *,
    on: str = "auto",
    precision: str | None = None,
    threads: int = 0,
) -> dict[str, npt.NDArray[Any]]:
    """Evaluates grips of one vessel: as many as you like, and of each the variables that you name.

    Releases the interpreter's lock. The scene keeps what computes, so that the next call with the same variables, device and
    precision begins at once. Threads that use the same one wait for each other.

    Parameters
    ----------
    scene : Scene, or what ``wh.scene`` takes
    vessel : str or int
        A name or a number of ``scene.vessels``.
    grips : array
        Shape (N, 6), vessel's frame: height (m), azimuth (rad), obliquity (rad), roll (rad), offset (m) and hand_scale (1: the
        scene's own hand). Or a Dataset of ``wh.best``. Or a structured array (``wh.GRIP``), a dict of columns or a pandas
        DataFrame, with these names or those with a unit: height_mm, azimuth_deg, obliquity_deg, roll_deg, offset_mm. All but
        height may then be missing: they are 0, and hand_scale is 1. Columns of float64 are not copied, whatever their strides.
    variables : str or list of str, optional
        Names of ``scene.variables()``. Default: what a sweep of the scene keeps.
    on : str
        "auto" (the default: a GPU, or a CPU driver that is expected to be faster, where the core needs more than a second), "core",
        "vulkan" (the best device) or the name of a device.
    precision : {"float", "double"}, optional
        Default: double on the core and with "auto", float on a device that is named.
    threads : int
        Threads of the core; 0: all.

    Returns
    -------
    dict of numpy.ndarray
        An array for each variable, in the order asked. Its first dimension is the grip, the others are those of
        ``scene.variables()[name].dims``: (N,), (N, fills, tilts), (N, 24, 3), ... Fills are ``scene.fills(vessel)``, fractions of
        the capacity, tilts ``scene.tilts``, rad. Reals are float64, or float32 in float; truths, counts and reasons int8; masks
        uint8 or uint32. What an infeasible grip lacks is NaN, -1, or a mask without bits.

    Raises
    ------
    Error
        A vessel, variable, device or precision that is not there; arrays of another shape; a number that is not finite or that no
        scene may have, with its row.

    >>> import wholehand as wh
    >>> grips = {"height": [0.03, 0.06, 0.5]}
    >>> found = wh.evaluate("three_beakers", "beaker1", grips, ["reason", "closure", "joints"])
    >>> found["reason"], found["closure"].round(3), found["joints"].shape
    (array([0, 0, 3], dtype=int8), array([0.241, 0.241,   nan]), (3, 24, 3))
    """
    of = as_scene(scene)
    number = vessel_number(of, vessel)
    check_types("evaluate", on, precision, threads=threads)
    if on == "auto" and precision is None:
        precision = "double"  # else the type of the arrays would depend on their length
    found, chosen = _core.evaluate(of._core, number, grip_columns(grips), names_of(variables), on, precision, threads)
    warn(of._core.float_notes(precision, chosen))
    return found
