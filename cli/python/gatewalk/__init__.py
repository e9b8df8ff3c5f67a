# SPDX-License-Identifier: MIT
"""Locomotion through cluttered obstacles: short runs of single gates, chained over a field.

Commands of the program ``gatewalk`` as functions, with the same numbers to the last bit and the same errors. Options of a
command are keyword arguments (``--gate-runs 1e5`` is ``gate_runs=1e5``); ``help(gatewalk.predict)`` names the usual
ones, ``gatewalk.options("predict")`` all of them. Numbers and booleans may be numpy's, lists may be arrays, paths pathlib's.

Errors: `UsageError` for an argument, `SceneError` for a scene or a cell file, `BadFile` for a matrix file, all of them
ValueErrors; RuntimeError where something could not be finished; OSError by `Matrix.save`.

>>> import gatewalk as gw
>>> scene = gw.Scene({"body": {"radius_cm": 4.0, "mass_g": 250.0}, "forces": {"propulsion_N": 1.2}})
>>> p = gw.predict(scene, accuracy=0.05, seed=1)
>>> round(sum(p.endings.values()), 12)
1.0
>>> p.final_gates.shape
(9, 9)

States, rows and columns count from 0.
"""

from __future__ import annotations

import contextlib as _contextlib
import json as _json
import os as _os
import sys as _sys
import typing as _t
import warnings as _warnings

from . import _core
from ._cell import BROKEN, TRAPPED, Cell, check_cell
from ._core import BadFile, SceneError, UsageError
from ._results import Analysis, FirstPassage, Landscape, Prediction, Result, Sweep, Trace, document as _document
from ._scene import Scene, called as _called, file_of as _file_of, renamed as _renamed, without_folders as _without_folders
from ._words import in_python as _in_python, input_of as _input_of, options_of as _options_of, plain as _plain, refuse as _refuse
from ._words import whole as _whole, words_of as _words_of

__version__: str = _core.version
__all__ = ["Analysis", "BROKEN", "BadFile", "Cell", "FirstPassage", "GatewalkWarning", "Landscape", "Matrix", "Prediction", "Result", "Scene",
           "SceneError", "Sweep", "TRAPPED", "Trace", "UsageError", "analyze", "build", "check_cell", "design", "fit", "from_counts", "from_passages", "gate", "landscape", "lattice",
           "load", "merge", "options", "passages", "plan", "power", "predict", "rare", "sample", "simulate", "sweep", "threads", "trace", "validate", "walk"]


class GatewalkWarning(UserWarning):
    """What a result must not be taken at face value for; the program's own words."""


def _as_called(value: _t.Any, key: str = "") -> _t.Any:
    """A result in which files that only this package knows are called as in errors, and in commands by their names."""
    if isinstance(value, str):
        return _without_folders(value if key == "command" else _renamed(value))
    if isinstance(value, dict):
        return {k: _as_called(v, k) for k, v in value.items()}
    if isinstance(value, list):
        return [_as_called(v) for v in value]
    return value


class _Bars:
    """Bars of tqdm, one at a time."""

    def __init__(self, tqdm: _t.Any) -> None:
        self._tqdm, self._what = tqdm, ""
        self._bar: _t.Any = None

    def __call__(self, what: str, done: int, total: int) -> None:
        if what != self._what or self._bar is None:
            self.close()
            self._what, self._bar = what, self._tqdm(total=total, desc=what, leave=False)
        self._bar.total = total
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
        self._bar = None


def _bars(wanted: bool | None) -> _Bars | None:
    """tqdm's, where it is installed and somebody looks (or progress=True)."""
    wanted = _plain(wanted)
    if wanted is not None and not isinstance(wanted, bool):
        _refuse("progress", "True or False", wanted)
    if wanted is False or (wanted is None and not _sys.stderr.isatty()):
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return _Bars(tqdm)


def _outside() -> int:
    """How many calls up the one is that is not in this package: where a warning belongs."""
    here = _os.path.dirname(__file__)
    level, frame = 1, _sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(here):
        frame, level = frame.f_back, level + 1
    return level


def _run(command: str, subjects: dict[str, _t.Any], given: dict[str, _t.Any], extra: list[str] | None = None,
         gives_json: bool = True) -> dict[str, _t.Any]:
    """Runs a command about these subjects, by the names of their parameters; raises what the program would say, in Python's words."""
    cell = given.pop("cell", None)
    bars = _bars(given.pop("progress", None))
    if cell is not None and command in ("gate", "sweep", "trace", "walk", "export", "passages"):
        raise UsageError(f"cell: gatewalk.{command} is of gates")
    if cell is not None and not isinstance(cell, Cell):
        raise UsageError("cell: must be an object of a class derived from gatewalk.Cell"
                         + (", not the class itself" if isinstance(cell, type) else ""))
    words: list[str] = []
    with _contextlib.ExitStack() as stack:
        for name, subject in subjects.items():
            path, overrides = stack.enter_context(_file_of(subject, name))
            words.append(path)
            words += _words_of(command, {"set": overrides})
        start = _plain(given.get("start"))
        if isinstance(start, list) and any(isinstance(subject, Matrix) and subject._is_of_states() for subject in subjects.values()):
            given["start"] = [str(state) if isinstance(state, int) else state for state in start]  # several numbers, not one place
        words += _words_of(command, given) + (extra or []) + ["--quiet"]
        if gives_json:
            words.append("--json=-")
        matrices = {name: m for name, m in {**subjects, **given}.items() if isinstance(m, Matrix)}
        for name, matrix in matrices.items():
            stack.enter_context(_called(matrix._file, "the other matrix" if name == "versus" and matrix._file != matrix._name else matrix._name))
        called_words = [_renamed(word) for word in words]
        warned: list[str] = []
        try:
            status, result = _core.run(command, words, told=bars, warned=warned.append, cell=cell, matrices=[m._core for m in matrices.values()])
        except (SceneError, UsageError, BadFile, RuntimeError) as error:
            said = _in_python(_renamed(str(error)), command, called_words)
            is_cells = error.__traceback__ is not None and error.__traceback__.tb_next is not None  # of code in Python
            if is_cells or said == str(error):
                raise
            raise type(error)(said) from None
        finally:
            if bars is not None:
                bars.close()
            for text in warned:
                _warnings.warn(_in_python(_renamed(text), command, called_words), GatewalkWarning, stacklevel=_outside())
        result = _as_called(result)
    if status != 0 and given.get("strict"):
        raise RuntimeError(f"gatewalk.{command}: the result's status is not clean")
    return _t.cast("dict[str, _t.Any]", result) if result is not None else {}


def threads(n: int) -> None:
    """How many threads to use from now on.

    Parameters
    ----------
    n : int
        0: all.

    Raises
    ------
    UsageError
        Where it is no whole number from 0 to 1024.
    """
    _core.threads(_whole(n, "threads: n", 0, 1024))


def options(command: str) -> str:
    """The help page of a command, by name: all options that its function here takes.

    Parameters
    ----------
    command : str
        "predict", "build", ...

    Returns
    -------
    str

    Raises
    ------
    UsageError
        Where there is no such command.
    """
    import subprocess

    if not isinstance(command, str):
        _refuse("command", 'the name of a command, such as "predict"', command)
    _options_of(command)
    code = "import sys; from gatewalk import _core; _core.run(sys.argv[1], ['--help'], told=None, warned=print, cell=None, matrices=[])"
    done = subprocess.run([_sys.executable, "-c", code, command], capture_output=True, text=True, check=True,
                          env={**_os.environ, "PYTHONPATH": _os.pathsep.join(p for p in _sys.path if p)})
    return done.stdout


def predict(subject: _t.Any, scene: _t.Any = None, *, accuracy: float | None = None, start: _t.Any = None, seed: int | None = None, cell: Cell | None = None,
            progress: bool | None = None, **more: _t.Any) -> Prediction:
    """Where bodies end in a field, and how, with error bars.

    Parameters
    ----------
    subject : Scene, Matrix, path, text or dict
        A scene: trials are run until the bar keeps `accuracy`. A matrix of trees: the same with its runs.
    scene : Scene, path, text or dict, optional
        Of a matrix: another scene with the same physics, such as another field; without it the matrix's own.
    accuracy : float, optional
        Of all shares together (total variation, 95 %); 0.02 without it.
    start : tuple or list of tuples, optional
        (d, vx, vy) in m and m/s, of each start: where and how fast a body enters the field. Of a cell with several faces
        (face, ...), the name of the face and then its coordinates. Of a chain from elsewhere the number or name of a state, or
        a list of these.
    seed : int, optional
        Of all trials; 1 without it.
    cell : Cell, optional
        Who carries bodies through the cells of `subject`, which is a cell file then.
    progress : bool, optional
        A bar of tqdm (which must not call gatewalk); without it, where one is installed and standard error is a terminal.
    **more
        Any option of ``gatewalk predict``, "-" written "_".

    Returns
    -------
    Prediction

    Raises
    ------
    SceneError, UsageError, BadFile
        All of them ValueErrors: the key, and what is allowed.
    """
    return Prediction(_run("predict", {"subject": subject} if scene is None else {"subject": subject, "scene": scene}, dict(accuracy=accuracy, start=start, seed=seed, cell=cell, progress=progress, **more)))


def lattice(subject: _t.Any, *, trials: int | None = None, seed: int | None = None, cell: Cell | None = None, progress: bool | None = None,
            **more: _t.Any) -> Prediction:
    """The full dynamics through the field: how many bodies end where, and how.

    Parameters
    ----------
    subject : Scene, path, text or dict
        A scene, or with `cell` a cell file.
    trials : int, optional
        Bodies; 100 without it.
    seed, cell, progress, **more
        See `predict`.

    Returns
    -------
    Prediction
        Numbers of bodies where `predict` gives shares.

    Raises
    ------
    SceneError, UsageError, BadFile
        See `predict`.
    """
    return Prediction(_run("lattice", {"subject": subject}, dict(trials=trials, seed=seed, cell=cell, progress=progress, **more)))


simulate = lattice  #: what it does, by its plain name


def gate(scene: _t.Any, *, trials: int | None = None, seed: int | None = None, progress: bool | None = None, **more: _t.Any) -> Result:
    """Runs of one gate: how many traverse it, leave by its sides, are trapped.

    Parameters
    ----------
    scene : Scene, path, text or dict
    trials : int, optional
        Runs; 100 without it.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk gate``.

    Returns
    -------
    Result
        `trials`, and the number of each outcome.

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    return Result(_run("gate", {"scene": scene}, dict(trials=trials, seed=seed, progress=progress, **more)))


def sweep(scene: _t.Any, vary: dict[str, _t.Any], *, trials: int | None = None, seed: int | None = None, progress: bool | None = None,
          **more: _t.Any) -> Sweep:
    """`gate` over a grid of scene keys.

    Parameters
    ----------
    scene : Scene, path, text or dict
    vary : dict
        Values of each key, a list or a text such as "5:1:8": ``{"forces.propulsion_N": [5, 6, 7]}``.
    trials : int, optional
        Runs at each point.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk sweep``.

    Returns
    -------
    Sweep

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    return Sweep(_run("sweep", {"scene": scene}, dict(vary=vary, trials=trials, seed=seed, progress=progress, **more)))


def trace(scene: _t.Any, *, trials: int | None = None, seed: int | None = None, progress: bool | None = None, **more: _t.Any) -> Trace:
    """Single runs in full: every step with places, velocities, beams, forces and energies.

    Parameters
    ----------
    scene : Scene, path, text or dict
    trials : int, optional
        Runs, from number 0 on.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk trace``: ``field=True`` follows bodies across the field,
        ``trial=7`` is that run alone, ``only="trapped"`` leaves out others.

    Returns
    -------
    Trace

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    return Trace(_run("trace", {"scene": scene}, dict(trials=trials, seed=seed, progress=progress, **more)))


def validate(subject: _t.Any, *, observed: _t.Any = None, trials: int | None = None, seed: int | None = None, cell: Cell | None = None,
             progress: bool | None = None, **more: _t.Any) -> Result:
    """Compares the chain with the full dynamics, or with counts of yours; is the chain Markov?

    Parameters
    ----------
    subject : Scene, Matrix, path, text or dict
        A scene. A matrix of recorded runs: one half of the bodies against the other.
    observed : dict, DataFrame, path, or list of these, optional
        What an experiment saw: numbers of bodies by ending, ``{"crossed": 3, "trapped": 17}``; or a table with columns
        trial,ending; ending,count; or gate_x,gate_y,count.
    trials : int, optional
        Bodies of the full dynamics from each start; 100 without it, which shows no error of the chain: take 10 000.
    seed, cell, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk validate``: ``matrix=MATRIX``.

    Returns
    -------
    Result
        `starts`: verdict, endings, p-values of each; `markov`: what the states forget.

    Raises
    ------
    SceneError, UsageError, BadFile
        See `predict`.
    """
    with _contextlib.ExitStack() as stack:
        paths = None if observed is None else list(_table_files(stack, observed, "observed").values())
        data = _run("validate", {"subject": subject}, dict(observed=paths, trials=trials, seed=seed, cell=cell, progress=progress, **more))
    return Result(data)


def analyze(subject: _t.Any, *, accuracy: float | None = None, seed: int | None = None, cell: Cell | None = None, progress: bool | None = None,
            **more: _t.Any) -> Analysis:
    """Times, work, paths, other starts; what would change a field's outcome most.

    Parameters
    ----------
    subject : Scene, Matrix, path, text or dict
    accuracy : float, optional
        Of the final gates (total variation, 95 %); 0.02 without it.
    seed, cell, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk analyze``: ``target="left_side"``, ``runs=0`` (no
        derivatives, which take most of the time), ``first_passage=(0, 4)`` (see `Matrix.first_passage`).

    Returns
    -------
    Analysis
        Times in s, work in J.

    Raises
    ------
    SceneError, UsageError, BadFile
        See `predict`.
    """
    return Analysis(_run("analyze", {"subject": subject}, dict(accuracy=accuracy, seed=seed, cell=cell, progress=progress, **more)))


def rare(subject: _t.Any, *, row: int | None = None, accuracy: float | None = None, seed: int | None = None, cell: Cell | None = None,
         progress: bool | None = None, **more: _t.Any) -> Result:
    """How likely far rows are, where trials never get (importance splitting).

    Parameters
    ----------
    subject : Scene, path, text or dict
    row : int, optional
        The row to reach, of a field without limit of gates.
    accuracy : float, optional
        Of the chance: its standard error as a part of it.
    seed, cell, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk rare``.

    Returns
    -------
    Result

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    return Result(_run("rare", {"subject": subject}, dict(row=row, accuracy=accuracy, seed=seed, cell=cell, progress=progress, **more)))


def plan(subject: _t.Any, *, accuracy: float | None = None, seed: int | None = None, progress: bool | None = None, **more: _t.Any) -> Result:
    """What a body should do in each gate, by how it enters, to cross the field as often as it can.

    Parameters
    ----------
    subject : Scene, path, text or dict
        With two tables ``[actions.NAME]`` at least: keys of forces and beams as they are while a body takes the action. With
        ``cell_program="COMMAND"`` a cell file, whose actions are numbers of that program, ``parameters.KEY``. A scene without
        any: the start is planned, over the ranges of ``over`` (``["start.x_m=-5:5"]``).
    accuracy : float, optional
        Half of the interval that a chance to cross may have.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk plan``.

    Returns
    -------
    Result
        ``crossed``, ``actions``, ``most_taken`` (or ``start``, ``starts``) and more of ``gatewalk plan --json``.

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    return Result(_run("plan", {"subject": subject}, dict(accuracy=accuracy, seed=seed, progress=progress, **more)))


def design(subject: _t.Any, *, changes: int | None = None, types: _t.Any = None, accuracy: float | None = None, seed: int | None = None,
           progress: bool | None = None, **more: _t.Any) -> Result:
    """Which gates of a field to change, so that bodies cross it as often, or as rarely, as they can.

    Parameters
    ----------
    subject : Scene, path, text or dict
        With a table ``[terrain]`` of several types of gates.
    changes : int, optional
        Gates that may be changed; 1.
    types : str, optional
        Names of types that they may become, ``"s,."``; all.
    accuracy : float, optional
        Half of the interval that a chance to cross may have.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk design``, such as ``least=True``.

    Returns
    -------
    Result
        ``crossed``, ``before``, ``gain``, ``changes``, ``map`` and more of ``gatewalk design --json``.

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    return Result(_run("design", {"subject": subject}, dict(changes=changes, types=types, accuracy=accuracy, seed=seed, progress=progress, **more)))


def fit(subject: _t.Any, observed: _t.Any, *, free: _t.Any, trials: int | None = None, seed: int | None = None,
        progress: bool | None = None, **more: _t.Any) -> Result:
    """Which numbers of a scene an experiment speaks for: their posterior.

    Parameters
    ----------
    subject : Scene, path, text or dict
        A scene of gates; with ``cell_program`` a file of cells.
    observed : dict, DataFrame, path, or list of these
        What an experiment saw, as in `validate`; with columns trial,ending,gate_x,gate_y too; or passages, as in `from_passages`.
    free : dict
        Numbers of the scene and their ranges, ``{"forces.propulsion_N": (5, 9)}``, or a program's (``"parameters.KEY"``); six at most.
    trials : int, optional
        Bodies of the full dynamics, or passages, at all points of the ranges together; 400 000.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk fit``, such as ``inference_data="posterior.nc"``, which ArviZ reads.

    Returns
    -------
    Result
        ``numbers`` with their intervals, ``correlation``, ``p`` and more of ``gatewalk fit --json``.

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    with _contextlib.ExitStack() as stack:
        data = _run("fit", {"subject": subject, **_table_files(stack, observed, "observed")}, dict(free=free, trials=trials, seed=seed, progress=progress, **more))
    return Result(data)


def power(subject: _t.Any, *, trials: int | None = None, seed: int | None = None, cell: Cell | None = None, progress: bool | None = None,
          **more: _t.Any) -> Result:
    """How many trials an experiment needs to show a difference.

    Parameters
    ----------
    subject : Scene, Matrix, path, text or dict
    trials : int, optional
        Trials of the experiment that is planned.
    seed, cell, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk power``: ``versus={"forces.random_N": 30.0}`` is the other
        scene, ``versus=MATRIX`` the other group of recorded runs.

    Returns
    -------
    Result
        `summary` in words, `from_prediction`, `two_groups` and `versus` by ending.

    Raises
    ------
    SceneError, UsageError, BadFile
        See `predict`.
    """
    return Result(_run("power", {"subject": subject}, dict(trials=trials, seed=seed, cell=cell, progress=progress, **more)))


def landscape(scene: _t.Any, *, spacing: float | None = None, beam: str | None = None, trials: int | None = None, seed: int | None = None,
              progress: bool | None = None, **more: _t.Any) -> Landscape:
    """The potential energy of body and beams over a gate, and the way through whose highest point is lowest.

    Parameters
    ----------
    spacing : float, optional
        Of the grid, in m; a twentieth of the body's radius without it.
    beam : str, optional
        Beams that resist: "both", "left" or "right".
    trials : int, optional
        Also run the gate so often.
    """
    import csv
    import tempfile

    import numpy as np

    with tempfile.TemporaryDirectory() as folder:
        given = dict(spacing=spacing, beam=beam, trials=trials, seed=seed, progress=progress, **more)
        data = _run("landscape", {"scene": scene}, given, [f"--output={folder}"])
        with open(_os.path.join(folder, "landscape.csv"), encoding="utf-8") as file:
            names, *rows = [row for row in csv.reader(file) if not row[0].startswith("#")]
    table = np.array(rows, dtype=float)
    return Landscape({**data, "table": {name: table[:, k] for k, name in enumerate(names)}})


def merge(parts: _t.Sequence[_t.Any], *, progress: bool | None = None) -> Result | Matrix:
    """One run of the parts that ``gatewalk ... --part FILE`` wrote on several machines: the same bits as of one machine.

    Parameters
    ----------
    parts : list of paths
        All parts of one command.

    Returns
    -------
    Result
        What its command gives; of ``build`` a Matrix.
    """
    if not isinstance(parts, (list, tuple)) or not parts:
        _refuse("parts", "a list of paths: merge takes a list of all parts", parts)
    paths = {f"parts[{k}]": _input_of(part, f"parts[{k}]", BadFile) for k, part in enumerate(parts)}
    command = ""
    with _contextlib.suppress(OSError, ValueError, IndexError, KeyError), open(paths["parts[0]"], "rb") as file:
        command = _json.loads(file.read(100_000).split(b"\n")[1])["command"]
    if command == "build":
        return _made("merge", paths, dict(progress=progress))
    kinds: dict[str, type[Result]] = {"predict": Prediction, "lattice": Prediction, "analyze": Analysis, "sweep": Sweep}
    return kinds.get(command, Result)(_run("merge", paths, dict(progress=progress)))


def sample(name: str | None = None) -> str:
    """The text of a sample: a scene, "tracks" with its "cell", "runs", "observed"; without a name what there is.

    Raises
    ------
    UsageError
        Where there is none of that name.

    Examples
    --------
    >>> import gatewalk as gw
    >>> gw.Scene(gw.sample("walker"))["body.mass_kg"]
    0.09
    """
    if name is None:
        return "\n".join(f"{s['name']}: {s['about']}" for s in _run("sample", {}, {})["samples"])
    if not isinstance(name, str):
        _refuse("name", "the name of a sample", name)
    return _t.cast(str, _run("sample", {}, {}, [name])["text"])


def walk(matrix: _t.Any, *, seed: int | None = None, progress: bool | None = None, **more: _t.Any) -> Result:
    """Walks the field by drawing from a matrix, one outcome a gate.

    Parameters
    ----------
    matrix : Matrix or path
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk walk``: ``walks=1_000_000``.

    Returns
    -------
    Result
        `endings`, and `final_gates` of shape (rows, columns), in numbers of walks; `never_sampled` and `still_walking`, which the
        endings leave out. Walks that are still walking have no final gate.

    Raises
    ------
    UsageError, BadFile
        See `predict`.
    """
    return Result(_run("walk", {"matrix": matrix}, dict(seed=seed, progress=progress, **more)))


from ._matrix import Matrix, _made, _table_files, build, from_counts, from_passages, load, passages  # noqa: E402  (they use _run)


for _name in ("gate", "validate", "rare", "plan", "design", "fit", "power", "walk"):
    _document(globals()[_name], _name)
