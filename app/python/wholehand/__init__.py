# SPDX-License-Identifier: MIT
"""Whole-hand grasping with a two-finger gripper: score the grips of a scene, look at one, feel them.

    import wholehand as wh

    scene = wh.scene("three_beakers")          # or a path, a TOML text, a dict
    data = wh.sweep(scene, on="vulkan")        # every grip of the scene: an xarray.Dataset
    found = wh.evaluate(scene, "beaker1", grips)   # any grips: arrays in, arrays out
    g = wh.grip(scene, "beaker1", height_mm=58.5, roll_deg=22)  # one, with every intermediate value
    best = wh.best(data, n=5, apart_mm=25)     # the best that differ
    wh.check(scene)                            # is the device's answer the core's answer?
    with wh.session("mixing_board") as s:      # what the fingers feel
        out = s.step(position, rotation, gap)

Units are SI (m, kg, s, N, rad) unless a name says otherwise (height_mm, roll_deg). The vessel's frame has its origin at the
vessel's base and +y along its axis. The world frame has +y up. What cannot be done raises ``wh.Error`` with the line that the
program ``wholehand`` prints.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._best import best
from ._check import Check, check
from ._core import version as _version
from ._errors import Error, Note
from ._evaluate import evaluate, grip_dtype as _grip_dtype, grips_of as grips
from ._grip import Drawing, Grip, grip
from ._mesh import Mesh, mesh
from ._scene import Scene, Variable, new, scene, scenes
from ._session import Hand, Session, Step, session
from ._sweep import sweep

if TYPE_CHECKING:
    import numpy as np

    GRIP: np.dtype[np.void]

__version__: str = _version()

__all__ = [
    "GRIP",
    "Check",
    "Drawing",
    "Error",
    "Grip",
    "Hand",
    "Mesh",
    "Note",
    "Scene",
    "Session",
    "Step",
    "Variable",
    "best",
    "check",
    "evaluate",
    "grip",
    "grips",
    "mesh",
    "new",
    "scene",
    "scenes",
    "session",
    "sweep",
]


def __getattr__(name: str) -> Any:
    # NumPy takes longer to import than all of this
    if name == "GRIP":
        globals()["GRIP"] = _grip_dtype()
        return globals()["GRIP"]
    raise AttributeError(f"module 'wholehand' has no attribute {name!r}")
