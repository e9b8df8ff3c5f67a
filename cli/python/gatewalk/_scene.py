"""Scenes: a file, a text or a dict, and keys that are set."""

from __future__ import annotations

import contextlib
import html
import os
import tempfile
import typing as t

from . import _core


def _toml_value(value: t.Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml_value(v) for v in value) + "]"
    if hasattr(value, "tolist"):
        return _toml_value(value.tolist())
    text = str(value).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{text}"'


def _toml(tables: t.Mapping[str, t.Any], name: str = "") -> str:
    """A dict of dicts as TOML."""
    lines = [f"{key} = {_toml_value(value)}" for key, value in tables.items()
             if not isinstance(value, t.Mapping) and not (isinstance(value, list) and value and isinstance(value[0], t.Mapping))]
    text = (f"[{name}]\n" if name else "") + "".join(line + "\n" for line in lines)
    for key, value in tables.items():
        full = f"{name}.{key}" if name else key
        if isinstance(value, t.Mapping):
            text += _toml(value, full)
        elif isinstance(value, list) and value and isinstance(value[0], t.Mapping):
            for row in value:
                text += f"[{full}]\n".replace("[", "[[", 1).replace("]", "]]", 1) + _toml(row)
    return text


def _table_html(rows: t.Iterable[t.Sequence[t.Any]], head: t.Sequence[str]) -> str:
    def cells(values: t.Sequence[t.Any], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(v))}</{tag}>" for v in values) + "</tr>"

    return "<table>" + cells(head, "th") + "".join(cells(row, "td") for row in rows) + "</table>"


class Scene:
    """A scene of gates, with every key.

    Parameters
    ----------
    source : path, str or dict
        A scene file; its text; or tables as a dict. Keys may have other units: ``radius_cm``.
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
            self._path = os.fspath(source)
        self._set: dict[str, t.Any] = dict(set or {})
        self._keys = self._read()

    def _read(self) -> list[dict[str, t.Any]]:
        from . import _run

        return t.cast("list[dict[str, t.Any]]", _run("scene", [self], {})["keys"])

    @property
    def keys(self) -> dict[str, t.Any]:
        """All keys with their values, in the units of their names (n values)."""
        return {row["key"]: self._value(row) for row in self._keys}

    @staticmethod
    def _value(row: dict[str, t.Any]) -> t.Any:
        text = row["value"]
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
        return isinstance(other, Scene) and self.keys == other.keys

    def __hash__(self) -> int:
        return hash(tuple(sorted((k, str(v)) for k, v in self.keys.items())))

    def __repr__(self) -> str:
        of = "of a text" if self._path is None else repr(self._path)
        return f"<gatewalk.Scene {of}{', ' + repr(self._set) if self._set else ''}>"

    def _repr_html_(self) -> str:
        return _table_html(((r["key"], r["value"], r["unit"], r["meaning"], r["source"]) for r in self._keys),
                           ("key", "value", "unit", "meaning", "from"))


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
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "scene.toml")
        with open(name, "w", encoding="utf-8") as out:
            out.write(text)
        try:
            yield name, getattr(subject, "_set", {})
        except ValueError as error:  # the folder means nothing to anybody
            raise type(error)(str(error).replace(name, "scene.toml")) from None
