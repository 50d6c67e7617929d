# SPDX-License-Identifier: MIT
"""What goes wrong, and what is worth a look."""

from __future__ import annotations

import warnings
from collections.abc import Iterable


class Error(Exception):
    """What wholehand cannot do, in the line that the program prints.

    ``exit_code`` is the program's: 2 for a scene, a name or a number that is not allowed, 3 where the system or a device fails,
    130 where a signal ended the work.

    >>> import wholehand as wh
    >>> try:
    ...     wh.grip("small", "tumbler", height_mm=45, roll_deg=400)
    ... except wh.Error as error:
    ...     print(error.exit_code, error)
    2 --roll-deg '400'; allowed: a number, -360 to 360
    """

    exit_code: int

    def __init__(self, line: str, exit_code: int = 2) -> None:
        super().__init__("".join(c if c >= " " else " " for c in line))  # one line, whatever a caller's names have
        self.exit_code = exit_code

    def __reduce__(self) -> tuple[type[Error], tuple[str, int]]:
        return type(self), (str(self), self.exit_code)


class Note(UserWarning):
    """A line that the program prints on standard error beside its work: what a scene may not mean, or where float is not enough."""


def wrong_type(call: str, name: str, value: object, allowed: str) -> TypeError:
    """For an argument of a type that a call does not take."""
    return TypeError(f"{call}: {name} is {type(value).__name__}; allowed: {allowed}")


def encodable(text: str, what: str = "") -> str:
    """The text itself. Raises Error for lone surrogates, which UTF-8 cannot encode."""
    try:
        text.encode()
    except UnicodeEncodeError:
        raise Error(f"{what}{text!r} has a character that is none; allowed: Unicode") from None
    return text


def warn(lines: Iterable[str], above: int = 0) -> None:
    """Each line as a Note at the place of the call that the user wrote: that of the caller, or of so many above it."""
    for line in lines:
        warnings.warn(line.removeprefix("note: "), Note, stacklevel=3 + above)
