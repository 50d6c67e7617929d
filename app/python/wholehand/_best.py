# SPDX-License-Identifier: MIT
"""The best grips of a Dataset that differ from one another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import Error, wrong_type
from ._scene import Scene, check_types

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import xarray as xr

_AXES = ("azimuth", "obliquity", "roll", "offset", "hand_scale", "height", "height_fraction", "point")
_ROBUST = ("robust_low", "robust_mean", "robust_share")
_BEST_WHERE_NONE = 20  # as the program, where neither scene nor sweep lists any


def scene_of(data: xr.Dataset) -> Scene:
    """The scene that a result keeps. Raises Error where its meshes are no longer what they were."""
    if "scene" not in data.attrs:
        raise Error("best: the dataset has no attribute 'scene'; give one of wh.sweep, or of a result file")
    of_meshes = [str(data.attrs.get(name, "")) for name in ("scene_file", "version", "mesh_keys", "mesh_lattices")]
    return Scene(_core.scene_of_dataset(str(data.attrs["scene"]), str(data.encoding.get("source", "")), *of_meshes))


def _with_vessels(data: xr.Dataset) -> xr.Dataset:
    if "vessel" in data.dims:
        return data
    if "vessel" not in data.coords:
        raise Error("best: the dataset has no coordinate 'vessel'")
    return data.expand_dims("vessel")


class _Chooser:
    """Goes through one vessel's grips, the best first."""

    def __init__(self, scene: Scene, data: xr.Dataset, dims: list[str], apart: float) -> None:
        self.scene, self.data, self.dims, self.apart = scene, data, dims, apart
        self.shape = tuple(data.sizes[dim] for dim in dims)

    def column(self, name: str, places: tuple[Any, ...]) -> npt.NDArray[np.float64]:
        """A coordinate at grips, by their places along the dimensions."""
        import numpy as np

        if name not in self.data.coords:
            raise Error(f"best: the dataset has no coordinate '{name}'")
        coordinate = self.data[name]
        along = tuple(places[self.dims.index(str(dim))] for dim in coordinate.dims)
        return np.array(np.broadcast_to(coordinate.values[along], places[0].shape), dtype=np.float64)

    def rank_robustly(self, vessel: str, places: tuple[Any, ...], count: int) -> tuple[tuple[Any, ...], dict[str, list[float]]]:
        """Those of the candidates' places that are listed, in their order, and their robust scores."""
        columns = [self.column(name, places) for name in _core.GRIP_COLUMNS]
        order, *scores = _core.rank_by_robust_scores(self.scene._core, self.scene._core.find_vessel(vessel), columns, count)
        return tuple(at[order] for at in places), dict(zip(_ROBUST, scores))

    def choose(self, vessel: str, scores: npt.NDArray[Any], eligible: npt.NDArray[np.bool_], count: int) -> tuple[Any, ...]:
        """The places of the chosen grips along the dimensions."""
        import numpy as np

        places = np.flatnonzero(eligible & ~np.isnan(scores))
        ordered = places[np.argsort(-scores[places], kind="stable")]
        # each grip that is considered needs a posed hand, and few are considered: coordinates come by blocks
        chosen: list[int] = []
        size = 1 << 16
        while True:
            looked = ordered[:size]
            at = np.unravel_index(looked, self.shape)
            columns = [self.column(name, at) for name in _core.GRIP_COLUMNS]
            chosen = _core.different_grips(self.scene._core, self.scene._core.find_vessel(vessel), columns, count, self.apart)
            if len(chosen) >= count or size >= len(ordered):
                return np.unravel_index(ordered[chosen], self.shape)
            size *= 16


def _hands(data: xr.Dataset, dims: list[str], scene: Scene) -> list[npt.NDArray[np.bool_]]:
    """A mask of the grips of each hand scale that has a list of its own."""
    import numpy as np

    shape = tuple(data.sizes[dim] for dim in dims)
    if scene._core.hand_scales <= 1 or "hand_scale" not in data.coords:
        return [np.ones(shape, bool).ravel()]
    coordinate = data["hand_scale"]
    if not coordinate.dims:
        return [np.ones(shape, bool).ravel()]
    along = [1] * len(dims)
    along[dims.index(str(coordinate.dims[0]))] = -1
    values = coordinate.values
    return [np.broadcast_to((values == one).reshape(along), shape).ravel() for one in dict.fromkeys(values.tolist())]


def _refuse_azimuths(value: str | xr.DataArray | None, data: xr.Dataset, name: str) -> None:
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


def _of_grips(array: xr.DataArray, data: xr.Dataset, dims: list[str], name: str, kinds: str) -> xr.DataArray:
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

    The feasible, plausible grips of a vessel are taken from the best to the worst, equal ones in the order of the sweep.
    In a scene with [strength] those are left out that do not hold (``not_held``). A grip is taken where some joint of the posed hand is more than ``apart_mm`` from the same joint of every hand before. Where a
    sweep has several hand scales, each has a list.

    Parameters
    ----------
    data : xarray.Dataset
        Of ``wh.sweep`` or of a result file, or a part of it (``data.sel(vessel=["beaker1"])``, ``data.isel(roll=slice(0, 4))``).
    n : int, optional
        Grips of a list at most. Default: as many as the sweep listed.
    apart_mm : float, optional
        Default: the scene's [output] apart_mm. 0: any two grips differ.
    by : str or DataArray
        "robust": the robust scores of a scene with [robust], which the core finds here; the default there. "worst_effort": the
        least. Else what is largest for the best grip: a variable (the default is "score"), or your own score over (vessel and) the
        dimensions of the grips. NaN: left out.
    where : DataArray of bool, optional
        Only grips where this holds.
    least_bad : bool, optional
        Where no grip of a list holds: the grips of the least worst effort instead of none, whatever ``by`` says.

    Returns
    -------
    xarray.Dataset
        Along ``grip``: every variable of the grips, and as coordinates the vessel, the rank in its list (from 1), and where it is:
        height (m), azimuth, obliquity, roll (rad), offset (m), hand_scale. Where the dataset has ``worst_effort``, there is also
        ``held_margin``, which is 1 / worst effort. ``wh.grips(...)`` makes an array for ``wh.evaluate`` of
        it, and ``wh.grip(scene, vessel, at=found.isel(grip=0))`` shows one. By "robust": robust_low, robust_mean, robust_share too.

    Raises
    ------
    Error
        A dataset without scene, reason, plausible or score, and, of a scene with [strength], not_held; ``by`` or ``where`` that differ from azimuth to azimuth where the
        sweep computed one for all.

    >>> import wholehand as wh
    >>> data = wh.sweep("small", on="core")
    >>> found = wh.best(data, n=2, apart_mm=25)
    >>> found.score.values.round(3).tolist(), (found.height * 1e3).values.tolist()
    ([0.848, 0.759], [55.0, 70.0])
    """
    import numpy as np
    import xarray as xr

    if by is not None and not isinstance(by, (str, xr.DataArray)):
        raise wrong_type("best", "by", by, "the name of a variable, or a DataArray")
    if where is not None and not isinstance(where, xr.DataArray):
        said = repr(where) if isinstance(where, str) else type(where).__name__
        raise TypeError(f"best: where is {said}; allowed: a DataArray of truths, as data.fingers_used >= 4")
    scene = scene_of(data)
    check_types("best", "core", n=n)
    count = n if n is not None else int(data.sizes.get("rank", 0)) or scene._core.best or _BEST_WHERE_NONE
    if apart_mm is not None and not isinstance(apart_mm, (int, float, np.floating, np.integer)):
        raise wrong_type("best", "apart_mm", apart_mm, "a number")
    apart = scene._core.apart if apart_mm is None else float(apart_mm) / 1e3
    if count < 1 or not apart >= 0 or not np.isfinite(apart):
        raise Error(f"best: n is {n} and apart_mm is {apart_mm}; allowed: n of 1 or more, apart_mm of 0 or more")
    if least_bad and not scene._core.has_effort:
        raise Error("best: least_bad needs efforts, which the scene does not have ([tilts], and [strength] without efforts = false)")
    if by is None:
        by = "robust" if scene._core.has_robust else "score"
    is_robust = isinstance(by, str) and by == "robust" and by not in data
    if is_robust and not scene._core.has_robust:
        raise Error("best: by is 'robust', and the scene has no [robust]; allowed: score, worst_effort, push or any other variable")
    is_least = isinstance(by, str) and by == "worst_effort"
    if is_robust:
        by = "score"
    needed = ["reason", "plausible", by, *(["not_held"] if scene._core.has_effort else []), *(["worst_effort"] if least_bad else [])]
    missing = [f"'{name}'" for name in needed if isinstance(name, str) and name not in data]
    if missing:
        raise Error(f"best: the dataset lacks {', '.join(missing)}, by which grips are chosen: name them in [output] also, or in its keep, and sweep again")
    data = _with_vessels(data)
    if not data.sizes["vessel"]:
        raise Error("best: the dataset has no vessel left")
    if data.sizes.get("azimuth", 0) > 1 and scene._core.repeats_azimuths([str(name) for name in data.data_vars]):
        _refuse_azimuths(by, data, "by")
        _refuse_azimuths(where, data, "where")
        data = data.isel(azimuth=[0])  # the others repeat it
    dims = [str(dim) for dim in data["reason"].dims if dim != "vessel"]
    unknown = [dim for dim in dims if dim not in _AXES]
    if unknown:
        raise Error(f"best: the dimension {unknown[0]} of the grips is no axis of a sweep")
    # as numbers with a sign: the search for the best takes the least of what is below zero
    own = data[by] if isinstance(by, str) else by
    wanted = _of_grips(own, data, dims, "by", "biuf").astype(np.float64).reindex_like(data["reason"])
    if is_least:
        wanted = -wanted
    plausible = eligible = (data["reason"] == 0) & (data["plausible"] == 1)
    if where is not None:
        eligible = eligible & _of_grips(where, data, dims, "where", "b").reindex_like(data["reason"], fill_value=False)
    order = ["vessel", *dims]
    fails = data["not_held"] == 1 if scene._core.has_effort else xr.zeros_like(data["reason"], dtype=bool)
    wanted, eligible, plausible = wanted.transpose(*order), eligible.transpose(*order), plausible.transpose(*order)
    fails = fails.transpose(*order)
    efforts = data["worst_effort"].transpose(*order) if least_bad else None
    pieces = []
    for v, vessel in enumerate(data["vessel"].values.tolist()):
        part = data.isel(vessel=v)
        chooser = _Chooser(scene, part, dims, apart)
        scores, allowed = wanted.isel(vessel=v).values.ravel(), eligible.isel(vessel=v).values.ravel()
        unheld, judged = fails.isel(vessel=v).values.ravel(), plausible.isel(vessel=v).values.ravel()
        for hand in _hands(part, dims, scene):
            kept = scene._core.robust_candidates(count) if is_robust else count
            places = chooser.choose(vessel, scores, allowed & ~unheld & hand, kept)
            robust: dict[str, list[float]] = {}
            if efforts is not None and not (judged & ~unheld & hand).any():  # in the order of their efforts, as in the program
                places = chooser.choose(vessel, -efforts.isel(vessel=v).values.ravel(), allowed & hand, count)
                if is_robust:
                    robust = {name: [float("nan")] * len(places[0]) for name in _ROBUST}
            elif is_robust:
                places, robust = chooser.rank_robustly(vessel, places, count)
            pieces.append(_listed(part, dims, chooser, places).assign({name: ("grip", values) for name, values in robust.items()}))
    return xr.concat(pieces, "grip", combine_attrs="override")


def _listed(part: xr.Dataset, dims: list[str], chooser: _Chooser, places: tuple[Any, ...]) -> xr.Dataset:
    """The grips of one list."""
    import numpy as np
    import xarray as xr

    names = [name for name, variable in part.data_vars.items() if set(dims) <= set(variable.dims)]
    length = len(places[0])
    # no grips: reads the first one and drops it, since a file cannot be read at no place
    picked = part[names].isel({dim: xr.DataArray(at if length else [0], dims="grip") for dim, at in zip(dims, places)})
    if not length:
        picked = picked.load().isel(grip=slice(0, 0))
    if "worst_effort" in picked:
        with np.errstate(divide="ignore"):
            margin = (1 / picked["worst_effort"]).assign_attrs(units="1", long_name="1 / worst effort")
        picked = picked.assign(held_margin=margin)
    coordinates = {
        name: ("grip", chooser.column(name, places), dict(part[name].attrs) if name in part.coords else {})
        for name in _core.GRIP_COLUMNS
    }
    vessel = np.full(length, str(part["vessel"].values))
    return picked.transpose("grip", ...).assign_coords(
        coordinates | {"vessel": ("grip", vessel), "rank": ("grip", np.arange(1, length + 1), {"units": "1"})}
    )
