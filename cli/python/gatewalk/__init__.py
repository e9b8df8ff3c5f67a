# SPDX-License-Identifier: MIT
"""Locomotion through cluttered obstacles: simulates single gates, and predicts fields of gates with a Markov chain.

The functions run the commands of the program ``gatewalk``, and give the same numbers to the last bit and the same errors.
Options of a command are keyword arguments: ``--gate-runs 1e5`` is ``gate_runs=1e5``. ``help(gatewalk.predict)`` explains
the usual options, ``gatewalk.options("predict")`` prints all. Numbers, lists and paths may be those of numpy and pathlib.

Errors: `UsageError` (an argument), `SceneError` (a scene or a cell file) and `BadFile` (a matrix file) are ValueErrors. A
RuntimeError says that work could not be finished. `Matrix.save` raises OSError.

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
    """A warning of the program: why a result must not be taken at face value."""


def _as_called(value: _t.Any, key: str = "") -> _t.Any:
    """A result in which temporary files of this package have the names that errors give them."""
    if isinstance(value, str):
        return _without_folders(value if key == "command" else _renamed(value))
    if isinstance(value, dict):
        return {k: _as_called(v, k) for k, v in value.items()}
    if isinstance(value, list):
        return [_as_called(v) for v in value]
    return value


class _Bars:
    """Progress bars of tqdm, one at a time."""

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
    """Progress bars, if tqdm is installed and standard error is a terminal (or progress=True)."""
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
    """How many calls up the first caller outside of this package is: the place that a warning names."""
    here = _os.path.dirname(__file__)
    level, frame = 1, _sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(here):
        frame, level = frame.f_back, level + 1
    return level


def _run(command: str, subjects: dict[str, _t.Any], given: dict[str, _t.Any], extra: list[str] | None = None,
         gives_json: bool = True) -> dict[str, _t.Any]:
    """Runs a command with these subjects, by the names of their parameters. Raises the program's errors in Python's words."""
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
    """Sets the number of threads for all commands that follow. It never changes a result.

    Parameters
    ----------
    n : int
        The number of threads; 0 for all.

    Raises
    ------
    UsageError
        If n is not a whole number from 0 to 1024.
    """
    _core.threads(_whole(n, "threads: n", 0, 1024))


def options(command: str) -> str:
    """Returns the help page of a command: all options that its function takes as keyword arguments.

    Parameters
    ----------
    command : str
        The name of a command: "predict", "build", ...

    Returns
    -------
    str

    Raises
    ------
    UsageError
        If there is no such command.
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
    """Predicts where bodies end in a field, and how, with 95 % intervals.

    Parameters
    ----------
    subject : Scene, Matrix, path, text or dict
        A scene, for which trials are run until the prediction has the `accuracy`. Or a matrix, whose runs are used first.
    scene : Scene, path, text or dict, optional
        With a matrix: another scene with the same physics, such as another field. Default: the scene of the matrix.
    accuracy : float, optional
        Largest error of the final gates (total variation, 95 %). Default 0.02.
    start : tuple or list of tuples, optional
        Where and how fast bodies enter the field: (d, vx, vy) in m and m/s. For cells with several faces: the name of the face,
        then its coordinates. For a chain from elsewhere: the number or the name of a state. A list gives several starts.
    seed : int, optional
        Seed of all random numbers. Default 1.
    cell : Cell, optional
        A cell of your own, which simulates the passages; `subject` is a cell file then.
    progress : bool, optional
        True shows a progress bar of tqdm (which must not call gatewalk). Default: if tqdm is installed and standard error is a
        terminal.
    **more
        Any option of ``gatewalk predict``, "-" written "_".

    Returns
    -------
    Prediction

    Raises
    ------
    SceneError, UsageError, BadFile
        ValueErrors that name the key or the argument, and what is allowed.
    """
    return Prediction(_run("predict", {"subject": subject} if scene is None else {"subject": subject, "scene": scene}, dict(accuracy=accuracy, start=start, seed=seed, cell=cell, progress=progress, **more)))


def lattice(subject: _t.Any, *, trials: int | None = None, seed: int | None = None, cell: Cell | None = None, progress: bool | None = None,
            **more: _t.Any) -> Prediction:
    """Simulates bodies through the whole field (full dynamics, no chain), and counts where and how they end.

    Parameters
    ----------
    subject : Scene, path, text or dict
        A scene, or with `cell` a cell file.
    trials : int, optional
        Number of bodies. Default 100.
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


simulate = lattice  #: Another name of `lattice`.


def gate(scene: _t.Any, *, trials: int | None = None, seed: int | None = None, progress: bool | None = None, **more: _t.Any) -> Result:
    """Simulates runs through one gate, and counts how many traverse it, leave by its sides, or are trapped.

    Parameters
    ----------
    scene : Scene, path, text or dict
    trials : int, optional
        Number of runs. Default 100.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk gate``.

    Returns
    -------
    Result
        `trials`, and the number of runs with each outcome.

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    return Result(_run("gate", {"scene": scene}, dict(trials=trials, seed=seed, progress=progress, **more)))


def sweep(scene: _t.Any, vary: dict[str, _t.Any], *, trials: int | None = None, seed: int | None = None, progress: bool | None = None,
          **more: _t.Any) -> Sweep:
    """Runs `gate` over a grid of values of scene keys.

    Parameters
    ----------
    scene : Scene, path, text or dict
    vary : dict
        The values of each key, as a list or as a text "from:step:to": ``{"forces.propulsion_N": [5, 6, 7]}``.
    trials : int, optional
        Number of runs at each point.
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
    """Records single runs: place, velocity, beams, forces and energies at every step.

    Parameters
    ----------
    scene : Scene, path, text or dict
    trials : int, optional
        Number of runs; they are numbered from 0.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk trace``: ``field=True`` follows bodies across the field,
        ``trial=7`` records run 7 alone, ``only="trapped"`` keeps only runs with this outcome.

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
    """Compares the chain with the full dynamics, and both with your experiment; tests whether the chain is Markov.

    Parameters
    ----------
    subject : Scene, Matrix, path, text or dict
        A scene. Or a matrix of recorded runs: then one half of the bodies is compared with the chain of the other half.
    observed : dict, DataFrame, path, or list of these, optional
        Counts of an experiment: numbers of bodies by ending, ``{"crossed": 3, "trapped": 17}``; or a table with the columns
        trial,ending; ending,count; or gate_x,gate_y,count.
    trials : int, optional
        Number of bodies of the full dynamics from each start. Default 100, too few to show an error of the chain: use 10 000.
    seed, cell, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk validate``: ``matrix=MATRIX``.

    Returns
    -------
    Result
        `starts`: the verdict, endings and p-values for each start; `markov`: what the states of the chain forget.

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
    """Computes times, work, paths and other starts of a field, and which number of the scene changes the outcome most.

    Parameters
    ----------
    subject : Scene, Matrix, path, text or dict
    accuracy : float, optional
        Largest error of the final gates (total variation, 95 %). Default 0.02.
    seed, cell, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk analyze``: ``target="left_side"``; ``runs=0`` leaves out the
        derivatives, which take most of the time; ``first_passage=(0, 4)`` (see `Matrix.first_passage`).

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
    """Estimates the chance that a body reaches a far row, where plain trials never get (importance splitting).

    Parameters
    ----------
    subject : Scene, path, text or dict
    row : int, optional
        The row to reach, in a field without a limit of gates.
    accuracy : float, optional
        Largest standard error of the chance, as a share of the chance.
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
    """Finds which action a body should take in each gate, by how it enters, to cross the field as often as possible.

    Parameters
    ----------
    subject : Scene, path, text or dict
        A scene with at least two tables ``[actions.NAME]``: values of forces and beams while a body takes the action. With
        ``cell_program="COMMAND"`` a cell file, whose actions are parameters of that program, ``parameters.KEY``. For a scene
        without actions `plan` finds the best start, in the ranges of ``over`` (``["start.x_m=-5:5"]``).
    accuracy : float, optional
        Largest half width of the 95 % interval of the chance to cross.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk plan``.

    Returns
    -------
    Result
        The result of ``gatewalk plan --json``: ``crossed``, ``actions``, ``most_taken`` (or ``start``, ``starts``) and more.

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    return Result(_run("plan", {"subject": subject}, dict(accuracy=accuracy, seed=seed, progress=progress, **more)))


def design(subject: _t.Any, *, changes: int | None = None, types: _t.Any = None, accuracy: float | None = None, seed: int | None = None,
           progress: bool | None = None, **more: _t.Any) -> Result:
    """Finds which gates of a field to change, so that bodies cross it as often, or as rarely, as possible.

    Parameters
    ----------
    subject : Scene, path, text or dict
        A scene with a table ``[terrain]`` of several types of gates.
    changes : int, optional
        How many gates may be changed. Default 1.
    types : str, optional
        Names of the types that gates may become, ``"s,."``. Default: all types.
    accuracy : float, optional
        Largest half width of the 95 % interval of the chance to cross.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk design``, such as ``least=True``.

    Returns
    -------
    Result
        The result of ``gatewalk design --json``: ``crossed``, ``before``, ``gain``, ``changes``, ``map`` and more.

    Raises
    ------
    SceneError, UsageError
        See `predict`.
    """
    return Result(_run("design", {"subject": subject}, dict(changes=changes, types=types, accuracy=accuracy, seed=seed, progress=progress, **more)))


def fit(subject: _t.Any, observed: _t.Any, *, free: _t.Any, trials: int | None = None, seed: int | None = None,
        progress: bool | None = None, **more: _t.Any) -> Result:
    """Estimates numbers of a scene from an experiment: their posterior distribution.

    Parameters
    ----------
    subject : Scene, path, text or dict
        A scene, or with ``cell_program`` a cell file.
    observed : dict, DataFrame, path, or list of these
        Counts of an experiment, as in `validate`, also with the columns trial,ending,gate_x,gate_y; or passages, as in
        `from_passages`.
    free : dict
        At most six numbers of the scene with their ranges, ``{"forces.propulsion_N": (5, 9)}``, or parameters of the program,
        ``"parameters.KEY"``.
    trials : int, optional
        Number of simulated trials (or passages) at all points of the ranges together. Default 400 000.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk fit``, such as ``inference_data="posterior.nc"``, which ArviZ reads.

    Returns
    -------
    Result
        The result of ``gatewalk fit --json``: ``numbers`` with their intervals, ``correlation``, ``p`` and more.

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
    """Computes how many trials an experiment needs to show a difference.

    Parameters
    ----------
    subject : Scene, Matrix, path, text or dict
    trials : int, optional
        Number of trials in the planned experiment.
    seed, cell, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk power``: ``versus={"forces.random_N": 30.0}`` compares with the
        scene that has these keys, ``versus=MATRIX`` with another group of recorded runs.

    Returns
    -------
    Result
        `summary` in words; `from_prediction`, `two_groups` and `versus`: numbers of trials by ending.

    Raises
    ------
    SceneError, UsageError, BadFile
        See `predict`.
    """
    return Result(_run("power", {"subject": subject}, dict(trials=trials, seed=seed, cell=cell, progress=progress, **more)))


def landscape(scene: _t.Any, *, spacing: float | None = None, beam: str | None = None, trials: int | None = None, seed: int | None = None,
              progress: bool | None = None, **more: _t.Any) -> Landscape:
    """Computes the potential energy of body and beams over a gate, and the path through it whose highest point is lowest.

    Parameters
    ----------
    scene : Scene, path, text or dict
    spacing : float, optional
        Spacing of the grid, in m. Default: a twentieth of the body's radius.
    beam : str, optional
        Which beams resist: "both", "left" or "right".
    trials : int, optional
        Number of runs through the gate that are simulated too.
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk landscape``.

    Returns
    -------
    Landscape
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
    """Joins the parts that ``gatewalk ... --part FILE`` wrote on several machines. The result has the bits of a single run.

    Parameters
    ----------
    parts : list of paths
        All parts of one command.

    Returns
    -------
    Result
        The result of the command that wrote the parts; for ``build`` a Matrix.
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
    """Returns the text of a sample file: a scene, "tracks" and its "cell", "runs", or "observed".

    Parameters
    ----------
    name : str, optional
        The name of the sample. Without a name `sample` returns a list of all samples.

    Raises
    ------
    UsageError
        If there is no sample of that name.

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
    """Simulates random walks through the field with a transition matrix, one draw for each gate.

    Parameters
    ----------
    matrix : Matrix or path
    seed, progress, **more
        See `predict`; ``**more`` is any option of ``gatewalk walk``: ``walks=1_000_000``.

    Returns
    -------
    Result
        Numbers of walks: `endings`, and `final_gates` of shape (rows, columns). `never_sampled` and `still_walking` count walks
        without an ending. A walk that is still under way has no final gate.

    Raises
    ------
    UsageError, BadFile
        See `predict`.
    """
    return Result(_run("walk", {"matrix": matrix}, dict(seed=seed, progress=progress, **more)))


from ._matrix import Matrix, _made, _table_files, build, from_counts, from_passages, load, passages  # noqa: E402  (they use _run)


for _name in ("gate", "validate", "rare", "plan", "design", "fit", "power", "walk"):
    _document(globals()[_name], _name)
