# SPDX-License-Identifier: MIT
"""A scene that is a dict, as the TOML text that describes it. Python reads TOML and does not write it."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from typing import Any

from ._errors import Error, encodable

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def _text(value: str) -> str:
    return json.dumps(encodable(value, "dict: the text "), ensure_ascii=False).replace("\x7f", "\\u007f")


def _key(key: object, place: str) -> str:
    if not isinstance(key, str):
        raise Error(f"dict: the key {key!r}{place and ' of ' + place} is no text; allowed: the keys of docs/scene.md")
    return key if _BARE_KEY.fullmatch(key) else _text(key)


def _plain(value: Any) -> Any:
    """NumPy's arrays and numbers as Python's."""
    return value.tolist() if hasattr(value, "tolist") else value


def _value(value: Any, place: str) -> str:
    value = _plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(_lines(value, place)) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(one, place) for one in value) + "]"
    allowed = "a number, a text, a path, a truth value, a list or a dict of them"
    raise Error(f"dict: {place} is {type(value).__name__}; allowed: {allowed}")


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(one, Mapping) for one in value)


def _lines(table: Mapping[str, Any], place: str) -> list[str]:
    return [f"{_key(k, place)} = {_value(v, f'{place}.{k}')}" for k, v in table.items()]


def toml_text(scene: Mapping[str, Any]) -> str:
    """A table or a list of tables becomes a section of its own, and each of its keys a line."""
    plain, sections = [], []
    for key, value in scene.items():
        name = _key(key, "")
        if isinstance(value, Mapping):
            sections += ["", f"[{name}]", *_lines(value, str(key))]
        elif _is_tables(value):
            for one in value:
                sections += ["", f"[[{name}]]", *_lines(one, str(key))]
        else:
            plain.append(f"{name} = {_value(value, str(key))}")
    return "\n".join(plain + sections).lstrip("\n") + "\n"
