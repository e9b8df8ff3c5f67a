# SPDX-License-Identifier: MIT
"""Matrices: building, saving, reading and asking them."""

from __future__ import annotations

import contextlib
import csv
import io
import numbers
import os
import reprlib
import shutil
import tempfile
import typing as t
import weakref

from . import _core, _run
from ._cell import Cell
from ._results import Analysis, FirstPassage, Prediction, Result, require_axes
from ._scene import OWN_ERRORS, TEMPORARY, called, file_of, without_folders
from ._words import _OTHERS, in_python, input_of, path_of, plain, refuse


def _unlink(path: str, owner: int | None = None) -> None:
    if owner not in (None, os.getpid()):  # a forked process: the file is its parent's
        return
    with contextlib.suppress(OSError):
        os.unlink(path)


class Matrix:
    """The transition matrix of one cell, counted from short runs, with everything that predictions from it need.

    `build`, `from_passages`, `from_counts` and `load` make one; `save` writes it for the program. States count from 0.
    """

    def __init__(self, path: t.Any, _owned: bool = False) -> None:
        self._file: str = os.path.abspath(input_of(path, "path", _core.BadFile))
        self._name = "the matrix" if _owned else self._file  # in messages
        before = self._stamp()
        try:
            self._core = _core.Matrix(self._file)
        except OWN_ERRORS as error:
            raise type(error)(in_python(str(error), "walk")) from None
        self._loaded = before
        _ = self._path
        if _owned:
            self._gone = weakref.finalize(self, _unlink, self._file, os.getpid())

    def _stamp(self) -> t.Any:
        try:
            s = os.stat(self._file)
        except OSError:
            return None
        return s.st_dev, s.st_ino, s.st_size, s.st_mtime_ns

    @property
    def _path(self) -> str:
        """The path of the matrix file. Raises BadFile if the file has changed since it was loaded."""
        if self._stamp() != self._loaded:
            raise _core.BadFile(f"{self._file}: was changed or removed since it was loaded; gatewalk.load(...) reads it again")
        return self._file

    def _is_of_states(self) -> bool:
        """Whether the chain comes from elsewhere, so that its states have numbers and no places."""
        return list(self._core.states())[-3:] == ["face", "state_low", "state_high"]

    @property
    def matrix(self) -> t.Any:
        """Transition probabilities, a scipy.sparse.csr_matrix of shape (states, states + 1), without a copy.

        Each row is a state in which a gate is entered. Each column is the state in which the next gate is entered; the last column
        is *trapped*.
        """
        return self.probabilities()

    def probabilities(self, type: str = "") -> t.Any:  # noqa: A002
        """Transition probabilities of one type of gates, in the form of `matrix`.

        Parameters
        ----------
        type : str
            One of `types`.
        """
        return self._csr(type, True)

    def counts(self, type: str = "") -> t.Any:  # noqa: A002
        """Counts of runs in the form of `matrix`, int64.

        Counts of a matrix of trees include mirror images. A posterior computed from them is too narrow by sqrt(2).

        Parameters
        ----------
        type : str
            One of `types`.
        """
        return self._csr(type, False)

    def _csr(self, type: str, probabilities: bool) -> t.Any:  # noqa: A002
        from scipy.sparse import csr_matrix

        if not isinstance(type, str) or type not in self.types:
            refuse("type", f"one of {', '.join(map(repr, self.types))}", type)
        data, indices, indptr, shape = self._core.csr(type, probabilities)
        return csr_matrix((data, indices, indptr), shape=shape, copy=False)

    @property
    def types(self) -> list[str]:
        """Names of the types of gates; "" is the gate of the scene itself."""
        return self._core.types

    @property
    def states(self) -> t.Any:
        """A pandas.DataFrame with a line for each state: its face, and low and high of each coordinate (m, m/s).

        The lines stand in the order of the rows and columns of `matrix` and `counts`. For a chain of `from_counts` each state also
        has its name, and the index is what ``start=`` takes.
        """
        import pandas

        return pandas.DataFrame(self._core.states()).rename_axis("state")

    @property
    def moves(self) -> dict[str, tuple[int, int]]:
        """For each face the move (columns, rows) into the cell that is entered by it."""
        return {name: (x, y) for name, x, y in self._core.faces()}

    @property
    def made_by(self) -> dict[str, str]:
        """Where the matrix comes from: scene, seed, version, command."""
        return {key: without_folders(text) for key, text in self._core.text.items()}

    def save(self, path: t.Any) -> None:
        """Writes the matrix to `path` as NetCDF-4. Raises OSError if it fails; then no half-written file is left."""
        path = path_of(path, "path")
        try:
            handle, name = tempfile.mkstemp(dir=os.path.dirname(path) or ".", prefix=".gatewalk-")
        except OSError as error:  # which names the temporary file
            raise type(error)(error.errno, error.strerror, path) from None
        try:
            with os.fdopen(handle, "wb") as out, open(self._path, "rb") as source:
                shutil.copyfileobj(source, out)
                out.flush()
                os.fsync(out.fileno())
            os.chmod(name, 0o644)
            os.replace(name, path)
        except BaseException:
            _unlink(name)
            raise

    def predict(self, **more: t.Any) -> Prediction:
        """Where bodies end in a field of these cells: `gatewalk.predict`."""
        from . import predict

        return predict(self, **more)

    def export(self, path: t.Any, **more: t.Any) -> Result:
        """Writes the chain for other programs, in the format that the ending of `path` names.

        Parameters
        ----------
        path : path
            For the chain of the whole field: .umb (PRISM, Storm), .drn (Storm), .tra (PRISM), .mtx, .csv, .npz. For the matrix
            of one gate: .mtx, .csv, .npz with ``gate=True``, its counts with ``counts=True`` too. For the states that each trial
            went through: .dtrajs, .dtrajs.npz.

        Returns
        -------
        Result
            Numbers of states and transitions, and `endings`, the state of each ending.
        """
        return Result(_run("export", {"self": self}, dict(more), [f"--output={path_of(path, 'path')}"]))

    def analyze(self, **more: t.Any) -> Analysis:
        """Times, costs and paths of bodies in a field of these cells: `gatewalk.analyze`."""
        from . import analyze

        return analyze(self, **more)

    def first_passage(self, target: t.Any, **more: t.Any) -> FirstPassage:
        """Committors and mean first passage times, from the start and from every state of every gate.

        Parameters
        ----------
        target : str, tuple or int
            What bodies must reach: an ending ("crossed"), a gate (i_x, i_y) (i_x = 0 is the start's column), a state in any gate (its
            name or number), or a state of one gate (i_x, i_y, state).
        **more
            Options of ``gatewalk analyze``: ``set={"field.max_gates": 0}``, ``start``.

        Returns
        -------
        FirstPassage

        Raises
        ------
        UsageError
            If there is no such target; the message lists what is allowed.

        Examples
        --------
        >>> import gatewalk as gw, numpy as np
        >>> states = {"state": [0, 1], "move_x": [0, 0], "move_y": [1, -1]}
        >>> fair = gw.from_counts(np.array([[5, 5], [5, 5]]), states, start=0,
        ...                       set={"field.rows": 4, "field.columns": 1, "field.max_gates": 0})
        >>> fair.first_passage((0, 3)).of_states["probability"][:, 0, 0].round(12).tolist()
        [0.25, 0.5, 0.75, 1.0]
        """
        from . import analyze

        if target is None:
            refuse("target", _OTHERS["first-passage"], target)
        more = {"runs": 0, "paths": 0, **more}
        answer = analyze(self, first_passage=target, **more)
        return FirstPassage({**answer["first_passage"], "made_by": answer["made_by"]})

    def walk(self, **more: t.Any) -> Result:
        """Random walks through a field of these cells: `gatewalk.walk`."""
        from . import walk

        return walk(self, **more)

    def validate(self, **more: t.Any) -> Result:
        """Compares the chain with full trials (`gatewalk.validate`). For recorded runs: one half of the bodies with the other."""
        from . import validate

        text = self.made_by.get("scene")
        return validate(self, **more) if text is None else validate(text + "\n", matrix=self, **more)

    def plot(self, axes: t.Any = None) -> t.Any:
        """Draws the matrix with matplotlib: rows are the states before, columns the states after. Returns the axes."""
        import matplotlib.pyplot as plt
        import numpy as np
        from matplotlib.colors import LogNorm

        if axes is None:
            _, axes = plt.subplots(figsize=(3.5, 3.2), constrained_layout=True)
        axes = require_axes(axes)
        dense = self.matrix.toarray()
        dense = np.ma.masked_where(dense <= 0.0, dense)  # type: ignore[no-untyped-call]
        image = axes.imshow(dense, norm=LogNorm(), cmap="viridis", interpolation="nearest")
        axes.figure.colorbar(image, ax=axes, label="probability")
        axes.set_xlabel("to state (last: trapped)")
        axes.set_ylabel("from state")
        return axes

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Matrix) and self._bytes() == other._bytes()

    __hash__ = None  # type: ignore[assignment]

    def _bytes(self) -> bytes:
        with open(self._path, "rb") as file:
            return file.read()

    def __reduce__(self) -> t.Any:
        return _from_bytes, (self._bytes(),)

    def __copy__(self) -> Matrix:
        return _from_bytes(self._bytes())

    def __deepcopy__(self, memo: t.Any) -> Matrix:
        return _from_bytes(self._bytes())

    def __repr__(self) -> str:
        _, _, _, (rows, columns) = self._core.csr("", False)
        return f"<gatewalk.Matrix {rows} x {columns}{', types ' + ', '.join(t for t in self.types if t) if len(self.types) > 1 else ''}>"


def _temporary() -> str:
    handle, name = tempfile.mkstemp(suffix=".nc", prefix=TEMPORARY)
    os.close(handle)
    return name


def _from_bytes(data: bytes) -> Matrix:
    name = _temporary()
    with open(name, "wb") as out:
        out.write(data)
    return Matrix(name, _owned=True)


def load(path: t.Any) -> Matrix:
    """Reads a matrix file.

    Parameters
    ----------
    path : path
        A file that ``gatewalk build`` or `Matrix.save` wrote.

    Returns
    -------
    Matrix

    Raises
    ------
    BadFile
        If it is not a matrix file, or is damaged.
    """
    return Matrix(path)


def _made(command: str, subjects: dict[str, t.Any], given: dict[str, t.Any], words: t.Sequence[str] = ()) -> Matrix:
    """Runs a command that writes a matrix file, and returns the matrix."""
    name = _temporary()
    try:
        with called(name, "the matrix"):
            _run(command, subjects, given, [*words, f"--output={name}", "--force"], gives_json=False)
        return Matrix(name, _owned=True)
    except BaseException:
        _unlink(name)
        raise


def build(subject: t.Any, *, accuracy: float | None = None, starts: t.Any = None, seed: int | None = None, cell: Cell | None = None,
          progress: bool | None = None, **more: t.Any) -> Matrix:
    """Builds the transition matrix of a scene's gates from short runs.

    Parameters
    ----------
    subject : Scene, path, text or dict
        A scene, or with `cell` a cell file.
    accuracy : float, optional
        Largest error of predictions from the matrix (total variation of the final gates, 95 %). Default 0.02. With ``bins="paper",
        trials=100`` the states are the 87 of the paper instead, with 100 runs each.
    starts : str, optional
        "all", or a range of starts. The matrix then serves every start of the range.
    seed, cell, progress, **more
        See `predict`.

    Returns
    -------
    Matrix

    Raises
    ------
    SceneError, UsageError, BadFile
        See `predict`.
    """
    return _made("build", {"subject": subject}, dict(accuracy=accuracy, starts=starts, seed=seed, cell=cell, progress=progress, **more))


#: What `_table_file` accepts as a table.
_TABLES = "a path, a DataFrame, or a dict of lists"
_OF_LINES = "pandas.DataFrame(lines) makes a table of a list of lines"


def _is_column(value: t.Any) -> bool:
    return isinstance(value, (list, tuple, range)) or (hasattr(value, "tolist") and getattr(value, "ndim", 1) == 1)


def _heading(name: t.Any) -> str:
    """The name of a column on one line, without blanks at its ends."""
    return " ".join(str(name).split())


def _csv_of_columns(columns: t.Mapping[t.Any, t.Any], parameter: str) -> str:
    """A dict of lists or arrays as CSV with all digits. Missing values are empty fields."""
    for name, column in columns.items():
        if not _is_column(column):
            of_lines = "" if any(map(_is_column, columns.values())) else f" ({_OF_LINES})"
            refuse(f"{parameter}: column {name!r}", "a list or an array, as the others are" + of_lines, column)
    lengths = {str(name): len(column) for name, column in columns.items()}
    if len(set(lengths.values())) > 1:
        raise _core.UsageError(f"{parameter}: columns must be of one length; " + ", ".join(f"{name} has {n}" for name, n in lengths.items()))

    def field(value: t.Any) -> str:
        if isinstance(value, str):
            return value
        text = repr(value) if isinstance(value, float) else str(value)
        return "" if text in ("None", "nan", "<NA>", "NaT") else text  # pandas.NA has no truth value to ask for

    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(map(_heading, columns))
    writer.writerows(zip(*([field(value) for value in plain(column)] for column in columns.values())))
    return out.getvalue()


def _csv_of_frame(frame: t.Any, parameter: str) -> str:
    """A DataFrame as CSV with all digits. NaN is an empty field. Named levels of the index are columns."""
    levels = frame.columns.nlevels
    poses = ["scorer", *(["individuals"] if levels == 4 or "individuals" in frame.columns.names else []), "bodyparts", "coords"]  # DeepLabCut's
    out = io.StringIO()
    if levels == 1:
        named = [name for name in frame.index.names if name is not None and name not in frame.columns]
        frame = frame.reset_index(level=named) if named else frame
        frame.to_csv(out, index=False, header=list(map(_heading, frame.columns)), float_format="%.17g")
        return out.getvalue()
    if levels == len(poses) - 1:  # without the scorer
        frame = frame.set_axis(type(frame.columns).from_tuples([("scorer", *one) for one in frame.columns]), axis=1)
    elif levels != len(poses):
        raise _core.UsageError(f"{parameter}: its columns have {levels} levels; DeepLabCut's have {', '.join(poses)}, other tables one: "
                               "table.columns = [...] names them")
    with_index = list(frame.columns[0]) != poses  # else the frames are its first column
    if with_index:
        frame = frame.rename_axis(index=None, columns=poses)
    frame.to_csv(out, index=with_index, float_format="%.17g")
    return out.getvalue()


def _csv_of_counts(counts: t.Mapping[str, t.Any]) -> str:
    for ending, n in counts.items():
        if isinstance(n, bool) or not isinstance(n, numbers.Real) or n != n // 1:  # NaN too
            of_lines = f"; {_OF_LINES}" if isinstance(n, str) else ""
            raise _core.UsageError(f"the table: the count of {ending} must be a whole number, it is {reprlib.repr(n)}{of_lines}")
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([("ending", "count"), *((ending, int(n)) for ending, n in counts.items())])
    return out.getvalue()


def _csv_of(table: t.Any, parameter: str) -> str:
    counts = parameter == "observed"  # by ending, which other tables are not
    if counts and getattr(table, "ndim", 2) == 1 and hasattr(table, "to_dict"):  # a Series
        table = table.to_dict()
    if getattr(getattr(table, "dtype", None), "names", None):  # an array of records
        table = {name: table[name] for name in table.dtype.names}
    if isinstance(table, t.Mapping):
        if any(hasattr(one, "columns") or (isinstance(one, t.Mapping) and any(map(_is_column, one.values()))) for one in table.values()):
            needed = "a list of tables: list(tables.values())" if parameter in ("tracks", "observed") else "one table"
            raise _core.UsageError(f"{parameter}: is a dict of tables; must be {needed}")
        return _csv_of_counts(table) if counts and not any(map(_is_column, table.values())) else _csv_of_columns(table, parameter)
    if hasattr(table, "to_csv") and hasattr(table, "columns"):
        return _csv_of_frame(table, parameter)
    of_lines = f" ({_OF_LINES})" if isinstance(table, (list, tuple)) and table and isinstance(table[0], t.Mapping) else ""
    refuse(parameter, _TABLES + (", or a dict of counts by ending" if counts else "") + of_lines, table)


@contextlib.contextmanager
def _table_file(table: t.Any, parameter: str, number: str = "") -> t.Iterator[str]:
    """A file with the table, or with counts by ending. A path stays as it is. `number`: which one of several tables."""
    if isinstance(table, (str, os.PathLike)):
        yield input_of(table, parameter)
        return
    with tempfile.TemporaryDirectory(prefix=TEMPORARY) as folder:
        if hasattr(table, "to_netcdf") and not hasattr(table, "to_csv"):
            name = os.path.join(folder, f"tracks{number}.nc")
            table.to_netcdf(name)
        else:
            name = os.path.join(folder, "states.csv" if parameter == "states" else f"table{number}.csv")
            with open(name, "w", encoding="utf-8", newline="") as file:
                file.write(_csv_of(table, parameter))
        with called(name, "the table of states" if parameter == "states" else f"the table {number}" if number else "the table"):
            yield name


def _table_files(stack: contextlib.ExitStack, tables: t.Any, parameter: str) -> dict[str, str]:
    """Files of one table, or of a list of tables."""
    several = list(tables) if isinstance(tables, (list, tuple)) else [tables]
    if not several:
        raise _core.UsageError(f"{parameter}: is empty; must be {_TABLES}, or a list of these")
    for k, table in enumerate(several):
        first = next(j for j, one in enumerate(several) if one is table)
        if first < k:
            raise _core.UsageError(f"{parameter}: the table {k} is the table {first} again (counted from 0), and would count twice")
    return {f"{parameter}[{k}]": stack.enter_context(_table_file(table, parameter, str(k) if len(several) > 1 else ""))
            for k, table in enumerate(several)}


def from_passages(table: t.Any, cell: t.Any, **more: t.Any) -> Matrix:
    """Builds a matrix from recorded passages.

    Parameters
    ----------
    table : pandas.DataFrame, dict of lists, or path
        A line for each passage, with the columns ``body``, ``trial``, ``in``, each coordinate, ``out``, each coordinate as
        ``out_...``, ``time_s``.
    cell : path, text or dict
        The cell file: faces, coordinates, field.
    **more
        Any option of ``gatewalk build``, "-" written "_".

    Returns
    -------
    Matrix

    Raises
    ------
    SceneError, UsageError, BadFile
        If the table or the cell file is wrong: the line and column, and what is allowed.
    """
    with _table_file(table, "table") as name, file_of(cell, "cell") as (path, _):
        return _made("build", {"table": name}, dict(more), [f"--cell={path}"])


def _first(bad: t.Any) -> int:
    return int(bad.argmax())


def _states_of(one: t.Any, which: int) -> list[int]:
    """The states of a trajectory. Raises UsageError, with the step, for a value that is not a whole number from 0."""
    import numpy as np

    def bad_step(step: int, what: str) -> t.NoReturn:
        raise _core.UsageError(f"the chain: trajectory {which}, step {step} (counted from 0): {what}")

    no_states = (bool, np.bool_, np.timedelta64)  # though Python counts them as whole numbers
    if isinstance(one, (list, tuple)):  # of which numpy would make numbers
        for step, state in enumerate(one):
            if state is np.ma.masked:
                bad_step(step, "masked; cut the trajectory there")
            if isinstance(state, no_states):
                bad_step(step, f"{state!r} is no whole number")
    dimensions = 0 if isinstance(one, (str, bytes)) else np.asarray(one, dtype=object).ndim
    if dimensions != 1:
        raise _core.UsageError(f"the chain: trajectory {which} is no sequence of states, but {type(one).__name__}"
                               + ("" if dimensions else "; one trajectory is a list of one array: [states]"))
    if np.ma.is_masked(one):  # type: ignore[no-untyped-call]
        bad_step(_first(np.ma.getmaskarray(one)), "masked; cut the trajectory there")  # type: ignore[no-untyped-call]
    states = np.asarray(one)
    if states.dtype.kind not in "iuf":
        for step, state in enumerate(one):
            whole = isinstance(state, numbers.Real) and not isinstance(state, no_states) and state == state and state == state // 1
            if not whole:
                bad_step(step, f"{state!r} is no whole number")
        states = np.array([int(state) for state in one], dtype=object)
    with np.errstate(invalid="ignore"):
        bad = ~(states == np.floor(states)) | ~(abs(states) < 2.0**53) if states.dtype.kind == "f" else np.zeros(len(states), bool)
    if bad.any():
        bad_step(_first(bad), f"{states[_first(bad)]} is no whole number" + ("; cut the trajectory there" if np.isnan(states[_first(bad)]) else ""))
    if len(states) and (states < -1).any():
        step = _first(states < -1)
        bad_step(step, f"{states[step]} is no state, they count from 0; -1 is a gap")
    return [int(state) for state in states]


def _require_matrix(chain: t.Any) -> None:
    """Raises UsageError for masked entries, for types that are no numbers, and for counts above 2^63 - 1."""
    import numpy as np

    if np.ma.is_masked(chain):  # type: ignore[no-untyped-call]
        row, column = np.argwhere(np.ma.getmaskarray(chain))[0]  # type: ignore[no-untyped-call]
        raise _core.UsageError(f"the chain: row {row}, column {column} (counted from 0) is masked; fill it with what it is")
    if chain.dtype.kind not in "iuf":
        raise _core.UsageError(f"the chain: is a matrix of {chain.dtype}; must be whole numbers (counts) or floats (probabilities)")
    data = chain.data if hasattr(chain, "tocsr") else chain
    if chain.dtype.kind == "u" and data.size and int(data.max()) >= 2**63:
        raise _core.UsageError(f"the chain: has a count of {data.max()}, more than 2^63 - 1")


@contextlib.contextmanager
def _chain_file(chain: t.Any) -> t.Iterator[str]:
    """A file with a sparse or dense matrix, or with trajectories. A path stays as it is."""
    if isinstance(chain, (str, os.PathLike)):
        yield input_of(chain, "chain")
        return
    import numpy as np
    from scipy.sparse import csr_matrix, issparse, save_npz

    is_array = isinstance(chain, np.ndarray)
    if not (issparse(chain) or is_array or isinstance(chain, (list, tuple))):
        raise _core.UsageError(f"the chain: is {type(chain).__name__}; a matrix is a numpy array or of scipy.sparse (numpy.asarray(chain) "
                               "makes one), trajectories are a list of 1-D arrays")
    if is_array and chain.ndim != 2 and chain.dtype != object:
        raise _core.UsageError(f"the chain: is an array of shape {chain.shape}; a matrix has two dimensions, one trajectory is a list "
                               "of one array: [states]")
    with tempfile.TemporaryDirectory(prefix=TEMPORARY) as folder:
        if issparse(chain) or (is_array and chain.ndim == 2):
            name = os.path.join(folder, "chain.npz")
            _require_matrix(chain)
            save_npz(name, csr_matrix(chain.astype(np.int64) if chain.dtype.kind == "u" else chain))
        else:
            n, nested = len(chain), all(isinstance(one, (list, tuple)) for one in chain)
            lengths = {len(one) for one in chain} if nested else set()
            if n and nested and len(lengths) == 1 and lengths <= {n, n + 1}:
                raise _core.UsageError(f"the chain: {n} lists of {lengths.pop()} numbers may be a matrix or trajectories: "
                                       "numpy.array(chain) is a matrix, [numpy.array(one) for one in chain] are trajectories")
            trajectories = [_states_of(one, k) for k, one in enumerate(chain)]
            if all(len(one) < 2 for one in trajectories):
                raise _core.UsageError("the chain: no trajectory has a step, which needs two states")
            name = os.path.join(folder, "chain.dtrajs")
            with open(name, "w", encoding="utf-8") as file:
                file.writelines(" ".join(map(str, one)) + "\n" for one in trajectories)
        with called(name, "the chain"):
            yield name


def from_counts(chain: t.Any, states: t.Any, *, start: int | None = None, **more: t.Any) -> Matrix:
    """Makes a matrix of a Markov chain of your own, from counts, probabilities or trajectories.

    Parameters
    ----------
    chain : scipy.sparse matrix, numpy array of shape (n, n) or (n, n + 1), list of trajectories, or path
        The chain of one cell. A matrix of whole numbers holds counts, also as floats unless no row has more than a single 1.0;
        a matrix of other numbers holds probabilities. The last of n + 1 columns is *trapped*. A list holds trajectories: each is a
        sequence of states, whose last may be n (trapped); -1 is a gap, at which the trajectory is cut. A list of n lists of n or
        n + 1 numbers may be either, and is refused: make it a numpy array, or a list of 1-D arrays. Effective counts that are not
        whole must be rounded, or divided by the sum of their row; they are probabilities then, and have no intervals.
    states : pandas.DataFrame, dict of lists, or path
        A line for each state, with the columns ``state`` (0, 1, ...), ``move_x`` and ``move_y``, the move into the cell that
        enters this state; optional: ``name``, ``face``.
    start : int, optional
        The state in which bodies start.
    **more
        Any option of ``gatewalk import``, "-" written "_".

    Returns
    -------
    Matrix

    Raises
    ------
    UsageError
        If the chain or the states are wrong: what, and where. States must be whole numbers; NaN and masked entries are refused with
        trajectory and step. At least one trajectory must have a step.

    Examples
    --------
    >>> import gatewalk as gw, numpy as np
    >>> up = gw.from_counts(np.array([[6, 4]]), {"state": [0], "move_x": [0], "move_y": [1]}, start=0, set={"field.rows": 2, "field.columns": 1})
    >>> round(up.predict().endings["crossed"], 12)
    0.36
    """
    with _chain_file(chain) as name, _table_file(states, "states") as path:
        return _made("import", {"chain": name}, dict(start=start, **more), [f"--states={path}"])


def passages(tracks: t.Any, cell: t.Any, **more: t.Any) -> t.Any:
    """Cuts tracks into passages through cells.

    Parameters
    ----------
    tracks : pandas.DataFrame, dict of lists, xarray.Dataset or path
        Places by body and frame (name the columns: ``columns={"x": "POSITION_X", ...}``), or poses of DeepLabCut or movement.
    cell : path, text or dict
        The cell file.
    **more
        Options of ``gatewalk passages``: fps, metres_per_unit, fastest, bridge, ...

    Returns
    -------
    pandas.DataFrame
        A line for each passage, as `from_passages` takes it. ``attrs`` has the result of ``gatewalk passages --json``: what lies
        outside the lattice, units that the file states, what was left out.

    Raises
    ------
    SceneError, UsageError, BadFile
        If something is missing or wrong in the tracks: what, and where.
    """
    import pandas

    with contextlib.ExitStack() as stack:
        path, _ = stack.enter_context(file_of(cell, "cell"))
        names = _table_files(stack, tracks, "tracks")
        columns = more.get("columns")
        if isinstance(columns, t.Mapping) and not isinstance(tracks, (str, os.PathLike)):
            more["columns"] = {k: v if v is None else _heading(v) for k, v in plain(columns).items()}
        out = os.path.join(stack.enter_context(tempfile.TemporaryDirectory()), "runs.csv")
        said = _run("passages", names, dict(more), [f"--cell={path}", f"--output={out}"])
        table = pandas.read_csv(out, comment="#")
        table.attrs.update(said)
        return table
