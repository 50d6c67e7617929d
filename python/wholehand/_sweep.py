# SPDX-License-Identifier: MIT
"""Every grip of a scene, as a Dataset."""

from __future__ import annotations

import os
import signal
import tempfile
from collections.abc import Iterable
from typing import TYPE_CHECKING

from . import _core
from ._errors import Error, warn
from ._scene import Scene, SceneLike, names_of, scene as as_scene

if TYPE_CHECKING:
    import xarray as xr


def _run(
    of: Scene,
    output: str,
    on: str,
    precision: str | None,
    best: int | None,
    keep: list[str] | None,
    threads: int,
    refine: bool,
    resume: bool,
) -> list[str]:
    """Writes the result file. The NetCDF library, which xarray uses too, is no library for two threads: its lock is held
    meanwhile.
    """
    from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

    with NETCDF4_PYTHON_LOCK:
        ended_by, notes = _core.sweep(of._core, output, on, precision, best, keep, threads, refine, resume)
    if ended_by:
        signal.raise_signal(ended_by)  # what was meant for Python goes on there
        if ended_by == signal.SIGINT:
            raise KeyboardInterrupt
        raise Error("the sweep was interrupted by a signal", 130)
    return notes


def sweep(
    scene: SceneLike,
    *,
    on: str = "vulkan",
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
    grips of each vessel. Nothing is printed. Sweeps of several threads wait for each other, as do readers of other NetCDF files.

    Parameters
    ----------
    scene : Scene, or what ``wh.scene`` takes
    on : str
        "core", "vulkan" (the best device, the default) or the name of a device.
    precision : {"float", "double"}, optional
        Default: double on the core, float on a device.
    best : int, optional
        Grips to list for each vessel. Default: the scene's.
    keep : str or list of str, optional
        Names of ``scene.variables()``. Default: those of the scene.
    output : path, optional
        Keep the result file here, with the files that the program writes beside it. The Dataset is then read from it as it is
        needed; without, it is in memory.
    threads : int
        Of the core; 0: all.
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
    >>> data.score.dims
    ('vessel', 'azimuth', 'obliquity', 'roll', 'offset', 'hand_scale', 'height')
    >>> data.height.attrs["units"], float(data.score.max().round(4))
    ('m', 0.943)
    """
    import xarray as xr

    of, kept = as_scene(scene), names_of(keep)
    if output is not None:
        file = os.fspath(output)
        warn(_run(of, file, on, precision, best, kept, threads, refine, resume))
        return xr.open_dataset(file)
    if resume:
        raise Error("resume: there is no file to go on with; give output, too")
    with tempfile.TemporaryDirectory(prefix="wholehand-") as folder:
        file = os.path.join(folder, "sweep.nc")
        notes = _run(of, file, on, precision, best, kept, threads, refine, False)
        with xr.open_dataset(file) as stored:
            data: xr.Dataset = stored.load()
    data.encoding.pop("source", None)  # is gone
    for name in data.variables:
        data[name].encoding.pop("source", None)
    warn(notes)
    return data
