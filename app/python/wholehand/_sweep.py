# SPDX-License-Identifier: MIT
"""Every grip of a scene, as a Dataset."""

from __future__ import annotations

import os
import signal
import tempfile
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, NamedTuple

from . import _core
from ._errors import Error, warn
from ._netcdf import LibraryLock, loaded, opened
from ._scene import SceneLike, check_truths, check_types, names_of, scene as as_scene

if TYPE_CHECKING:
    import xarray as xr


class _Ending(NamedTuple):
    is_whole: bool
    signal: int  # that came meanwhile; 0: none
    notes: list[str]


def _go_on(ending: _Ending) -> None:
    """Raises for a signal that came meanwhile, as Python or the user's handler does. Call it when no file is left to clean up: the
    signal may end the process.
    """
    if ending.signal:
        signal.raise_signal(ending.signal)
    if not ending.is_whole:  # and the handler raised nothing
        if ending.signal == signal.SIGINT:
            raise KeyboardInterrupt
        raise Error("the sweep was interrupted by a signal", 130)
    warn(ending.notes, above=1)


def _in_memory(write: Callable[[str], _Ending]) -> tuple[_Ending, xr.Dataset]:
    """What a sweep writes, without the file; nothing of one that was interrupted."""
    import xarray as xr

    with tempfile.TemporaryDirectory(prefix="wholehand-") as folder:
        file = os.path.join(folder, "sweep.nc")
        ending = write(file)
        data = loaded(file) if ending.is_whole else xr.Dataset()
    data.encoding.pop("source", None)
    for variable in data.variables.values():
        variable.encoding.pop("source", None)
    return ending, data


def sweep(
    scene: SceneLike,
    *,
    on: str = "auto",
    precision: str | None = None,
    best: int | None = None,
    keep: str | Iterable[str] | None = None,
    output: str | os.PathLike[str] | None = None,
    threads: int = 0,
    refine: bool = True,
    resume: bool = False,
) -> xr.Dataset:
    """Scores every grip of a scene: ``wholehand sweep`` as an ``xarray.Dataset``.

    It has what the program's result file has, to the bit: the axes of the grips as coordinates, units and long names, and the best
    grips of each vessel. Prints nothing. Sweeps of several threads wait for each other, as do readers of other NetCDF files.

    Parameters
    ----------
    scene : Scene, or what ``wh.scene`` takes
    on : str
        "auto" (the default: a GPU, or a CPU driver that is expected to be faster, where the core needs more than a second), "core",
        "vulkan" (the best device) or the name of a device.
    precision : {"float", "double"}, optional
        Default: double on the core, float on a device.
    best : int, optional
        Grips to list for each vessel. Default: the scene's.
    keep : str or list of str, optional
        Names of ``scene.variables()``. Default: those of the scene.
    output : path, optional
        Keeps the result file here, beside it those that the program writes, and the Dataset reads it as needed. Default: in memory.
    threads : int
        Threads of the core; 0: all.
    refine : bool
        Look for better grips near the best ones.
    resume : bool
        Go on where an interrupted sweep with the same ``output`` ended.

    Returns
    -------
    xarray.Dataset
        Variables over (vessel, azimuth, obliquity, roll, offset, hand_scale, height), or (vessel, point) for Sobol points.

    Raises
    ------
    Error
        What the program refuses, in its line.
    KeyboardInterrupt
        After Ctrl-C, once the work under way is done (well within a second). With ``output``, ``resume=True`` goes on from there.

    >>> import wholehand as wh
    >>> data = wh.sweep("small", on="core")
    >>> data.height.attrs["units"], float(data.score.max().round(4))
    ('m', 0.9305)
    """
    of, kept = as_scene(scene), names_of(keep)
    check_types("sweep", on, precision, best=best, threads=threads)
    check_truths("sweep", refine=refine, resume=resume)

    def write(file: str) -> _Ending:
        with LibraryLock():
            return _Ending(*_core.sweep(of._core, file, on, precision, best, kept, threads, refine, resume))

    if output is not None:
        file = os.fspath(output)
        _go_on(write(file))
        return opened(file)
    if resume:
        raise Error("resume: there is no file to go on with; give output, too")
    ending, data = _in_memory(write)
    _go_on(ending)
    return data
