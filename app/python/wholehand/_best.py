# SPDX-License-Identifier: MIT
"""The best grips of a Dataset that differ from one another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import Error, wrong_type
from ._scene import check_types

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import xarray as xr

    By = str | xr.DataArray
    Places = tuple[Any, ...]  # of grips: an index array for each of their dimensions

_AXES = ("azimuth", "obliquity", "roll", "offset", "hand_scale", "height", "height_fraction", "point")
_ROBUST = ("robust_low", "robust_mean", "robust_share")
_BEST_WHERE_NONE = 20  # as the program, where neither scene nor sweep lists any


def _check_kinds(by: object, where: object) -> None:
    """Raises TypeError."""
    import xarray as xr

    if by is not None and not isinstance(by, (str, xr.DataArray)):
        raise wrong_type("best", "by", by, "the name of a variable, or a DataArray")
    if where is not None and not isinstance(where, xr.DataArray):
        found = repr(where) if isinstance(where, str) else type(where).__name__
        raise TypeError(f"best: where is {found}; allowed: a DataArray of truths, as data.fingers_used >= 4")


def _scene_of(data: xr.Dataset) -> _core.Scene:
    """The scene that a result keeps. Raises Error where its meshes are no longer what they were."""
    if "scene" not in data.attrs:
        raise Error("best: the dataset has no attribute 'scene'; give one of wh.sweep, or of a result file")
    of_meshes = [str(data.attrs.get(name, "")) for name in ("scene_file", "version", "mesh_keys", "mesh_lattices")]
    return _core.scene_of_dataset(str(data.attrs["scene"]), str(data.encoding.get("source", "")), *of_meshes)


def _limits(scene: _core.Scene, data: xr.Dataset, n: int | None, apart_mm: float | None) -> tuple[int, float]:
    """The most grips of a list, and the least distance of their hands, m. Raises Error and TypeError."""
    import numpy as np

    check_types("best", "core", n=n)
    count = n if n is not None else int(data.sizes.get("rank", 0)) or scene.best or _BEST_WHERE_NONE
    if apart_mm is not None and not isinstance(apart_mm, (int, float, np.floating, np.integer)):
        raise wrong_type("best", "apart_mm", apart_mm, "a number")
    apart = scene.apart if apart_mm is None else float(apart_mm) / 1e3
    if count < 1 or not apart >= 0 or not np.isfinite(apart):
        raise Error(f"best: n is {n} and apart_mm is {apart_mm}; allowed: n of 1 or more, apart_mm of 0 or more")
    return count, apart


def _criterion(scene: _core.Scene, data: xr.Dataset, by: By | None, least_bad: bool) -> tuple[By, bool]:
    """What ranks the grips, and whether the core ranks the best of them again by their robust scores. Raises Error."""
    if least_bad and not scene.has_effort:
        raise Error(
            "best: least_bad needs efforts, which the scene does not have ([tilts], and [strength] without efforts = false)"
        )
    if by is None:
        by = "robust" if scene.has_robust else "score"
    if not isinstance(by, str) or by != "robust" or by in data:
        return by, False
    if not scene.has_robust:
        raise Error(
            "best: by is 'robust', and the scene has no [robust]; allowed: score, worst_effort, push or any other variable"
        )
    return "score", True


def _check_variables(scene: _core.Scene, data: xr.Dataset, by: By, least_bad: bool) -> None:
    """Raises Error where one is missing by which grips are chosen."""
    needed = ["reason", "plausible", by, *(["not_held"] if scene.has_effort else []), *(["worst_effort"] if least_bad else [])]
    missing = [f"'{name}'" for name in needed if isinstance(name, str) and name not in data]
    if missing:
        raise Error(
            f"best: the dataset lacks {', '.join(missing)}, by which grips are chosen: "
            "name them in [output] also, or in its keep, and sweep again"
        )


def _with_vessels(data: xr.Dataset) -> xr.Dataset:
    """The dataset with a dimension of vessels. Raises Error where it has no vessel."""
    if "vessel" not in data.dims:
        if "vessel" not in data.coords:
            raise Error("best: the dataset has no coordinate 'vessel'")
        return data.expand_dims("vessel")
    if not data.sizes["vessel"]:
        raise Error("best: the dataset has no vessel left")
    return data


def _refuse_azimuths(value: By | None, data: xr.Dataset, name: str) -> None:
    """Where one azimuth of the sweep stands for all, what differs from azimuth to azimuth would be left out without a word."""
    import numpy as np
    import xarray as xr

    if not isinstance(value, xr.DataArray) or "azimuth" not in value.dims:
        return
    values = (value.reindex(azimuth=data["azimuth"]) if "azimuth" in value.coords else value).transpose("azimuth", ...).values
    first = np.broadcast_to(values[:1], values.shape)
    if not ((values == first) | ((values != values) & (first != first))).all():
        raise Error(
            f"best: {name}: azimuth_deg changes nothing in this sweep: the vessels are bodies of revolution, and one azimuth "
            "stands for all"
        )


def _without_repeated_azimuths(scene: _core.Scene, data: xr.Dataset, by: By, where: xr.DataArray | None) -> xr.Dataset:
    """The dataset at one azimuth where the others repeat it."""
    if data.sizes.get("azimuth", 0) <= 1 or not scene.repeats_azimuths([str(name) for name in data.data_vars]):
        return data
    _refuse_azimuths(by, data, "by")
    _refuse_azimuths(where, data, "where")
    return data.isel(azimuth=[0])


def _grip_dims(data: xr.Dataset) -> list[str]:
    """The dimensions of a vessel's grips. Raises Error."""
    dims = [str(dim) for dim in data["reason"].dims if dim != "vessel"]
    unknown = [dim for dim in dims if dim not in _AXES]
    if unknown:
        raise Error(f"best: the dimension {unknown[0]} of the grips is no axis of a sweep")
    return dims


def _over_grips(array: xr.DataArray, data: xr.Dataset, dims: list[str], name: str, kinds: str) -> xr.DataArray:
    """The array with a value for every grip of every vessel. Raises Error."""
    import xarray as xr

    if array.dtype.kind not in kinds:
        raise Error(f"best: {name} is {array.dtype}; allowed: {'truths' if kinds == 'b' else 'real numbers'}")
    further = [str(dim) for dim in array.dims if dim not in ("vessel", *dims)]
    if further:
        raise Error(
            f"best: {name} has the dimension {', '.join(further)} beside those of the grips; "
            f"reduce it, say with .max('{further[0]}')"
        )
    like = data["reason"].isel(vessel=0, drop=True)
    array, _ = xr.broadcast(array, like if "vessel" not in array.dims else data["reason"])
    return array if "vessel" in array.dims else array.expand_dims(vessel=data["vessel"])


class _VesselGrips:
    """One vessel's grips."""

    def __init__(self, scene: _core.Scene, vessel: str, data: xr.Dataset, dims: list[str], apart: float) -> None:
        self.scene, self.vessel, self.data, self.dims, self.apart = scene, vessel, data, dims, apart
        self.shape = tuple(data.sizes[dim] for dim in dims)

    def columns(self, places: Places) -> list[npt.NDArray[np.float64]]:
        """The coordinates of grips, in the order of the core's columns."""
        import numpy as np

        columns = []
        for name in _core.GRIP_COLUMNS:
            if name not in self.data.coords:
                raise Error(f"best: the dataset has no coordinate '{name}'")
            coordinate = self.data[name]
            along = tuple(places[self.dims.index(str(dim))] for dim in coordinate.dims)
            columns.append(np.array(np.broadcast_to(coordinate.values[along], places[0].shape), dtype=np.float64))
        return columns

    def hands(self) -> list[npt.NDArray[np.bool_]]:
        """A mask of the grips of each hand scale that has a list of its own."""
        import numpy as np

        scales = self.data.coords.get("hand_scale")
        if self.scene.hand_scales <= 1 or scales is None or not scales.dims:
            return [np.ones(self.shape, bool).ravel()]
        values = scales.values.reshape([-1 if dim == scales.dims[0] else 1 for dim in self.dims])
        return [np.broadcast_to(values == one, self.shape).ravel() for one in dict.fromkeys(scales.values.tolist())]

    def choose(self, scores: npt.NDArray[Any], candidates: npt.NDArray[np.bool_], count: int) -> Places:
        """The places of the best candidates that differ."""
        import numpy as np

        ordered = np.flatnonzero(candidates & ~np.isnan(scores))
        ordered = ordered[np.argsort(-scores[ordered], kind="stable")]
        # each grip that is considered needs a posed hand, and few are considered: coordinates come by blocks
        size = 1 << 16
        while True:
            columns = self.columns(np.unravel_index(ordered[:size], self.shape))
            chosen = _core.different_grips(self.scene, self.scene.find_vessel(self.vessel), columns, count, self.apart)
            if len(chosen) >= count or size >= len(ordered):
                return np.unravel_index(ordered[chosen], self.shape)
            size *= 16

    def rank_robustly(self, places: Places, count: int) -> tuple[Places, dict[str, list[float]]]:
        """The places that are listed, in their order, and their robust scores."""
        columns = self.columns(places)
        order, *scores = _core.rank_by_robust_scores(self.scene, self.scene.find_vessel(self.vessel), columns, count)
        return tuple(at[order] for at in places), dict(zip(_ROBUST, scores))

    def listed(self, places: Places) -> xr.Dataset:
        """The grips of one list, along "grip"."""
        import numpy as np
        import xarray as xr

        names = [name for name, variable in self.data.data_vars.items() if set(self.dims) <= set(variable.dims)]
        length = len(places[0])
        # no grips: reads the first one and drops it, since a file cannot be read at no place
        read = {dim: xr.DataArray(at if length else [0], dims="grip") for dim, at in zip(self.dims, places)}
        picked = self.data[names].isel(read)
        if not length:
            picked = picked.load().isel(grip=slice(0, 0))
        if "worst_effort" in picked:
            with np.errstate(divide="ignore"):
                margin = (1 / picked["worst_effort"]).assign_attrs(units="1", long_name="1 / worst effort")
            picked = picked.assign(held_margin=margin)
        columns = zip(_core.GRIP_COLUMNS, self.columns(places))
        return picked.transpose("grip", ...).assign_coords(
            {name: ("grip", column, dict(self.data[name].attrs)) for name, column in columns}
            | {"vessel": ("grip", np.full(length, self.vessel)), "rank": ("grip", np.arange(1, length + 1), {"units": "1"})}
        )


def _judge(
    scene: _core.Scene, data: xr.Dataset, dims: list[str], by: By, where: xr.DataArray | None, least_bad: bool
) -> dict[str, xr.DataArray]:
    """By what grips are chosen: "score", "holds", "eligible" (whether it holds or not) and, for least_bad, "effort"."""
    own = data[by] if isinstance(by, str) else by
    score = _over_grips(own, data, dims, "by", "biuf").astype("float64").reindex_like(data["reason"])  # the search negates it
    if isinstance(by, str) and by == "worst_effort":
        score = -score
    plausible = eligible = (data["reason"] == 0) & (data["plausible"] == 1)
    if where is not None:
        eligible = plausible & _over_grips(where, data, dims, "where", "b").reindex_like(data["reason"], fill_value=False)
    holds = plausible & (data["not_held"] != 1) if scene.has_effort else plausible
    return {"score": score, "eligible": eligible, "holds": holds} | ({"effort": data["worst_effort"]} if least_bad else {})


def _lists(grips: _VesselGrips, judged: dict[str, npt.NDArray[Any]], count: int, is_robust: bool) -> list[xr.Dataset]:
    """A vessel's list for each hand scale that has one of its own."""
    lists = []
    for hand in grips.hands():
        eligible, holds = judged["eligible"] & hand, judged["holds"] & hand
        robust: dict[str, list[float]] = {}
        if "effort" in judged and not holds.any():  # in the order of their efforts, as in the program
            places = grips.choose(-judged["effort"], eligible, count)
            robust = dict.fromkeys(_ROBUST, [float("nan")] * len(places[0])) if is_robust else {}
        elif is_robust:
            candidates = grips.choose(judged["score"], eligible & holds, grips.scene.robust_candidates(count))
            places, robust = grips.rank_robustly(candidates, count)
        else:
            places = grips.choose(judged["score"], eligible & holds, count)
        lists.append(grips.listed(places).assign({name: ("grip", values) for name, values in robust.items()}))
    return lists


def best(
    data: xr.Dataset,
    n: int | None = None,
    apart_mm: float | None = None,
    *,
    by: str | xr.DataArray | None = None,
    where: xr.DataArray | None = None,
    least_bad: bool = False,
) -> xr.Dataset:
    """The best grips of every vessel that differ from one another, as ``wholehand rank`` lists them.

    A list takes a vessel's feasible, plausible grips from the best to the worst, equal ones in the order of the sweep; in a scene
    with [strength], only those that hold. It takes a grip where some joint of the posed hand is more than ``apart_mm`` from the
    same joint of every hand before. Where a sweep has several hand scales, each has a list.

    Parameters
    ----------
    data : xarray.Dataset
        From ``wh.sweep`` or a result file, or a part of it (``data.sel(vessel=["beaker1"])``, ``data.isel(roll=slice(0, 4))``).
    n : int, optional
        The most grips of a list. Default: as many as the sweep listed.
    apart_mm : float, optional
        Default: the scene's [output] apart_mm. 0: any two grips differ.
    by : str or DataArray
        "robust" (the default of a scene with [robust], which it needs): the robust scores, which the core finds here.
        "worst_effort": the least. Else what is largest for the best grip: a variable (the default is "score"), or your own score
        over (vessel and) the dimensions of the grips. NaN: left out.
    where : DataArray of bool, optional
        Only grips where this holds.
    least_bad : bool, optional
        Where no grip of a list holds: the grips of the least worst effort instead of none, whatever ``by`` says.

    Returns
    -------
    xarray.Dataset
        Along ``grip``: every variable of the grips, and as coordinates the vessel, the rank in its list (from 1), height (m),
        azimuth, obliquity, roll (rad), offset (m) and hand_scale. Where the dataset has ``worst_effort``: ``held_margin``, which
        is 1 / worst effort. By "robust": robust_low, robust_mean, robust_share. ``wh.grips`` makes an array for ``wh.evaluate``
        of it, and ``wh.grip(scene, vessel, at=found.isel(grip=0))`` shows one.

    Raises
    ------
    Error
        A dataset without scene, reason, plausible or score, or, for a scene with [strength], without not_held; ``by`` or ``where``
        that differ from azimuth to azimuth where the sweep computed one for all.

    >>> import wholehand as wh
    >>> data = wh.sweep("small", on="core")
    >>> found = wh.best(data, n=2, apart_mm=25)
    >>> found.score.values.round(3).tolist(), (found.height * 1e3).values.tolist()
    ([0.848, 0.759], [55.0, 70.0])
    """
    import xarray as xr

    _check_kinds(by, where)
    scene = _scene_of(data)
    count, apart = _limits(scene, data, n, apart_mm)
    by, is_robust = _criterion(scene, data, by, least_bad)
    _check_variables(scene, data, by, least_bad)
    data = _without_repeated_azimuths(scene, _with_vessels(data), by, where)
    dims = _grip_dims(data)
    judged = _judge(scene, data, dims, by, where, least_bad)
    lists = []
    for v, vessel in enumerate(data["vessel"].values.tolist()):
        own = {name: values.isel(vessel=v).transpose(*dims).values.ravel() for name, values in judged.items()}
        lists += _lists(_VesselGrips(scene, vessel, data.isel(vessel=v), dims, apart), own, count, is_robust)
    return xr.concat(lists, "grip", combine_attrs="override")
