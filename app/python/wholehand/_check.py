# SPDX-License-Identifier: MIT
"""Is a device's answer the core's answer?"""

from __future__ import annotations

import json
from typing import Any

from . import _core
from ._errors import Error
from ._scene import SceneLike, check_types, scene as as_scene


class Check:
    """What ``wh.check`` found. ``str(check)`` and ``repr(check)`` are what the program prints."""

    def __init__(self, passed: bool, text: str, report: dict[str, Any]) -> None:
        self.passed = passed
        self.text = text
        self.report = report
        """The program's JSON (docs/evidence.md)."""

    def __bool__(self) -> bool:
        return self.passed

    @property
    def rows(self) -> list[dict[str, Any]]:
        """A row for each comparison and quantity: "comparison", "kernel", "quantity", "worst", "tolerance", "unit", "compared",
        "outside", ...
        """
        return [{"comparison": one["name"], **row} for one in self.report["comparisons"] for row in one["quantities"]]

    def __repr__(self) -> str:
        return self.text


def check(scene: SceneLike = "three_beakers", *, on: str = "vulkan") -> Check:
    """Compares a device with the core, in float and in double: each kernel, and whole grips. ``wholehand check``.

    Parameters
    ----------
    scene : Scene, or what ``wh.scene`` takes
    on : str
        "vulkan" (the best device) or the name of a device.

    Returns
    -------
    Check
        ``passed``, ``rows`` (a table), ``report`` (everything).

    Raises
    ------
    Error
        The core as a device, a device that is not there or does not answer, a module built without evidence.
    """
    of = as_scene(scene)
    check_types("check", on)
    if not hasattr(_core, "check"):
        raise Error("check: this module is built without evidence (WHOLEHAND_EVIDENCE)")
    passed, text, report = _core.check(of._core, on)
    return Check(passed, text, json.loads(report))
