# SPDX-License-Identifier: MIT
"""One grip with every intermediate value."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import Error, warn, wrong_type
from ._evaluate import grip_columns
from ._scene import SceneLike, check_truths, check_types, scene as as_scene, vessel_number

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import xarray as xr

_JOINTS = 24
_DEFAULTS = {"azimuth_deg": 0.0, "obliquity_deg": 0.0, "roll_deg": 0.0, "offset_mm": 0.0, "hand_scale": 1.0}
# Suffixes of the JSON's names, and the unit that each stands for.
_UNITS = {"rad": "rad", "m3": "m3", "kg": "kg", "m": "m", "Nm": "N m", "N": "N"}


class Drawing:
    """A drawing as SVG text. A notebook shows it."""

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def _repr_svg_(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"<Drawing: {len(self.svg)} characters of SVG>"


class Grip(Mapping[str, Any]):
    """One grip and everything that ``wholehand grip --json`` reports of it. Made by ``wh.grip``.

    A mapping from the names of that JSON (docs/grip.md) to its values: lists of numbers are arrays, SI units, points in the
    vessel's frame. ``str(grip)`` is the program's table; a notebook shows the drawing. A pickled grip is evaluated again.
    """

    def __init__(self, *asked: Any) -> None:
        self._asked = asked
        self._core = _core.grip(asked[0]._core, *asked[1:])
        self._values: dict[str, Any] = json.loads(self._core.json())

    def __eq__(self, other: object) -> bool:
        """Whether all values are equal."""
        if not isinstance(other, Grip):
            return NotImplemented
        return self._values == other._values

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[type[Grip], tuple[Any, ...]]:
        return Grip, self._asked

    def __getitem__(self, name: str) -> Any:
        return _arrays(self._values[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    @property
    def feasible(self) -> bool:
        """Whether thumb and index finger close on the vessel there."""
        return bool(self._values["feasible"])

    @property
    def reason(self) -> str:
        """Why not; "" where it is feasible."""
        return str(self._values["reason"])

    @property
    def score(self) -> float:
        """Larger is better; 0 where the grip is infeasible, implausible or not held."""
        return float(self._values.get("score", 0.0))

    @property
    def joints(self) -> npt.NDArray[np.float64]:
        """The rigged hand, m, vessel's frame, shape (24, 3): where the closure alone puts it. NaN where the grip is infeasible."""
        return self._points("joints_m")

    @property
    def posed(self) -> npt.NDArray[np.float64]:
        """The posed hand, m, vessel's frame, shape (24, 3): its fingers on the glass. NaN where the grip is infeasible."""
        return self._points("posed_m")

    @property
    def proxies(self) -> npt.NDArray[np.float64]:
        """The hand outside of the glass, m, vessel's frame, shape (24, 3). NaN where the grip is infeasible."""
        return self._points("proxies_m")

    @property
    def separation(self) -> npt.NDArray[np.float64]:
        """The distance of each posed joint's skin to the glass, m, shape (24,), below 0 inside. NaN where the grip is
        infeasible.
        """
        import numpy as np

        return np.array(self._values.get("separation_m", [np.nan] * _JOINTS))

    @property
    def states(self) -> xr.Dataset:
        """What depends on fill and tilt: variables over (fill, tilt) with their units, and (fill, tilt, xyz) for centers of mass.

        Forces in N, torques in N m, of the scene's fills and tilts or of those that were asked for. Contacts are in
        ``grip["states"][k]["contacts"]``. Without states the dataset is empty.
        """
        return _states(self._values.get("states", []))

    def _points(self, name: str) -> npt.NDArray[np.float64]:
        import numpy as np

        return np.array(self._values.get(name, [[np.nan] * 3] * _JOINTS))

    def plot(self) -> Drawing:
        """Draws front, side and top view, as ``wholehand grip --svg``. Raises Error where the grip is infeasible."""
        return Drawing(self._core.svg())

    def svg(self, path: str | os.PathLike[str]) -> None:
        """Writes that drawing. Raises Error: infeasible, or a file that cannot be made or is no drawing of wholehand's."""
        self._core.write_svg(os.fspath(path))

    def glb(self, path: str | os.PathLike[str]) -> None:
        """Writes hand, vessel and liquid as glTF binary, m, +y up, the hand's joints by their OpenXR names. Raises Error as
        ``svg``.
        """
        self._core.write_glb(os.fspath(path))

    def _repr_svg_(self) -> str | None:
        return self._core.svg() if self.feasible else None

    def __str__(self) -> str:
        return self._core.table()

    def __repr__(self) -> str:
        asked = self._values["grip"]
        outcome = f"score {self.score:.3f}" if self.feasible else self.reason
        return f"<Grip of {self._values['vessel']} at {1e3 * asked['height_m']:.4g} mm: {outcome}>"


def _arrays(value: Any) -> Any:
    """Lists of numbers, and lists of such lists of one length, as arrays."""
    import numpy as np

    if not isinstance(value, list) or not value:
        return value
    items = [_arrays(one) for one in value]
    if all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in items):
        return np.array(items, dtype=np.float64)
    if all(isinstance(one, np.ndarray) for one in items) and len({one.shape for one in items}) == 1:
        return np.array(items)
    return items


def _named(name: str) -> tuple[str, str]:
    """ "torque_Nm" is the torque, in N m."""
    stem, _, suffix = name.rpartition("_")
    return (stem, _UNITS[suffix]) if stem and suffix in _UNITS else (name, "1")


def _states(states: list[dict[str, Any]]) -> xr.Dataset:
    import numpy as np
    import xarray as xr

    if not states:
        return xr.Dataset()
    fills = list(dict.fromkeys(one["fill"] for one in states))
    tilts = list(dict.fromkeys(one["tilt_rad"] for one in states))
    if len(fills) * len(tilts) != len(states):
        raise Error("states: a fill or a tilt was asked for twice")
    data = xr.Dataset(coords={"fill": ("fill", fills, {"units": "1"}), "tilt": ("tilt", tilts, {"units": "rad"})})
    for key, first in states[0].items():
        last = "xyz" if key in ("liquid_com_m", "com_m") else "finger" if key.startswith("finger_share") else None
        if key in ("fill", "tilt_rad", "worst_direction") or (isinstance(first, list) and not last):
            continue
        name, unit = (key, "1") if last == "finger" else _named(key)
        missing = [np.nan] * (3 if last == "xyz" else 4) if last else np.nan
        values = np.array([missing if one.get(key) is None else one[key] for one in states], dtype=np.float64)
        dims = ("fill", "tilt", last) if last else ("fill", "tilt")
        if last == "finger":
            data = data.assign_coords(finger=("finger", ["index", "middle", "ring", "little"]))
        data[name] = dims, values.reshape(len(fills), len(tilts), *values.shape[1:]), {"units": unit}
    return data


def _number(value: Any, name: str) -> float:
    if isinstance(value, (str, bytes)):  # which float() would read
        raise wrong_type("grip", name, value, "a number")
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise wrong_type("grip", name, value, "a number") from None


def _three(values: Sequence[float], name: str) -> list[float]:
    numbers = _list(values, name) or []
    if len(numbers) != 3:
        raise Error(f"{name}: {len(numbers)} numbers; allowed: three, x, y and z in mm")
    return numbers


def _list(values: float | Sequence[float] | None, name: str) -> list[float] | None:
    import numpy as np

    if values is None:
        return None
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        array = np.empty(0, object)
    if array.dtype.kind not in "fiu" or array.ndim > 1:
        raise wrong_type("grip", name, values, "a number, or a list of numbers")
    return [float(one) for one in np.atleast_1d(array)]


def _only_grip(at: Any) -> list[float]:
    """The six numbers of one grip, which is given as ``wh.evaluate`` takes many."""
    import numpy as np

    if hasattr(at, "keys"):
        table = at
    elif hasattr(at, "dtype"):
        array = np.asarray(at)
        table = array[np.newaxis] if array.ndim == (0 if array.dtype.names is not None else 1) else array
    else:
        table = [at]
    columns = grip_columns(table)
    if len(columns[0]) != 1:
        raise Error(f"grip: at has {len(columns[0])} grips; allowed: one")
    return [float(column[0]) for column in columns]


def _exclude(given: list[str], other: str) -> None:
    if given:
        raise Error(f"{given[0]} excludes {other}")


def _check_place(at: Any, index_mm: Any, in_units: dict[str, Any], in_si: dict[str, Any]) -> None:
    """Raises Error where the place of the grip is missing or given twice."""
    has_thumb, has_index = "thumb_mm" in in_units, index_mm is not None
    if at is not None:
        _exclude([*in_si, *in_units], "at")
    elif has_thumb:
        further = [name for name in in_units if has_index and name not in ("thumb_mm", "roll_deg", "hand_scale")]
        _exclude([*in_si, *("--" + name.replace("_", "-") for name in further)], "--thumb-mm")
    if (at is not None) + ("height_mm" in in_units) + has_thumb != 1 or has_thumb != has_index:
        raise Error(
            "grip: the place of the grip is missing or given twice; give height or height_mm, or thumb_mm and index_mm, or at"
        )


def _given(numbers: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in numbers.items() if value is not None}


def _asked(at: Any, index_mm: Any, in_units: dict[str, Any], in_si: dict[str, Any]) -> list[float]:
    """The six numbers of the grip, SI. `in_units` are those that are given of height_mm, thumb_mm, azimuth_deg, obliquity_deg,
    roll_deg, offset_mm and hand_scale, `in_si` those of height, azimuth, obliquity, roll and offset.
    """
    if "thumb_mm" in in_units and "roll" in in_si and "roll_deg" not in in_units:
        in_units["roll_deg"] = math.degrees(_number(in_si.pop("roll"), "roll"))
    if in_si and at is None and "thumb_mm" not in in_units:
        at, in_units, in_si = {name: _number(value, name) for name, value in (in_units | in_si).items()}, {}, {}
    _check_place(at, index_mm, in_units, in_si)
    if at is not None:
        return _only_grip(at)
    azimuth, obliquity, roll, offset, hand_scale = (
        _number(in_units.get(name, default), name) for name, default in _DEFAULTS.items()
    )
    if "thumb_mm" in in_units:
        return _core.grip_between(_three(in_units["thumb_mm"], "thumb_mm"), _three(index_mm, "index_mm"), roll, hand_scale)
    return _core.grip_at(_number(in_units["height_mm"], "height_mm"), azimuth, obliquity, roll, offset, hand_scale)


def _states_asked(fills: Any, fills_ml: Any, tilts: Any, tilts_deg: Any) -> list[list[float] | None]:
    """Fills as fractions, fills in mL and tilts in degrees. None: the scene's."""
    if tilts is not None:
        if tilts_deg is not None:
            raise Error("grip: both tilts and tilts_deg are given; allowed: one of the two")
        tilts_deg = [math.degrees(one) for one in _list(tilts, "tilts") or []]
    return [_list(values, name) for name, values in (("fills", fills), ("fills_ml", fills_ml), ("tilts_deg", tilts_deg))]


def grip(
    scene: SceneLike,
    vessel: str | int,
    *,
    height_mm: float | None = None,
    azimuth_deg: float | None = None,
    obliquity_deg: float | None = None,
    roll_deg: float | None = None,
    offset_mm: float | None = None,
    hand_scale: float | None = None,
    height: float | None = None,
    azimuth: float | None = None,
    obliquity: float | None = None,
    roll: float | None = None,
    offset: float | None = None,
    thumb_mm: Sequence[float] | None = None,
    index_mm: Sequence[float] | None = None,
    at: Any = None,
    fills: float | Sequence[float] | None = None,
    fills_ml: float | Sequence[float] | None = None,
    tilts: float | Sequence[float] | None = None,
    tilts_deg: float | Sequence[float] | None = None,
    on: str = "auto",
    precision: str | None = None,
    quality: bool = False,
) -> Grip:
    """One grip with every intermediate value: ``wholehand grip``.

    Parameters
    ----------
    scene : Scene, or what ``wh.scene`` takes
    vessel : str or int
        A name or a number of ``scene.vessels``.
    height_mm, azimuth_deg, obliquity_deg, roll_deg, offset_mm, hand_scale : float
        Where the thumb-index line lies in the vessel's frame, in mm and degrees as in a scene file: its height over the base, its
        direction about the axis, its angle to the horizontal, the turn of the hand about it (0: beside the vessel, -90: above it),
        its distance from the axis; and the hand's size times the scene's. Default: 0, and 1 for hand_scale.
    height, azimuth, obliquity, roll, offset : float
        The same in m and rad, as the columns of ``wh.evaluate`` and the coordinates of a Dataset. Each under one name alone.
    thumb_mm, index_mm : three floats, optional
        Instead of height, azimuth, obliquity and offset: two points of the line, on the thumb's and on the index finger's side.
    at : array, optional
        Instead of all these: one grip as ``wh.evaluate`` takes them, say six numbers in SI units, a row of a structured array
        (``wh.GRIP``), or one grip of ``wh.best``.
    fills, fills_ml, tilts, tilts_deg : float or list of float, optional
        The states: fills as fractions of the capacity or in mL, tilts in rad or degrees. Default: ``scene.fills(vessel)`` and
        ``scene.tilts``.
    on : str
        "auto" (the default: the core, as one grip is too little for a device), "core", "vulkan" or the name of a device.
    precision : {"float", "double"}, optional
        Default: double on the core, float on a device.
    quality : bool
        Measure the grasp as Ferrari and Canny do, "epsilon" and "wrench_volume", and the shares of the fingers: ``states`` has
        "finger_share", "finger_share_low" and "finger_share_high" along "finger", index to little. Takes seconds.

    Raises
    ------
    Error
        What the program refuses, in its line.

    >>> import wholehand as wh
    >>> g = wh.grip("three_beakers", "beaker1", height_mm=70, roll_deg=-40)
    >>> g
    <Grip of beaker1 at 70 mm: score 0.867>
    >>> g["fingers_used"], g.joints.shape
    (['thumb', 'index', 'middle', 'ring'], (24, 3))
    >>> g.states.torque.dims, g.states.torque.attrs["units"]
    (('fill', 'tilt'), 'N m')
    """
    of = as_scene(scene)
    number = vessel_number(of, vessel)
    check_types("grip", on, precision)
    check_truths("grip", quality=quality)
    angles = {"azimuth_deg": azimuth_deg, "obliquity_deg": obliquity_deg, "roll_deg": roll_deg}
    in_units = {"height_mm": height_mm, "thumb_mm": thumb_mm, **angles, "offset_mm": offset_mm, "hand_scale": hand_scale}
    in_si = {"height": height, "azimuth": azimuth, "obliquity": obliquity, "roll": roll, "offset": offset}
    asked = _asked(at, index_mm, _given(in_units), _given(in_si))
    states = _states_asked(fills, fills_ml, tilts, tilts_deg)
    made = Grip(of, number, asked, *states, on, precision, quality)
    warn(of._core.float_notes(precision, "core" if on == "auto" else on))
    return made
