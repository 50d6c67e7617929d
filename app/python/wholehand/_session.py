# SPDX-License-Identifier: MIT
"""Live sessions: what a gripper says in, what the fingers feel and the whole hand out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import Error, wrong_type
from ._scene import SceneLike, scene as as_scene

if TYPE_CHECKING:
    from types import TracebackType

    import numpy.typing as npt

Step = _core.Step
Hand = _core.Hand


class Session:
    """A live session. Made by ``wh.session``; closed at the end of its ``with`` block, or by ``close()``.

    It belongs to the thread of its first step. Each step is a period of 1 / rate of the scene's [live], and takes some
    microseconds.
    """

    def __init__(self, core: _core.Session) -> None:
        self._core = core

    @property
    def gap(self) -> tuple[float, float]:
        """The gripper's closed and open gap, m. (0, 0) once it is closed."""
        closed, opened = self._core.gap
        return closed, opened

    @property
    def period(self) -> float:
        """Between two steps, s. 0 once it is closed."""
        return self._core.period

    def step(
        self,
        position: npt.ArrayLike,
        rotation: npt.ArrayLike | None = None,
        gap: float | None = None,
        buttons: int = 0,
        *,
        tick: int | None = None,
    ) -> Step:
        """One measurement of the gripper, and what comes of it.

        Parameters
        ----------
        position : array of shape (3,)
            The middle between the two tracked points, m, device frame: +x to the right, +y up, +z towards the person.
        rotation : array of shape (3, 3), optional
            The gripper's, in the device frame. Default: no rotation, the palm away from the person.
        gap : float, optional
            Between the two tracked points, m. Default: open.
        buttons : int
            Bit k: button k is pressed.
        tick : int, optional
            The number of the period, greater than the one before. Default: the next.

        Returns
        -------
        Step
            State, forces (N), vessel, and the hand. It stays as it is when the session goes on.

        Raises
        ------
        Error
            Another shape, a number that is not finite, a rotation that is none, a closed session, another thread. The session then
            stays as it was.
        """
        opened = self._core.gap[1] if gap is None else gap
        try:
            return self._core.step(position, rotation, opened, buttons, tick)
        except TypeError:
            raise Error(_refusal(position, rotation, opened, buttons, tick)) from None

    def hand(self) -> Hand:
        """The whole hand of the last step, world frame, m. Raises Error before the first step."""
        return self._core.last().hand()

    def close(self) -> None:
        """Ends the session. A closed one raises Error on every step."""
        self._core.close()

    @property
    def closed(self) -> bool:
        """Whether it has been closed."""
        return self._core.closed

    def __enter__(self) -> Session:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        return "<Session: closed>" if self.closed else f"<Session: {1 / self.period:.6g} Hz>"


def _refusal(*given: Any) -> str:
    names = ("position", "rotation", "gap", "buttons", "tick")
    kinds = ", ".join(f"{name} {type(value).__name__}" for name, value in zip(names, given) if value is not None)
    return f"session: a step takes numbers: position (3,), rotation (3, 3), gap, buttons and tick; found {kinds}"


def session(scene: SceneLike = "mixing_board", *, gap: tuple[float, float] | None = None) -> Session:
    """Opens a live session: the forces of ``wholehand live``, for a gripper that is yours.

    Parameters
    ----------
    scene : Scene, or what ``wh.scene`` takes
        Its vessels stand apart: each has a place_mm.
    gap : two floats, optional
        The gripper's closed and open gap, m. Default: the scene's [device] gap_mm, else the hand's own.

    Raises
    ------
    Error
        A scene that cannot be played, a gap that is no range.

    >>> import wholehand as wh
    >>> with wh.session("mixing_board") as s:
    ...     for _ in range(3):
    ...         out = s.step([0, 0.3, 0.2], None, 0.1)
    >>> out.state, out.vessel, out.arm_force.tolist(), out.joints.shape
    ('free', None, [0.0, 0.0, 0.0], (24, 3))
    """
    try:
        range_of_gaps = None if gap is None else [float(one) for one in gap]
    except (TypeError, ValueError, OverflowError):
        raise wrong_type("session", "gap", gap, "two numbers, closed and open, in m") from None
    if range_of_gaps is not None and len(range_of_gaps) != 2:
        raise Error(f"session: gap has {len(range_of_gaps)} numbers; allowed: two, closed and open, in m")
    return Session(_core.Session(as_scene(scene)._core, range_of_gaps))
