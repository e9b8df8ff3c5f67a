# SPDX-License-Identifier: MIT
"""Cells of one's own, in numpy."""

from __future__ import annotations

import copy
import json
import math
import types
import typing as t

import numpy as np

from . import _core
from ._words import refuse, whole

if t.TYPE_CHECKING:
    Array = np.ndarray[t.Any, t.Any]

#: What `Cell.pass_` gives as the face of a body that stays, and of one of which nothing is known.
TRAPPED, BROKEN = -1, -2


def _numbers(value: t.Any, what: str, kinds: str = "iuf") -> Array:
    """An array of numbers as they are: what would have to be cast, or is masked, is none."""
    if np.ma.is_masked(value):  # type: ignore[no-untyped-call]
        raise _core.UsageError(f"cell: pass_ gave {what} with masked entries; of a body of which nothing is known the face is BROKEN")
    array = np.asarray(value)
    if array.dtype.kind not in kinds:
        raise _core.UsageError(f"cell: pass_ must give numbers as {what}, it gave {array.dtype}")
    return array


def _number(value: t.Any, what: str) -> float:
    no_numbers = (bool, np.bool_, str, bytes, complex, np.complexfloating, np.timedelta64, np.datetime64)
    if isinstance(value, no_numbers) or not np.isscalar(value):
        raise _core.UsageError(f"{what} must be a number, not {value!r}")
    return float(value)  # type: ignore[arg-type]


def _plain(value: t.Any) -> t.Any:
    """Of numpy, what JSON knows."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise _core.UsageError(f"cell: {value!r} is neither a number nor a word, nor a list or dict of them")


def _names(items: t.Any, what: str, name: str = "name") -> list[str]:
    if not isinstance(items, (list, tuple)):
        refuse(f"cell: {what}", "a list of dicts", items)
    for k, item in enumerate(items):
        if not isinstance(item, t.Mapping) or not isinstance(item.get(name), str):
            raise _core.UsageError(f"cell: {what}[{k}] must be a dict with a {name}, not {item!r}")
    return [item[name] for item in items]


class Cell:
    """A cell that bodies are carried through. Derive from it, say what it looks like, and write `pass_`.

    Attributes
    ----------
    faces : list of dict
        Where bodies enter: ``{"name": "S", "move": [0, 1]}``, the move from cell to cell (columns, rows). Of symmetric
        cells also ``"odd"``, the coordinates that change their sign in the mirror (left for right), and ``"mirror"``, the
        face that images enter by, where several faces have the mirrored move.
    coordinates : list of dict
        What is told of every entry: ``{"name": "s", "unit": "m", "scale": 0.1}``.
    costs : list of dict
        What a passage takes, its time first: ``{"key": "time_s", "unit": "s"}``.
    symmetric : bool
        Mirror images of passages are as likely.
    normals, uniforms : int
        So many numbers of noise come with each passage, from gatewalk's own streams; one of both is 0.
    memory : int
        So many numbers that a body carries from cell to cell, and that no coordinate shows (up to 60; 0 at first).
    parameters : dict
        Numbers that ``analyze`` may change: ``self.parameters["radius_m"]``. Another value: another object with its own.
    limits : dict
        The least and the most that a parameter may be: ``{"radius_m": (0.0, 0.5)}``.
    """

    faces: list[dict[str, t.Any]] = []
    coordinates: list[dict[str, t.Any]] = []
    costs: list[dict[str, t.Any]] = [{"key": "time_s", "unit": "s"}]
    symmetric: bool = False
    normals: int = 0
    uniforms: int = 0
    memory: int = 0
    parameters: dict[str, float] = {}
    limits: dict[str, tuple[float, float]] = {}

    def pass_(self, entries: dict[str, Array], random: types.SimpleNamespace) -> dict[str, Array]:
        """Carries bodies through, all at once.

        Parameters
        ----------
        entries : dict of arrays, shape (n,)
            "face" (number of the face) and each coordinate by its name; "memory", shape (n, memory).
        random : namespace
            seed, shape (n,), uint64, another one for each passage; normals (n, normals), uniforms (n, uniforms).

        Returns
        -------
        dict of arrays, shape (n,)
            "face" that each body leaves by, into the next cell (TRAPPED, BROKEN: none); each coordinate there; each cost
            by its key; "memory". What becomes of a body must depend on its own row alone: then the bits are the same for
            any number of threads.
        """
        raise NotImplementedError("derive from gatewalk.Cell and write pass_(entries, random)")

    def _hello(self) -> str:
        for what, name in (("faces", "name"), ("coordinates", "name"), ("costs", "key")):
            _names(getattr(self, what), what, name)
        for what in ("parameters", "limits"):
            if not isinstance(getattr(self, what), t.Mapping):
                refuse(f"cell: {what}", "a dict", getattr(self, what))
        for what in ("normals", "uniforms", "memory"):
            whole(getattr(self, what), f"cell: {what}", 0, 2**31 - 1)
        for key, limits in self.limits.items():
            if not isinstance(limits, (list, tuple, np.ndarray)) or len(limits) != 2:
                refuse(f"cell: limits of {key}", "(least, most)", limits)
        parameters = {key: [_number(x, f"cell: {key} of parameters and limits") for x in (value, *self.limits[key])] if key in self.limits
                      else _number(value, f"cell: {key} of parameters") for key, value in self.parameters.items()}
        return json.dumps({"gatewalk": 1, "faces": self.faces, "coordinates": self.coordinates, "costs": self.costs,
                           "symmetric": self.symmetric, "normals": self.normals, "uniforms": self.uniforms,
                           "parameters": parameters}, default=_plain)

    def _with(self, key: str, value: float) -> Cell:
        other = copy.copy(self)
        other.parameters = {**self.parameters, key: value}
        return other

    def _passes(self, face: Array, at: Array, seed: Array, noise: Array,
                memory: Array) -> tuple[Array, Array, Array, Array]:
        names = [c["name"] for c in self.coordinates]
        entries: dict[str, Array] = {"face": face, "memory": memory}
        entries.update({name: at[:, k] for k, name in enumerate(names)})
        out = self.pass_(entries, types.SimpleNamespace(seed=seed, normals=noise[:, :self.normals], uniforms=noise[:, self.normals:]))
        if not isinstance(out, dict):
            raise _core.UsageError(f"cell: pass_ must give a dict of arrays, it gave {type(out).__name__}")
        wanted = ["face", *names, *(c["key"] for c in self.costs)]
        missing = [key for key in wanted if key not in out]
        if missing:
            raise _core.UsageError(f"cell: pass_ gave no {', '.join(missing)}; it must give {', '.join(wanted)}")
        unknown = set(out) - set(wanted) - {"memory"}
        if unknown:
            raise _core.UsageError(f"cell: pass_ gave {', '.join(sorted(unknown))}; it may give {', '.join(wanted)} and memory")
        n = len(face)

        def stacked(keys: list[str]) -> Array:
            if not keys:
                return np.zeros((n, 0))
            columns = [_numbers(out[k], k).astype(float) for k in keys]
            for k, column in zip(keys, columns):
                if column.shape not in ((), (1,), (n,)):
                    raise _core.UsageError(f"cell: pass_ must give {n} numbers as {k}, it gave an array of shape {column.shape}")
            return np.stack([np.broadcast_to(column, (n,)) for column in columns], axis=1)

        if np.ma.is_masked(out["face"]):  # type: ignore[no-untyped-call]
            _numbers(out["face"], "face")
        leaves = np.asarray(out["face"])
        if leaves.shape != (n,) or leaves.dtype.kind not in "iu":
            raise _core.UsageError(f"cell: pass_ must give {n} whole numbers as face, it gave {leaves.dtype} of shape {leaves.shape}")
        if leaves.dtype == np.uint64 and (leaves > np.iinfo(np.int64).max).any():
            raise _core.UsageError(f"cell: pass_ gave the face {leaves.max()}; faces are 0 to {len(self.faces) - 1}, -1 is trapped, -2 broken")
        kept = _numbers(out.get("memory", memory), "memory").astype(float)
        if kept.shape == (n,) and self.memory == 1:
            kept = kept[:, np.newaxis]
        if kept.shape != (n, self.memory):
            raise _core.UsageError(f"cell: pass_ must give memory of shape ({n}, {self.memory}), it gave {kept.shape}")
        return leaves.astype(np.int64), stacked(names), stacked(wanted[1 + len(names):]), kept


def check_cell(cell: Cell, starts: t.Sequence[t.Mapping[str, t.Any]] | None = None, *, trials: int = 200, cells: int = 8,
               seed: int = 1) -> list[str]:
    """What is wrong with a cell, in words: a test for cells of your own.

    Trials are carried out several times, on one and on four threads, in batches of any size, alone and in reverse order, and by a
    copy with the same parameters: all bits must be the same. Entries must be finite and by known faces, costs finite, the time
    above 0, no body may break, and a symmetric cell must send mirror images to the mirrored faces as often.

    Parameters
    ----------
    cell : Cell
    starts : list of dict, optional
        How bodies enter: ``{"face": "S", "s": 0.05}``, every coordinate; without it by each face, all coordinates 0.
    trials : int, optional
        From the starts in turn.
    cells : int, optional
        That a trial passes at most.
    seed : int, optional

    Returns
    -------
    list of str
        Empty where nothing was found.

    Raises
    ------
    UsageError
        Where `cell` is no cell, or a start none of its entries; where a number is none, or out of range.

    Examples
    --------
    >>> import numpy as np, gatewalk as gw
    >>> class Coin(gw.Cell):
    ...     faces = [{"name": "S", "move": [0, 1]}, {"name": "N", "move": [0, -1]}]
    ...     coordinates = [{"name": "s", "unit": "m", "scale": 0.1}]
    ...     uniforms = 1
    ...     def pass_(self, entries, random):
    ...         return {"face": (random.uniforms[:, 0] < 0.5).astype(int), "s": entries["s"], "time_s": 1.0}
    >>> gw.check_cell(Coin())
    []
    >>> class Forgetful(Coin):
    ...     def pass_(self, entries, random):
    ...         return {"face": np.random.randint(2, size=len(random.seed)), "s": entries["s"], "time_s": 1.0}
    >>> "is another one" in gw.check_cell(Forgetful())[0]
    True
    """
    if not isinstance(cell, Cell):
        raise _core.UsageError("cell: must be an object of a class derived from gatewalk.Cell")
    trials, cells = whole(trials, "check_cell: trials", 1, 2**63 - 1), whole(cells, "check_cell: cells", 1, 2**31 - 1)
    seed = whole(seed, "check_cell: seed", 0, 2**64 - 1)
    faces, names = _names(cell.faces, "faces"), _names(cell.coordinates, "coordinates")
    entries = [(k, [0.0] * len(names)) for k in range(len(faces))] if starts is None else []
    if starts is not None and not (isinstance(starts, (list, tuple)) and starts and all(isinstance(start, t.Mapping) for start in starts)):
        raise _core.UsageError(f"check_cell: starts must be a list of dicts, at least one, not {type(starts).__name__}: {starts!r}")
    for k, start in enumerate(starts or []):
        if set(start) != {"face", *names} or start["face"] not in faces:
            raise _core.UsageError(f"check_cell: start {k} must have a face, one of {', '.join(faces)}, and {', '.join(names)}; it is {dict(start)}")
        at = [_number(start[name], f"check_cell: {name} of start {k}") for name in names]
        for name, number in zip(names, at):
            if not math.isfinite(number):
                raise _core.UsageError(f"check_cell: {name} of start {k} must be finite, not {number}")
        entries.append((faces.index(start["face"]), at))
    return _core.check_cell(cell, entries, trials, cells, seed)
