# SPDX-License-Identifier: MIT
"""Scenes: a file, a text or a dict, and keys that are set."""

from __future__ import annotations

import atexit
import contextlib
import hashlib
import html
import json
import os
import re
import shutil
import tempfile
import threading
import typing as t

from . import _core


#: What the program says; a cell's own errors come out as they are.
OWN_ERRORS = (ValueError, _core.SceneError, _core.UsageError, _core.BadFile)


def _toml_value(value: t.Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if hasattr(value, "tolist"):
        return _toml_value(value.tolist())
    if isinstance(value, float):
        return repr(float(value))
    if isinstance(value, int):
        return repr(int(value))
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml_value(v) for v in value) + "]"
    if isinstance(value, t.Mapping):
        return "{ " + ", ".join(f"{_toml_key(k)} = {_toml_value(v)}" for k, v in value.items()) + " }"
    if value is None:
        raise _core.SceneError("a key is None; leave it out")
    return _quoted(str(value))


def _quoted(text: str) -> str:
    """A string of TOML; JSON's escapes are among its own."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _toml_key(key: str) -> str:
    parts = str(key).split(".")
    return ".".join(p if re.fullmatch(r"[A-Za-z0-9_-]+", p) else _quoted(p) for p in parts)


def _toml(tables: t.Mapping[str, t.Any], name: str = "") -> str:
    """A dict of dicts as TOML."""
    lines = [f"{_toml_key(key)} = {_toml_value(value)}" for key, value in tables.items() if not isinstance(value, t.Mapping)]
    text = (f"[{name}]\n" if name else "") + "".join(line + "\n" for line in lines)
    for key, value in tables.items():
        if isinstance(value, t.Mapping):
            text += _toml(value, f"{name}.{_toml_key(key)}" if name else _toml_key(key))
    return text


def _table_html(rows: t.Iterable[t.Sequence[t.Any]], head: t.Sequence[str]) -> str:
    def cells(values: t.Sequence[t.Any], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(v))}</{tag}>" for v in values) + "</tr>"

    return "<table>" + cells(head, "th") + "".join(cells(row, "td") for row in rows) + "</table>"


def _list_html(rows: t.Iterable[str]) -> str:
    return "<ul>" + "".join(f"<li>{html.escape(row)}</li>" for row in rows) + "</ul>"


class Scene:
    """A scene of gates, with every key.

    Parameters
    ----------
    source : path, str or dict
        A scene file; its text; or tables as a dict (errors call both scene.toml; a map_file in them has a whole path).
        Keys may have other units: ``radius_cm``.
    set : dict, optional
        Keys with other values, ``{"forces.propulsion_N": 1.2}``.

    Raises
    ------
    SceneError
        A ValueError naming the key and what is allowed.

    Examples
    --------
    >>> import gatewalk as gw
    >>> scene = gw.Scene({"forces": {"propulsion_N": 7.0}}, {"forces.random_N": 40.0})
    >>> scene["forces.random_N"]
    40.0
    >>> scene.with_set({"forces.random_N": 20.0})["forces.random_N"]
    20.0
    >>> gw.Scene({"forces": {"propulsion_N": -1.0}})
    Traceback (most recent call last):
        ...
    gatewalk._core.SceneError: scene.toml:2: forces.propulsion_N = -1.0 is not permitted: must lie in [0, 1e+100] N
    """

    def __init__(self, source: t.Any, set: t.Mapping[str, t.Any] | None = None) -> None:  # noqa: A002
        self._path: str | None = None
        self._text: str | None = None
        if isinstance(source, t.Mapping):
            self._text = _toml(source)
        elif isinstance(source, str) and "\n" in source:
            self._text = source
        else:
            path = os.fspath(source)
            self._path = f"./{path}" if path.startswith("-") else path
        self._set: dict[str, t.Any] = dict(set or {})
        from . import _run

        shown = _run("scene", [self], {})
        self._keys: list[dict[str, t.Any]] = shown["keys"]
        self._toml: str = shown["scene"]
        #: What its numbers mean, and where they are far from what walks; sentences.
        self.remarks: list[str] = shown["remarks"]

    @property
    def keys(self) -> dict[str, t.Any]:
        """All keys with their values, in the units of their names (n values)."""
        return {row["key"]: self._value(row) for row in self._keys}

    @staticmethod
    def _value(row: dict[str, t.Any]) -> t.Any:
        text = row["value"]
        if isinstance(text, str) and text.startswith('"'):
            return json.loads(text)
        for kind in (int, float):
            with contextlib.suppress(ValueError, TypeError):
                return kind(text)
        return {"true": True, "false": False}.get(text, text) if isinstance(text, str) else text

    def __getitem__(self, key: str) -> t.Any:
        return self.keys[key]

    def with_set(self, set: t.Mapping[str, t.Any]) -> Scene:  # noqa: A002
        """The scene with these keys too; this one stays as it is."""
        return Scene(self._path if self._text is None else self._text, {**self._set, **set})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self._toml == other._toml

    def __hash__(self) -> int:
        return hash(self._toml)

    def __repr__(self) -> str:
        of = "of a text" if self._path is None else repr(self._path)
        return f"<gatewalk.Scene {of}{', ' + repr(self._set) if self._set else ''}>"

    def _repr_html_(self) -> str:
        return _table_html(((r["key"], r["value"], r["unit"], r["meaning"], r["source"]) for r in self._keys),
                           ("key", "value", "unit", "meaning", "from")) + _list_html(self.remarks)


@contextlib.contextmanager
def called(name: str, words: str) -> t.Iterator[None]:
    """Errors about a file that means nothing to anybody call it so."""
    try:
        yield
    except ValueError as error:
        if type(error) not in OWN_ERRORS:
            raise
        raise type(error)(str(error).replace(name, words)) from error.__cause__


@contextlib.contextmanager
def file_of(subject: t.Any) -> t.Iterator[tuple[str, dict[str, t.Any]]]:
    """A file that a command can read, and the keys set on top of it; a text is written to a folder of its own."""
    path = getattr(subject, "_path", None)
    if path is not None:  # a scene of a file, a matrix
        yield path, getattr(subject, "_set", {})
        return
    if isinstance(subject, (str, os.PathLike)) and not (isinstance(subject, str) and "\n" in subject):
        yield os.fspath(subject), {}
        return
    text = subject._text if isinstance(subject, Scene) else _toml(subject) if isinstance(subject, t.Mapping) else str(subject)
    name = _file_of_text(t.cast(str, text))
    with called(name, "scene.toml"):
        yield name, getattr(subject, "_set", {})


_folders: dict[int, str] = {}  # by process: a forked one makes its own


def _file_of_text(text: str) -> str:
    """A file with that text, the same one for the same text until the process ends."""
    folder = _folders.get(os.getpid())
    if folder is None:
        folder = _folders[os.getpid()] = tempfile.mkdtemp(prefix="gatewalk-")
        atexit.register(_remove, folder, os.getpid())
    place = os.path.join(folder, hashlib.sha256(text.encode()).hexdigest()[:16])
    name = os.path.join(place, "scene.toml")
    if not os.path.exists(name):
        os.makedirs(place, exist_ok=True)
        with open(f"{name}.{threading.get_ident()}", "w", encoding="utf-8") as out:
            out.write(text)
        os.replace(out.name, name)
    return name


def _remove(folder: str, owner: int) -> None:
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)


def is_of_text(name: str) -> bool:
    """Whether it is a file of _file_of_text."""
    folder = _folders.get(os.getpid())
    return folder is not None and name.startswith(folder + os.sep)
