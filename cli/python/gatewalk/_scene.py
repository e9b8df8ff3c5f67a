# SPDX-License-Identifier: MIT
"""Scenes: a file, a text or a dict, with keys that are set to other values."""

from __future__ import annotations

import atexit
import contextlib
import contextvars
import difflib
import hashlib
import html
import json
import os
import re
import reprlib
import shutil
import tempfile
import threading
import typing as t

from . import _core
from ._words import input_of, plain, refuse

#: Errors of the program. Errors that a cell of the user raises are passed on unchanged.
OWN_ERRORS = (_core.SceneError, _core.UsageError, _core.BadFile)


class NoSuchKey(_core.UsageError, KeyError):
    """A UsageError that is a KeyError too, as Python expects of a mapping."""

    def __str__(self) -> str:
        return str(self.args[0])


def _toml_value(value: t.Any, key: str) -> str:
    value = plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, list):
        return "[" + ", ".join(_toml_value(v, key) for v in value) + "]"
    if isinstance(value, t.Mapping):
        return "{ " + ", ".join(f"{_toml_key(k)} = {_toml_value(v, f'{key}.{k}')}" for k, v in value.items()) + " }"
    if value is None:
        raise _core.SceneError(f"{key} is None; leave it out")
    raise _core.SceneError(f"{key}: {reprlib.repr(value)} is not permitted: must be a number, a text, True or False, or a list or dict of these")


def _quoted(text: str) -> str:
    """A text as a string of TOML, whose escapes include those of JSON."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _toml_key(key: str) -> str:
    parts = str(key).split(".")
    return ".".join(p if re.fullmatch(r"[A-Za-z0-9_-]+", p) else _quoted(p) for p in parts)


def _toml(tables: t.Mapping[str, t.Any], name: str = "") -> str:
    """A dict of dicts as TOML."""
    lines = [f"{_toml_key(key)} = {_toml_value(value, f'{name}.{key}' if name else str(key))}" for key, value in tables.items() if not isinstance(value, t.Mapping)]
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
    """A scene: one gate, the body, the forces, the field and the start, with a value for every key.

    Parameters
    ----------
    source : path, str or dict
        A scene file, its text, or a dict of its tables. Keys may have other units: ``radius_cm``. Errors call a text or a dict
        ``scene.toml``, and a ``map_file`` in it needs an absolute path.
    set : dict, optional
        Keys to change, ``{"forces.propulsion_N": 1.2}``.

    Raises
    ------
    SceneError, UsageError
        Both are ValueErrors. They name the key or the parameter, and what is allowed. ``scene["no.key"]`` raises a UsageError that
        is a KeyError too.

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
        if isinstance(source, Scene):
            source, set = source._path if source._text is None else source._text, {**source._set, **_keys_of(set)}
        if isinstance(source, t.Mapping):
            self._text = _toml(source)
        elif isinstance(source, str) and "\n" in source:
            self._text = source
        else:
            self._path = _path(source, "source", SUBJECTS)
        self._set: dict[str, t.Any] = _keys_of(set)
        from . import _run

        shown = _run("scene", {"source": self}, {})
        self._keys: list[dict[str, t.Any]] = shown["keys"]
        self._toml: str = shown["scene"]
        #: Sentences: what the numbers mean, and which are far from those of walking animals and robots.
        self.remarks: list[str] = shown["remarks"]

    @property
    def keys(self) -> dict[str, t.Any]:
        """A dict of all keys and their values, in the units that end the keys."""
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
        keys = self.keys
        if not isinstance(key, str) or key not in keys:
            meant = difflib.get_close_matches(str(key), keys, 1)
            raise NoSuchKey(f"the scene has no key {key!r}" + (f"; the closest is {meant[0]}" if meant else ""))
        return keys[key]

    def __contains__(self, key: object) -> bool:
        return key in self.keys

    def with_set(self, set: t.Mapping[str, t.Any]) -> Scene:  # noqa: A002
        """Returns a new scene with these keys changed too. This scene stays as it is."""
        return Scene(self, set)

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


#: What may be given as a scene, or as a file of cells.
SUBJECTS = "a Scene, a path, a text of several lines, or a dict of tables"


def _keys_of(set: t.Any) -> dict[str, t.Any]:  # noqa: A002
    if set is not None and not isinstance(set, t.Mapping):
        refuse("set", 'a dict such as {"forces.random_N": 20}', set)
    return dict(set or {})


def _path(value: t.Any, parameter: str, allowed: str) -> str:
    path = input_of(value, parameter, _core.BadFile if parameter == "matrix" else _core.SceneError, allowed)
    return f"./{path}" if path.startswith("-") else path


_names: contextvars.ContextVar[tuple[tuple[str, str], ...]] = contextvars.ContextVar("names", default=())


@contextlib.contextmanager
def called(name: str, words: str) -> t.Iterator[None]:
    """Within this context, errors and warnings call the file `name` by `words`, because users do not know temporary files."""
    before = _names.set(((name, words), *_names.get()))
    try:
        yield
    finally:
        _names.reset(before)


def renamed(text: str) -> str:
    """A text of the program in which temporary files have the names of `called`."""
    for name, words in _names.get():
        text = text.replace(name, words)
    return text


#: Temporary folders and files of this package begin so.
TEMPORARY = "gatewalk-in-python-"
_TEMPORARY_PATH = re.compile(rf"[^\s'\"]*/{TEMPORARY}\w{{8}}(?:/(?:[0-9a-f]{{16}}/)?|(?P<matrix>\.nc))")


def without_folders(text: str) -> str:
    """A text in which temporary files have names without folders."""
    return _TEMPORARY_PATH.sub(lambda match: "matrix.nc" if match["matrix"] else "", text)


@contextlib.contextmanager
def file_of(subject: t.Any, parameter: str) -> t.Iterator[tuple[str, dict[str, t.Any]]]:
    """A file that a command can read, and the keys that are set on top of it. A text is written to a temporary folder. Raises
    UsageError for an argument that is no scene, matrix, path, text or dict."""
    from ._matrix import Matrix

    if isinstance(subject, Matrix):
        yield subject._path, {}
        return
    if isinstance(subject, Scene) and subject._path is not None:
        yield subject._path, subject._set
        return
    text = subject._text if isinstance(subject, Scene) else _toml(subject) if isinstance(subject, t.Mapping) else subject
    if not isinstance(text, str) or "\n" not in text and text is subject:
        allowed = "a Matrix or a path" if parameter == "matrix" else SUBJECTS + (", or a Matrix" if parameter == "subject" else "")
        yield _path(subject, parameter, allowed), {}
        return
    name = _file_of_text(text, "cell.toml" if parameter == "cell" else "scene.toml")
    with called(name, "the cell" if parameter == "cell" else "scene.toml"):
        yield name, getattr(subject, "_set", {})


_folders: dict[int, str] = {}  # by process id: a forked process makes its own folder


def _file_of_text(text: str, base: str) -> str:
    """A temporary file of that name with that text. The same text gives the same file until the process ends."""
    folder = _folders.get(os.getpid())
    if folder is None:
        folder = _folders[os.getpid()] = tempfile.mkdtemp(prefix=TEMPORARY)
        atexit.register(_remove, folder, os.getpid())
    place = os.path.join(folder, hashlib.sha256(text.encode()).hexdigest()[:16])
    name = os.path.join(place, base)
    if not os.path.exists(name):
        os.makedirs(place, exist_ok=True)
        with open(f"{name}.{threading.get_ident()}", "w", encoding="utf-8") as out:
            out.write(text)
        os.replace(out.name, name)
    return name


def _remove(folder: str, owner: int) -> None:
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)
