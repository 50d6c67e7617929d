# SPDX-License-Identifier: MIT
"""Surveys of mesh files."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from . import _core
from ._errors import Error, encodable
from ._grip import Drawing
from ._scene import Scene, numbers_of, scene_of_text


class Mesh(Mapping[str, Any]):
    """What a mesh file is, and the scene that makes a vessel of it. Made by ``wh.mesh``.

    A mapping of what ``wholehand mesh --json`` prints: lengths in mm, volumes in mL. ``str(mesh)`` is the program's text; a
    notebook shows the section.
    """

    def __init__(self, survey: _core.Survey) -> None:
        self._survey = survey
        self._values: dict[str, Any] = json.loads(survey.json())

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def scene(self, name: str = "vessel", *, fill_ml: float | None = None, **numbers: float) -> Scene:
        """A complete scene of this vessel, as ``wh.new`` makes one. Raises Error."""
        fill = None if fill_ml is None else float(fill_ml)
        return scene_of_text(self._survey.scene_text(encodable(name), numbers_of(numbers, "scene", "fill_ml"), fill), "text")

    def plot(self) -> Drawing:
        """The section through the axis: walls, inner outline, and liquid at half of what the outline holds."""
        return Drawing(self._survey.svg())

    def _repr_svg_(self) -> str:
        return self._survey.svg()

    def __str__(self) -> str:
        return "\n".join(self._survey.lines())

    def __repr__(self) -> str:
        cavity = self._values["cavity"]
        holds = f"holds {cavity['capacity_ml']:.4g} mL" if cavity else "no cavity"
        return f"<Mesh {self._values['file']}: {holds}>"


def mesh(
    file: str | os.PathLike[str],
    *,
    scale: float | None = None,
    up: str | None = None,
    part: int | Sequence[int] = (),
    thickness_mm: float | None = None,
) -> Mesh:
    """Surveys a mesh file: size, unit, upward axis, parts, holes, cavity. What is not given is found.

    Parameters
    ----------
    file : path
        glTF, STL, OBJ, PLY, OFF or Collada.
    scale : float, optional
        Size of the file's unit in m.
    up : "y" or "z", optional
        Upward axis of the file.
    part : int or ints
        The parts that are taken, from 1.
    thickness_mm : float, optional
        Thickness of a sheet that has none.

    Raises
    ------
    Error
        The file, and why it cannot be used.
    """
    if up not in (None, "y", "z"):
        raise Error(f"mesh: up = {up!r}; allowed: 'y' or 'z'")
    parts = [part] if isinstance(part, int) else list(part)
    thickness = None if thickness_mm is None else 1e-3 * thickness_mm
    return Mesh(_core.survey_mesh(encodable(os.fspath(file)), scale, None if up is None else up == "z", parts, thickness))
