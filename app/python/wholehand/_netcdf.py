# SPDX-License-Identifier: MIT
"""The NetCDF library is not safe for two threads: here it is used under one lock.

A sweep writes with it while Python's other threads run, and Python's netCDF4 lets them run, too. xarray takes its lock when it
reads values, but neither when it opens a file nor when it closes one.
"""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr


class _Held(threading.local):
    times = 0


_held = _Held()


class LibraryLock:
    """xarray's lock of the NetCDF library, which a thread that holds it may take again. It has no state of its own, so that
    Datasets which have it travel to other processes.
    """

    def __enter__(self) -> LibraryLock:
        from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

        if _held.times == 0:
            NETCDF4_PYTHON_LOCK.__enter__()
        _held.times += 1
        return self

    def __exit__(self, *_: object) -> None:
        from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

        _held.times -= 1
        if _held.times == 0:
            NETCDF4_PYTHON_LOCK.__exit__(None, None, None)


def opened(file: str) -> xr.Dataset:
    """What ``xarray.open_dataset`` gives but for the checksums, with the library under the lock from opening to ``close()``. The
    garbage collector closes without it.
    """
    import xarray as xr

    lock = LibraryLock()
    with lock:
        data = xr.open_dataset(file, engine="netcdf4", lock=lock, drop_variables="checksums")
    data.set_close(functools.partial(_close, data._close))
    return data


def loaded(file: str) -> xr.Dataset:
    """The same in memory. The file is closed again."""
    with opened(file) as stored:
        return stored.load()


def _close(close: Callable[[], None] | None) -> None:
    if close is not None:
        with LibraryLock():
            close()
