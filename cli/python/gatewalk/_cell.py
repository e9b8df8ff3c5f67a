# SPDX-License-Identifier: MIT
"""Cells of your own, in numpy."""

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

#: Faces that `Cell.pass_` gives for a body that stays in the cell, and for one whose simulation failed.
TRAPPED, BROKEN = -1, -2


def _numbers(value: t.Any, what: str, kinds: str = "iuf") -> Array:
    """The value as an array of numbers. Raises UsageError for other types and for masked entries."""
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
    """A value of numpy as JSON can store it. Raises UsageError for any other value."""
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
    """A cell that you simulate yourself. Derive a class, describe the cell by the attributes, and write `pass_`.

    Attributes
    ----------
    faces : list of dict
        Faces by which bodies enter: ``{"name": "S", "move": [0, 1]}``, with the move into the cell (columns, rows). In
        symmetric cells a face also has ``"odd"``, the coordinates that change sign in the mirror (left for right), and
        ``"mirror"``, the face by which mirror images enter, if several faces have the mirrored move.
    coordinates : list of dict
        Coordinates of an entry: ``{"name": "s", "unit": "m", "scale": 0.1}``; ``scale`` is a difference that matters.
    costs : list of dict
        Costs of a passage, the time first: ``{"key": "time_s", "unit": "s"}``.
    symmetric : bool
        True if the mirror image of a passage is as likely as the passage.
    normals, uniforms : int
        How many numbers of noise each passage gets from gatewalk's random streams; one of both must be 0.
    memory : int
        How many numbers a body carries from cell to cell that no coordinate shows (at most 60; each is 0 at first).
    parameters : dict
        Numbers that ``analyze`` may change, read as ``self.parameters["radius_m"]``. For another value, make another
        object with its own parameters.
    limits : dict
        The smallest and the largest value of a parameter: ``{"radius_m": (0.0, 0.5)}``.
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
        """Simulates one passage for each of n bodies.

        Parameters
        ----------
        entries : dict of arrays, shape (n,)
            How the bodies enter: "face" (the number of the face), each coordinate by its name, and "memory" of shape
            (n, memory).
        random : namespace
            Noise: ``seed`` of shape (n,), uint64, different for each passage; ``normals`` of shape (n, normals);
            ``uniforms`` of shape (n, uniforms).

        Returns
        -------
        dict of arrays, shape (n,)
            "face", the number of the face by which each body enters the next cell, or TRAPPED or BROKEN; each coordinate of
            that entry; each cost by its key; "memory". A row may depend on the same row of the arguments alone, so that the
            bits are the same for any number of threads.
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
    """Tests a cell of your own, and returns in words what is wrong.

    `check_cell` runs the same trials several times: on one and on four threads, in batches of several sizes, alone, in reverse
    order, and by a copy with the same parameters. All bits must be the same. Entries must be finite and use known faces, costs
    must be finite, the time must be above 0, and no body may be BROKEN. A symmetric cell must send mirror images to the mirrored
    faces as often.

    Parameters
    ----------
    cell : Cell
    starts : list of dict, optional
        How bodies enter: a face and every coordinate, ``{"face": "S", "s": 0.05}``. Default: by each face, with all
        coordinates 0.
    trials : int, optional
        Number of trials; they take the starts in turn.
    cells : int, optional
        The largest number of cells that a trial passes.
    seed : int, optional
        Seed of all random numbers.

    Returns
    -------
    list of str
        A sentence for each fault; empty if there is none.

    Raises
    ------
    UsageError
        If `cell` is not a cell, if a start is not an entry of it, or if a number is out of range.

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
