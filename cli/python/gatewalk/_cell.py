# SPDX-License-Identifier: MIT
"""Cells of one's own, in numpy."""

from __future__ import annotations

import copy
import json
import types
import typing as t

import numpy as np

if t.TYPE_CHECKING:
    Array = np.ndarray[t.Any, t.Any]

#: What `Cell.pass_` gives as the face of a body that stays, and of one of which nothing is known.
TRAPPED, BROKEN = -1, -2


class Cell:
    """A cell that bodies are carried through. Derive from it, say what it looks like, and write `pass_`.

    Attributes
    ----------
    faces : list of dict
        Where bodies enter: ``{"name": "S", "move": [0, 1]}``, the move from cell to cell (columns, rows); ``"mirror"``, the
        face that mirror images (left for right) enter by, and ``"odd"``, the coordinates that change their sign then.
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
        parameters = {key: [float(value), *map(float, self.limits[key])] if key in self.limits else float(value)
                      for key, value in self.parameters.items()}
        return json.dumps({"gatewalk": 1, "faces": self.faces, "coordinates": self.coordinates, "costs": self.costs,
                           "symmetric": self.symmetric, "normals": self.normals, "uniforms": self.uniforms,
                           "parameters": parameters})

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
            raise ValueError(f"cell: pass_ must give a dict of arrays, it gave {type(out).__name__}")
        wanted = ["face", *names, *(c["key"] for c in self.costs)]
        missing = [key for key in wanted if key not in out]
        if missing:
            raise ValueError(f"cell: pass_ gave no {', '.join(missing)}; it must give {', '.join(wanted)}")
        unknown = set(out) - set(wanted) - {"memory"}
        if unknown:
            raise ValueError(f"cell: pass_ gave {', '.join(sorted(unknown))}; it may give {', '.join(wanted)} and memory")
        n = len(face)

        def stacked(keys: list[str]) -> Array:
            if not keys:
                return np.zeros((n, 0))
            return np.stack([np.broadcast_to(np.asarray(out[k], dtype=float), (n,)) for k in keys], axis=1)

        leaves = np.asarray(out["face"])
        if leaves.shape != (n,) or leaves.dtype.kind not in "iu":
            raise ValueError(f"cell: pass_ must give {n} whole numbers as face, it gave {leaves.dtype} of shape {leaves.shape}")
        kept = np.asarray(out.get("memory", memory), dtype=float)
        if kept.shape == (n,) and self.memory == 1:
            kept = kept[:, np.newaxis]
        if kept.shape != (n, self.memory):
            raise ValueError(f"cell: pass_ must give memory of shape ({n}, {self.memory}), it gave {kept.shape}")
        return leaves.astype(np.int64), stacked(names), stacked(wanted[1 + len(names):]), kept
