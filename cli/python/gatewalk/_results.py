# SPDX-License-Identifier: MIT
"""Results of commands: the program's JSON, with numpy arrays, tables and pictures."""

from __future__ import annotations

import collections.abc
import re
import typing as t

import numpy as np

if t.TYPE_CHECKING:
    Array = np.ndarray[t.Any, t.Any]

from . import _core
from ._scene import NoSuchKey, _table_html
from ._words import refuse, whole


def require_axes(axes: t.Any, number: int = 1) -> t.Any:
    """Returns the axes that were given to `plot`. Raises UsageError if they are not axes of matplotlib."""
    given = [axes] if number == 1 else axes
    if not hasattr(given, "__len__") or len(given) < number or not all(hasattr(one, "imshow") for one in given):
        refuse("axes", "axes of matplotlib" if number == 1 else f"{number} axes of matplotlib, as plt.subplots(1, {number}) gives them", axes)
    return axes


def _same(a: t.Any, b: t.Any) -> bool:
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(_same(a[k], b[k]) for k in a if not k.endswith("seconds") and k != "speed_ratio")
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(map(_same, a, b))
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return np.shape(a) == np.shape(b) and bool(np.array_equal(a, b, equal_nan=True))
    return bool(a == b) or (isinstance(a, float) and isinstance(b, float) and a != a and b != b)


def _first_column(result: collections.abc.Mapping[str, t.Any], columns: int) -> int:
    """i_x of the leftmost column. Bodies start in the column i_x = 0: that of the scene or cell file, else the middle one."""
    made_by = result.get("made_by", {})
    own = re.search(r"^start_column = (\d+)$", made_by.get("scene") or made_by.get("cell") or "", re.MULTILINE)
    return -(int(own.group(1)) if own else columns // 2)


class Result(collections.abc.Mapping):  # type: ignore[type-arg]
    """The result of a command: its JSON as a mapping, whose keys are attributes too.

    Tables of numbers are numpy arrays. The 95 % interval of `x` is `x_95`: a tuple (low, high) in the unit of x, or None. If x
    is a list or a table, `x_95` is an array with one more axis at the end: low and high, NaN where there is no interval. If a
    table has no interval at all, `x_95` is None. The docstring of the function that returns the result explains each key.

    Two results are equal if everything but computing times and `made_by` is equal.
    """

    def __init__(self, data: dict[str, t.Any]) -> None:
        self._data = data

    def __getitem__(self, key: str) -> t.Any:
        try:
            return self._data[key]
        except (KeyError, TypeError):
            raise NoSuchKey(f"{type(self).__name__} has no {key!r}; it has {', '.join(self._data)}") from None

    def __iter__(self) -> t.Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __getattr__(self, name: str) -> t.Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._data[name]
        except KeyError:
            raise AttributeError(f"{type(self).__name__} has no {name}; it has {', '.join(self._data)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._data]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Result):
            return NotImplemented

        def shown(result: Result) -> dict[str, t.Any]:
            return {k: v for k, v in result._data.items() if k != "made_by"}

        return type(self) is type(other) and _same(shown(self), shown(other))

    __hash__ = None  # type: ignore[assignment]

    def _lines(self) -> list[tuple[str, str]]:
        return [(k, f"{v:.6g}" if isinstance(v, float) else str(v)) for k, v in self._data.items()
                if isinstance(v, (bool, int, float, str))]

    def __repr__(self) -> str:
        return f"<gatewalk.{type(self).__name__} " + ", ".join(f"{k} {v}" for k, v in self._lines()[:6]) + ">"

    def _repr_html_(self) -> str:
        return _table_html(self._lines(), ("", ""))


class Prediction(Result):
    """Where bodies end, and how.

    With several starts, `starts` has a prediction for each. With one start, its keys are attributes of this object too. A
    result of `lattice` has numbers of bodies where a prediction has shares: in endings, in gates and in their intervals.
    """

    def __getattr__(self, name: str) -> t.Any:
        rows = self.__dict__.get("_data", {}).get("starts")
        if rows and len(rows) == 1 and name in rows[0]:  # what is said of the only start
            return rows[0][name]
        return super().__getattr__(name)

    @property
    def starts(self) -> list[Prediction]:
        """A list with a prediction for each start."""
        rows = self._data.get("starts")
        return [Prediction(row) for row in rows] if rows else [self]

    def _only(self) -> dict[str, t.Any]:
        if len(self.starts) > 1:
            raise _core.UsageError(f"there are {len(self.starts)} starts: starts[0], starts[1], ... have one each")
        if self.starts[0]._data.get("final_gates") is None:
            raise _core.UsageError("the field has too many gates for tables: netcdf=FILE writes them")
        return self.starts[0]._data

    @staticmethod
    def _all(first: dict[str, t.Any]) -> dict[str, float]:
        """The endings, and beside them what endings leave out if it exceeds 1e-6; together all bodies."""
        rest = {k: first.get(k) or 0.0 for k in ("never_sampled", "still_walking")}
        return {**first["endings"], **{k: v for k, v in rest.items() if v > 1e-6}}

    def _limits(self, first: dict[str, t.Any]) -> dict[str, tuple[float, float]]:
        """The 95 % interval of each item of `_all`; (NaN, NaN) where there is none."""
        limits = first.get("endings_95", {})
        return {k: limits.get(k) or (float("nan"), float("nan")) for k in self._all(first)}

    def to_xarray(self) -> t.Any:
        """The prediction as an xarray.Dataset.

        Final, trapped and departed gates have the dimensions i_y and i_x; bodies start in i_x = 0. Endings have the dimension
        `ending`. Intervals have one more dimension, `bound`: "low", "high".
        """
        import xarray

        first = self._only()
        rows, columns = np.shape(first["final_gates"])
        is_count = "trials" in self._data
        unit = {"units": "1", "long_name": "bodies" if is_count else "share of bodies"}
        place = ("i_y", "i_x")
        data: dict[str, t.Any] = {k: (place, np.asarray(first[k]), unit) for k in ("final_gates", "trapped_gates", "departed_gates")
                                  if k in first}
        gate_limits = first.get("final_gates_95")
        if gate_limits is not None:
            data["final_gates_95"] = ((*place, "bound"), np.asarray(gate_limits), unit)
        ends = self._all(first)
        data["endings"] = (("ending",), np.array(list(ends.values()), dtype=float), unit)
        if "endings_95" in first:
            data["endings_95"] = (("ending", "bound"), np.array(list(self._limits(first).values()), dtype=float), unit)
        coordinates = {"i_y": ("i_y", np.arange(rows), {"long_name": "row of gates, the near one is 0"}),
                       "i_x": ("i_x", np.arange(columns) + _first_column(self._data, columns), {"long_name": "column of gates, that of the start is 0"}),
                       "ending": list(ends)}
        if gate_limits is not None or "endings_95" in first:
            coordinates["bound"] = ["low", "high"]
        return xarray.Dataset(data, coordinates, {"title": "gatewalk", "scene": self._data.get("made_by", {}).get("scene", "")})

    def to_frame(self) -> t.Any:
        """A pandas.DataFrame with a line for each ending: its share (of `lattice` its number) and the 95 % interval."""
        import pandas

        first = self._only()
        ends = self._all(first)
        low_high = np.array(list(self._limits(first).values()), dtype=float)
        return pandas.DataFrame({"value": list(ends.values()), "low_95": low_high[:, 0], "high_95": low_high[:, 1]},
                                index=pandas.Index(list(ends), name="ending"))

    def plot(self, axes: t.Any = None) -> t.Any:
        """Draws final gates as a map and endings as bars, with matplotlib. Returns both axes."""
        import matplotlib.pyplot as plt

        if axes is None:
            _, axes = plt.subplots(1, 2, figsize=(7.0, 3.0), constrained_layout=True)
        axes = require_axes(axes, 2)
        first = self._only()
        total = float(self._data.get("trials", 1))
        gates = np.asarray(first["final_gates"], dtype=float) / total
        columns = gates.shape[1]
        left = _first_column(self._data, columns) - 0.5
        shown = np.ma.masked_where(gates <= 0.0, 100 * gates)  # type: ignore[no-untyped-call]
        image = axes[0].imshow(shown, origin="lower", cmap="viridis", extent=(left, left + columns, -0.5, gates.shape[0] - 0.5))
        axes[0].set_xlabel("$i_x$")
        axes[0].set_ylabel("$i_y$")
        axes[0].figure.colorbar(image, ax=axes[0], label="final gate, % of bodies")
        ends = self._all(first)
        table = np.array(list(ends.values()), dtype=float) / total
        names = [name.replace("_", " ") for name in ends]
        limits = np.array(list(self._limits(first).values()), dtype=float) / total
        has_limits = np.isfinite(limits).any()
        errors = 100 * np.clip(np.stack([table - limits[:, 0], limits[:, 1] - table]), 0.0, None) if has_limits else None
        axes[1].barh(names, 100 * table, xerr=errors, color="0.6", ecolor="black", capsize=2)
        axes[1].invert_yaxis()
        axes[1].set_xlabel("% of bodies, with 95 % intervals" if has_limits else "% of bodies")
        return axes

    def _lines(self) -> list[tuple[str, str]]:
        if len(self.starts) > 1:
            return [("starts", str(len(self.starts)))]
        first = self.starts[0]._data
        bars = self._limits(first)
        lines = [(k.replace("_", " "), f"{v:.4g}" + (f" [{bars[k][0]:.3g}, {bars[k][1]:.3g}]" if bars[k][0] == bars[k][0] else ""))
                 for k, v in self._all(first).items()]
        if first.get("error_95") is not None:
            lines.append(("error_95", f"{first['error_95']:.3g}"))
        return lines


class Analysis(Result):
    """Times (s), work (J), other starts, and which numbers of the scene change the outcome most.
    """


class FirstPassage(Result):
    """How likely bodies are to reach a target (a gate, a state or an ending), and how long they take.

    Attributes
    ----------
    target : str
        The target, as you gave it.
    probability, mean_gates, mean_time_s : float
        The share of bodies from the start that reach the target, and how many gates and seconds those bodies take on average.
        ``probability_95`` and so on are their intervals, from groups of the trials; None for the target of a state, for matrices
        of bins, and for chains from elsewhere.
    states : list of str
        Names of the states. `Matrix.states` of a matrix of trees has one more at its end: the start's own state.
    of_states : dict of arrays, shape (rows, columns, states)
        Values for bodies that enter each gate in each state and may still visit ``field.max_gates`` gates. ``probability`` is
        the committor. ``never_sampled`` is the share that reaches a state whose row was never sampled. ``mean_gates`` and
        ``mean_time_s`` are mean first passage times, NaN where no body reaches the target. In the target itself the probability
        is 1 and the means are 0.
    """

    def to_frame(self) -> t.Any:
        """A pandas.DataFrame with a line for each gate and state. Its index is i_y, i_x (bodies start in i_x = 0) and the state's name."""
        import pandas

        tables = self._data["of_states"]
        if tables is None:
            raise _core.UsageError("the field has too many gates and states for tables")
        rows, columns, _ = tables["probability"].shape
        index = pandas.MultiIndex.from_product([range(rows), np.arange(columns) + _first_column(self._data, columns), self._data["states"]],
                                               names=["i_y", "i_x", "state"])
        return pandas.DataFrame({k: v.ravel() for k, v in tables.items() if v is not None}, index=index)


class Sweep(Result):
    """Outcomes of a gate over a grid of scene keys.
    """

    def to_frame(self) -> t.Any:
        """A pandas.DataFrame with a line for each point: first the keys, then the number of runs with each outcome."""
        import pandas

        return pandas.DataFrame([{**p["at"], **{k: v for k, v in p.items() if isinstance(v, int) and not isinstance(v, bool)}}
                                 for p in self._data["points"]])


class Landscape(Result):
    """Potential energy over a gate: `passes` has the lowest ways; `table` has the columns x_m, y_m, elastic_J and total_J."""

    def to_frame(self) -> t.Any:
        """A pandas.DataFrame with a line for each point of the grid."""
        import pandas

        return pandas.DataFrame(self._data["table"])

    def plot(self, axes: t.Any = None) -> t.Any:
        """Draws the total energy as a map, with the lowest way, with matplotlib. Returns the axes."""
        import matplotlib.pyplot as plt

        if axes is None:
            _, axes = plt.subplots(figsize=(4.0, 3.5), constrained_layout=True)
        axes = require_axes(axes)
        table = self._data["table"]
        x, y = np.unique(table["x_m"]), np.unique(table["y_m"])
        energy = np.ma.masked_invalid(table["total_J"]).reshape(len(y), len(x))  # type: ignore[no-untyped-call]
        image = axes.pcolormesh(x, y, energy, shading="nearest", cmap="viridis")
        axes.figure.colorbar(image, ax=axes, label="energy (J)")
        way = np.asarray(self._data["passes"][0]["from_start"]["way_m"])
        axes.plot(way[:, 0], way[:, 1], color="white", lw=1.0)
        axes.set_xlabel("x (m)")
        axes.set_ylabel("y (m)")
        axes.set_aspect("equal")
        return axes


class Trace(Result):
    """Single runs, with every step.
    """

    def to_frame(self, run: int = 0) -> t.Any:
        """A pandas.DataFrame of one run (counted from 0), with a line for each step."""
        import pandas

        runs = self._data["runs"]
        if not runs:
            raise _core.UsageError("there is no run")
        run = whole(run, "run", 0, len(runs) - 1)
        return pandas.DataFrame({k: v for k, v in runs[run].items() if isinstance(v, np.ndarray)})

    def plot(self, axes: t.Any = None) -> t.Any:
        """Draws the paths of all runs with matplotlib. Returns the axes."""
        import matplotlib.pyplot as plt

        if axes is None:
            _, axes = plt.subplots(figsize=(3.5, 4.0), constrained_layout=True)
        axes = require_axes(axes)
        width, length = self._data["gate_m"]
        for run in self._data["runs"]:
            axes.plot(np.asarray(run["gx"]) * width + run["x"], np.asarray(run["gy"]) * length + run["y"], label=run["label"], lw=0.8)
        axes.set_xlabel("x (m)")
        axes.set_ylabel("y (m)")
        axes.set_aspect("equal")
        return axes


def document(what: t.Any, command: str) -> None:
    """Adds to the docstring of a class or function the meaning of each key of the command's result."""
    text = (what.__doc__ or "").rstrip() + "\n\n    Keys of the result\n    ------------------\n"
    for name, keys in _core.result_keys(command):
        for key, kind, unit, meaning, is_always_there in keys:
            path = key if name == command else f"{name}.{key}"
            about = ", ".join(word for word in (kind, "" if unit == "1" else unit, "" if is_always_there else "optional") if word)
            text += f"    {path} : {about}\n        {meaning}\n"
    what.__doc__ = text + "    "


for _class, _command in ((Prediction, "predict"), (Analysis, "analyze"), (Sweep, "sweep"), (Landscape, "landscape"), (Trace, "trace")):
    document(_class, _command)
