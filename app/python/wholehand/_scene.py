# SPDX-License-Identifier: MIT
"""Scenes: hands, vessels, liquids, and the grips that a sweep goes through."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Union

from . import _core
from ._errors import Error, encodable, wrong_type
from ._toml import toml_text

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

SceneLike = Union["Scene", str, "os.PathLike[str]", Mapping[str, Any]]


class Variable(NamedTuple):
    """What can be known of a grip. ``dims`` are those beside the grips, the slowest first."""

    units: str
    long_name: str
    comment: str
    dims: tuple[str, ...]


class Scene:
    """A scene that has been read and checked. Made by ``wh.scene``.

    It does not change, and any number of threads may use it. It keeps what was made of it (meshes, an evaluator, open devices) for
    the next call. A pickled scene is its text.

    >>> import wholehand as wh
    >>> scene = wh.scene("three_beakers")
    >>> scene.vessels
    ('beaker1', 'beaker2', 'beaker3')
    >>> scene.fills("beaker1")
    array([0.  , 0.25, 0.5 , 0.75, 1.  ])
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.Scene) -> None:
        self._core = core

    @property
    def name(self) -> str:
        """The scene's own name, or its file's."""
        return self._core.name

    @property
    def file(self) -> str:
        """Where it was read from; "text" or "dict" for others, unless a file was named. Meshes are looked for from its folder."""
        return self._core.file

    @property
    def text(self) -> str:
        """The TOML text."""
        return self._core.text

    @property
    def vessels(self) -> tuple[str, ...]:
        """The vessels' names. Where a vessel is asked for, its name or its number in this tuple is allowed."""
        return tuple(self._core.vessels)

    @property
    def tilts(self) -> npt.NDArray[np.float64]:
        """The tilts of a sweep's states, rad, shape (tilts,)."""
        import numpy as np

        return np.array(self._core.tilts)

    def fills(self, vessel: str | int) -> npt.NDArray[np.float64]:
        """The fills of a sweep's states, as fractions of the vessel's capacity, shape (fills,). Without liquid: one, 0.

        Raises Error for a vessel that is not there.
        """
        import numpy as np

        return np.array(self._core.fills(vessel_number(self, vessel)))

    def variables(self) -> dict[str, Variable]:
        """What ``evaluate`` and ``sweep(keep=...)`` can tell of a grip in this scene, by name, in the order of the result file."""
        return {row[0]: Variable(*row[1:]) for row in self._core.variables()}

    def notes(self) -> list[str]:
        """What the program prints of the scene on standard error: what was found of meshes, and what may not be meant. Reads the
        meshes.
        """
        return self._core.notes()

    def __repr__(self) -> str:
        return f"<Scene {self.name}: {', '.join(self.vessels)}>"

    def __reduce__(self) -> tuple[Any, tuple[str, str]]:
        return scene_of_text, (self.text, self.file)


def scene_of_text(text: str, file: str) -> Scene:
    return Scene(_core.parse_scene(text, file))


def scene(source: SceneLike = "three_beakers", *, file: str | os.PathLike[str] | None = None) -> Scene:
    """Reads a scene.

    Parameters
    ----------
    source : str, path or dict
        The name of a scene that is shipped (``wh.scenes()``), the path of a TOML file, a TOML text (a ``str`` of more than one
        line), or a dict with the keys of docs/scene.md, which may have NumPy's numbers and arrays, and paths (``pathlib.Path``) as
        texts. A Scene is returned as it is.
    file : path, optional
        For a text or a dict: the file that it stands for in messages. Meshes are looked for from its folder, else from the current
        one.

    Raises
    ------
    Error
        The place, what was found, and what is allowed. For a dict the place is in the TOML text that was made of it; the exception
        has that line as a note.

    >>> import wholehand as wh
    >>> glass = {"name": "tumbler", "outline": [{"line": [32, 0]}, {"line": [32, 90]}, {"line": [0, 90]}], "wall_mm": 2}
    >>> wh.scene({"vessel": [glass], "grips": {"height_mm": [30, 60]}})
    <Scene dict: tumbler>
    >>> try:
    ...     wh.scene({"vessel": [glass | {"wall_mm": 0}]})
    ... except wh.Error as error:
    ...     print(error, *error.__notes__, sep=chr(10))
    dict:4:11: wall_mm = 0; allowed: 0.05 to 100
    dict:4:11: wall_mm = 0
    """
    if isinstance(source, Scene):
        return source
    if isinstance(source, Mapping):
        return _scene_of_dict(toml_text(source), "dict" if file is None else os.fspath(file))
    if isinstance(source, str) and "\n" in source:
        return scene_of_text(encodable(source), "text" if file is None else os.fspath(file))
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f"scene: {type(source).__name__}; allowed: a name, a path, a TOML text, a dict or a Scene")
    return Scene(_core.open_scene(encodable(os.fspath(source))))


def _scene_of_dict(text: str, name: str) -> Scene:
    """Adds the line that a message means as a note: nobody has seen the text that was made of a dict."""
    try:
        return scene_of_text(text, name)
    except Error as error:
        place = re.match(re.escape(name) + r":(\d+):\d+: ", str(error))
        lines = text.splitlines()
        if place and int(place[1]) <= len(lines):
            error.add_note(f"{place[0]}{lines[int(place[1]) - 1]}")
        raise


def new(
    name: str = "vessel",
    *,
    shape: str = "cylinder",
    mesh: str | os.PathLike[str] | None = None,
    fill_ml: float | None = None,
    **numbers: float,
) -> Scene:
    """A complete scene of one vessel: table, arm, liquid, strength, grips, tilts, deviations. Its ``text`` is commented TOML.

    Parameters
    ----------
    name : str
        Name of the scene and of its vessel.
    shape : "cylinder", "flask" or "conical"
        With its dimensions as ``diameter_mm``, ``height_mm``, ``neck_mm``, ``upright_mm``, ``shoulder_mm``, and ``wall_mm`` and
        ``density_kg_m3`` of its wall (1.5 mm of glass): the keys of ``[[vessel]]`` in docs/scene.md.
    mesh : path, optional
        Instead of a shape, with the keys that ``wh.mesh`` finds; ``mass_kg``, ``density_kg_m3`` or ``mesh_scale`` may be given.
    fill_ml : float, optional
        The grips are judged with the vessel empty and with so much. Else at five fills up to the brim.

    Raises
    ------
    Error
        The key, what was given, and what is allowed.

    >>> import wholehand as wh
    >>> glass = wh.new("glass", diameter_mm=70, height_mm=120, fill_ml=250)
    >>> glass
    <Scene glass: glass>
    >>> try:
    ...     wh.new("flask", shape="flask", diameter_mm=70, height_mm=120)
    ... except wh.Error as error:
    ...     print(error)
    [[vessel]] lacks 'neck_mm'; allowed: a flask with diameter_mm, neck_mm, height_mm
    """
    fill = None if fill_ml is None else float(fill_ml)
    if mesh is not None:
        given = numbers_of(numbers, "new", "shape, mesh, fill_ml")
        scale = dict(given).get("mesh_scale")
        survey = _core.survey_mesh(encodable(os.fspath(mesh)), scale, None, (), None)
        return scene_of_text(survey.scene_text(encodable(name), given, fill), "text")
    return scene_of_text(_core.new_scene(encodable(name), encodable(shape), numbers_of(numbers, "new", "shape, mesh, fill_ml"), fill), "text")


def numbers_of(numbers: Mapping[str, float], caller: str, others: str) -> list[tuple[str, float]]:
    """Keywords in the order of a scene. Raises TypeError, which names the caller and its other keywords."""
    known = _core.new_scene_keys()
    for key, value in numbers.items():
        if key not in known:
            raise TypeError(f"{caller}: {key} is no keyword; allowed: {others}, {', '.join(known)}")
        if isinstance(value, bool) or not hasattr(value, "__float__"):
            raise wrong_type(caller, key, value, "a number")
    return [(key, float(numbers[key])) for key in known if key in numbers]


def scenes() -> list[str]:
    """The names of the scenes that are shipped.

    >>> import wholehand as wh
    >>> wh.scenes()
    ['mixing_board', 'paper_pose', 'small', 'three_beakers']
    """
    return _core.shipped_scenes()


def vessel_number(of: Scene, vessel: str | int) -> int:
    """The place of a vessel by its name or number. Raises Error."""
    if isinstance(vessel, str):
        return of._core.find_vessel(encodable(vessel))
    if isinstance(vessel, bool) or not hasattr(vessel, "__index__"):
        raise TypeError(f"vessel: {type(vessel).__name__}; allowed: its name or its number")
    number = int(vessel)
    if not 0 <= number < len(of.vessels):
        raise Error(f"vessel {number}: the scene has {len(of.vessels)}; allowed: 0 to {len(of.vessels) - 1}, or a name")
    return number


def names_of(names: str | Iterable[str] | None) -> list[str] | None:
    """The names of variables. Raises TypeError."""
    if names is None:
        return None
    listed: list[Any] = list(names) if isinstance(names, Iterable) and not isinstance(names, str) else [names]
    for name in listed:
        if not isinstance(name, str):
            raise TypeError(f"variables: {type(name).__name__} among the names; allowed: names of scene.variables()")
    return [encodable(name) for name in listed]


def check_types(call: str, on: str, precision: str | None = None, **numbers: int | None) -> None:
    """Raises TypeError for options of another kind, and Error for whole numbers that no call takes."""
    for name, text in (("on", on), ("precision", precision)):
        if not isinstance(text, str) and not (name == "precision" and text is None):
            raise wrong_type(call, name, text, "a text")
    for name, number in numbers.items():
        if number is None:
            continue
        if isinstance(number, bool) or not hasattr(number, "__index__"):
            raise wrong_type(call, name, number, "a whole number")
        if abs(int(number)) >= 1 << 31:
            raise Error(f"{call}: {name} is {int(number)}, which is too large")


def check_truths(call: str, **values: bool) -> None:
    """Raises TypeError."""
    for name, value in values.items():
        if not isinstance(value, bool):
            raise wrong_type(call, name, value, "True or False")
