# SPDX-License-Identifier: MIT
"""Arguments of the Python module: what is taken, and what the refusal of anything else says. GATEWALK and ROOT as in test_gatewalk.py."""

import inspect
import os
import re
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np
import pandas

import gatewalk as gw
from gatewalk._words import in_python, options_of

ROOT = Path(os.environ["ROOT"])
FIELD = ROOT / "scenes/field.toml"
SMALL = {"field.rows": 2, "field.columns": 3}
KINDS = (gw.UsageError, gw.SceneError, gw.BadFile)

# One state that goes straight on with chance 0.6, and is trapped with 0.4: by hand, 0.36 cross two cells.
CHAIN, STATES = np.array([[6, 4]]), {"state": [0], "move_x": [0], "move_y": [1]}
TWO_CELLS = {"field.rows": 2, "field.columns": 1}

UP = """[cell]
width_m = 1.0
length_m = 1.0
faces = [{ name = "S", move = [0, 1] }, { name = "N", move = [0, -1] }]
coordinates = [{ name = "s", unit = "m", scale = 0.1 }]
[field]
columns = 1
rows = 4
max_gates = 20
[start]
face = "S"
s_m = 0.0
"""
CELL = """[cell]
width_m = 1.0
length_m = 1.0
faces = [{ name = "S", move = [0, 1] }, { name = "W", move = [1, 0] }, { name = "E", move = [-1, 0] }]
coordinates = [{ name = "s", unit = "m", scale = 0.1 }]
[field]
columns = 5
rows = 4
[start]
face = "S"
s_m = 0.0
"""


class Straight(gw.Cell):
    """Straight on or back, by one uniform number."""

    faces = [{"name": "S", "move": [0, 1]}, {"name": "N", "move": [0, -1]}]
    coordinates = [{"name": "s", "unit": "m", "scale": 0.1}]
    uniforms = 1

    def pass_(self, entries, random):
        return {"face": (random.uniforms[:, 0] < 0.5).astype(int), "s": entries["s"], "time_s": 1.0}


def tracks(steps=240):
    """Three bodies straight up through cells of 1 m, 0.6 m/s."""
    frame = np.arange(steps)
    return pandas.concat([pandas.DataFrame({"body": f"b{b}", "frame": frame, "x": 0.5 + 0.002 * b + 0.0 * frame, "y": 0.01 + 0.01 * frame})
                          for b in range(3)], ignore_index=True)


CUT = dict(fps=60, metres_per_unit=1, fastest=5.0)
NAMES = {"body": "body", "frame": "frame", "x": "x", "y": "y"}


def group(straight):
    """Recorded runs of 40 bodies through one cell, of which so many went straight on."""
    on = [body < straight for body in range(40)]
    with warnings.catch_warnings():  # nobody came back
        warnings.simplefilter("ignore")
        return gw.from_passages({"body": range(40), "trial": [1] * 40, "in": ["S"] * 40, "s": [0.0] * 40, "out": ["S" if one else "trapped" for one in on],
                                 "out_s": [0.0 if one else None for one in on], "time_s": [1.0] * 40}, UP)


def matrix():
    return gw.from_counts(CHAIN, STATES, start=0, set=TWO_CELLS)


class Wrong(unittest.TestCase):
    """Every parameter of every function with values that it does not take."""

    ALWAYS = (object(), {1, 2}, b"x", 1j, len, [object()], np.array([1j]), np.datetime64("2026-01-01"))
    BY_KIND = {"flag": ("x", 1, 0.0, [], {}), "count": ("x", float("nan"), 1.5, True, [], {}, [1, 2], np.zeros((2, 2))),
               "seed": ("x", float("nan"), -1, 2**64, True, []), "number": ("x", float("nan"), float("inf"), False, [], {}, [0.1, 0.2]),
               "text": ([], True, np.bool_(False)), "file": (5, [], {}, True, np.float32(0.5), "a\0b")}

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.before = os.getcwd()
        os.chdir(self.folder.name)

    def tearDown(self):
        os.chdir(self.before)
        self.folder.cleanup()

    def refused(self, call, parameter, value, named=True):
        with self.subTest(parameter=parameter, value=repr(value)), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with self.assertRaises(KINDS) as caught:
                call(value)
            said = str(caught.exception)
            self.assertNotRegex(said, r"(?<![\w-])--?[a-z]")
            if named:
                self.assertRegex(said, rf"\b{parameter}\b")

    def test_commands(self):
        scene, chain = gw.Scene(FIELD, SMALL), matrix()
        seen = {"crossed": 3, "trapped": 17}
        commands = {"predict": (scene,), "lattice": (scene,), "simulate": (scene,), "gate": (scene,), "sweep": (scene, {"forces.random_N": [1]}),
                    "trace": (scene,), "validate": (scene,), "analyze": (scene,), "rare": (scene,), "plan": (scene,), "design": (scene,),
                    "fit": (scene, seen), "power": (scene,), "landscape": (scene,), "walk": (chain,), "build": (scene,)}
        for name, args in commands.items():
            function = getattr(gw, name)
            parameters = inspect.signature(function).parameters
            offered = options_of("lattice" if name == "simulate" else name)
            needed = {"free": {"forces.random_N": (10, 40)}} if name == "fit" else {}

            def call(parameter, value, function=function, args=args, parameters=parameters, needed=needed):
                if parameter in list(parameters)[:len(args)]:
                    k = list(parameters).index(parameter)
                    return function(*args[:k], value, *args[k + 1:], **needed)
                return function(*args, **{**needed, parameter: value})

            keywords = {key.replace("-", "_") for key in offered} - {"quiet", "json", "checkpoint", "resume", "max_time", "shard", "part",
                                                                      "output", "help", "threads"}
            for parameter in sorted({*parameters, *keywords} - {"more"}):
                option = offered.get(parameter.replace("_", "-"))
                known = option is not None and parameter not in ("set", "versus", "vary", "over", "free", "observed")
                kind = ("file" if option.is_file else option.kind) if known else ""
                for value in (*self.ALWAYS, *self.BY_KIND.get(kind, ())):
                    self.refused(lambda value, p=parameter, call=call: call(p, value), parameter, value)
            for value in (5, None, [], np.zeros(2)):
                self.refused(lambda value, call=call, p=list(parameters)[0]: call(p, value), list(parameters)[0], value)
            self.refused(lambda value, function=function, args=args, needed=needed: function(*args, **needed, acuracy=value), "acuracy", 1)
            for gone in ("output", "json", "checkpoint", "part", "help", "quiet", "threads"):
                self.refused(lambda value, gone=gone, function=function, args=args, needed=needed: function(*args, **{**needed, gone: value}), gone, "x")

    def test_dicts(self):
        scene, seen = gw.Scene(FIELD, SMALL), {"crossed": 3, "trapped": 17}
        for value in (5, 1.5, np.float64(2), [], [5], {1: 2}, {"": 2}, {"forces.random_N": None}, {"forces.random_N": object()},
                      {"forces.random_N": {1}}, {"forces.nonsense": 1}):
            for name, call in (("set", lambda v: gw.gate(scene, set=v)), ("versus", lambda v: gw.power(scene, versus=v)),
                               ("vary", lambda v: gw.sweep(scene, v)), ("over", lambda v: gw.analyze(scene, over=v)),
                               ("free", lambda v: gw.fit(scene, seen, free=v))):
                self.refused(call, name, value)
        for value in (5, "x", [1], object()):
            self.refused(lambda v: gw.Scene(FIELD, v), "set", value)
            self.refused(scene.with_set, "set", value)
        for value in (3, (1, 2, 3), (1,), ("a", "b"), (None, 1), (4, 2), (1, float("nan")), "4:2", "x"):
            with self.assertRaisesRegex(gw.UsageError, "^free: 'forces.random_N': .*must be as in .*, the low one first$"):
                gw.fit(scene, seen, free={"forces.random_N": value})
        for value in (5, [], [5], {"x": None}, {1: 2}, object()):
            self.refused(lambda v: gw.passages(tracks(9), CELL, **CUT, columns=v), "columns", value)

    def test_tables(self):
        scene, free = gw.Scene(FIELD, SMALL), {"forces.random_N": (10, 40)}
        for value in (5, None, object(), {1}, 1j, b"x", np.zeros(3), pandas.Series([1.0, 2.0]).to_numpy(), len, [], [5]):
            if value is not None:
                self.refused(lambda v: gw.validate(scene, observed=v), "observed", value)
            self.refused(lambda v: gw.fit(scene, v, free=free), "observed", value)
            self.refused(lambda v: gw.passages(v, CELL, **CUT, columns=NAMES), "tracks", value)
            self.refused(lambda v: gw.from_passages(v, CELL), "table", value)
            self.refused(lambda v: gw.from_counts(CHAIN, v), "states", value)
        for value in ({"a": 1}, {"a": [1, 2], "b": [1]}, {"a": [1], "b": 2}, {"a": "x"}):
            self.refused(lambda v: gw.passages(v, CELL, **CUT, columns=NAMES), "tracks", value)
            self.refused(lambda v: gw.from_passages(v, CELL), "table", value)
            self.refused(lambda v: gw.from_counts(CHAIN, v), "states", value)
        frame = tracks(9)
        for value, said in ((frame.to_dict("records"), r"pandas.DataFrame\(lines\)"), ({"a": frame, "b": frame}, "a list of tables"),
                            ({"a": frame.to_dict("list")}, "a list of tables"), ([frame, tracks(9), frame], "^tracks: the table 2 is the table 0 again")):
            with self.assertRaisesRegex(gw.UsageError, said):
                gw.passages(value, CELL, **CUT, columns=NAMES)
        for value, said in ((frame.to_dict("records"), r"pandas.DataFrame\(lines\)"), ({"a": frame}, "must be one table$")):
            for call in (lambda v: gw.from_passages(v, CELL), lambda v: gw.from_counts(CHAIN, v)):
                with self.assertRaisesRegex(gw.UsageError, said):
                    call(value)
        seen = pandas.DataFrame({"ending": ["crossed", "trapped"], "count": [3, 17]})
        for value, said in (([seen, seen], "^observed: the table 1 is the table 0 again"), (seen.to_dict("records"), r"pandas.DataFrame\(lines\)"),
                            ({"a": seen}, "^observed: is a dict of tables; must be a list of tables")):
            for call in (lambda v: gw.validate(scene, observed=v), lambda v: gw.fit(scene, v, free=free)):
                with self.assertRaisesRegex(gw.UsageError, said):
                    call(value)
        five_levels = pandas.DataFrame([[1, 2]], columns=pandas.MultiIndex.from_tuples([tuple("abcdx"), tuple("abcdy")]))
        self.refused(lambda v: gw.passages(v, CELL, **CUT), "tracks", five_levels)
        for value in (5, None, object(), [], {1}):
            self.refused(lambda v: gw.passages(tracks(9), v, **CUT, columns=NAMES), "cell", value)
            self.refused(lambda v: gw.from_passages({"body": [1]}, v), "cell", value)
        for value in (5, None, object(), {1}, {"a": 1}, 1j, np.zeros(3), [5], [object()], [[0, "x"]]):
            self.refused(lambda v: gw.from_counts(v, STATES), "chain", value)
        for value in (object(), {}, [], True, 7, "nobody", 1.5):
            self.refused(lambda v: gw.from_counts(CHAIN, STATES, start=v), "start", value)

    def test_files_that_are_not_there(self):
        chain, scene, seen = matrix(), gw.Scene(FIELD, SMALL), {"free": {"forces.random_N": (10, 40)}}
        for name in ("predict", "lattice", "validate", "analyze", "rare", "plan", "design", "power", "build"):
            self.refused(getattr(gw, name), "subject", "nonsense.toml")
        for name in ("gate", "trace", "landscape"):
            self.refused(getattr(gw, name), "scene", Path("nonsense.toml"))
        for call, parameter in ((gw.load, "path"), (gw.walk, "matrix"), (gw.Scene, "source"), (lambda v: gw.merge([v]), "parts"),
                                (lambda v: chain.predict(scene=v), "scene"), (lambda v: gw.from_passages(v, CELL), "table"),
                                (lambda v: gw.from_passages({"body": [1]}, v), "cell"), (lambda v: gw.passages(v, CELL), "tracks"),
                                (lambda v: gw.from_counts(v, STATES), "chain"), (lambda v: gw.from_counts(CHAIN, v), "states"),
                                (lambda v: gw.fit(scene, v, **seen), "observed"), (lambda v: gw.validate(scene, observed=[v]), "observed")):
            for value in ("nonsense", Path("nonsense") / "file.csv", ""):
                self.refused(call, parameter, value)
        with self.assertRaisesRegex(gw.SceneError, "a text has several lines"):
            gw.Scene("[forces]")
        with self.assertRaises(gw.BadFile):
            gw.load("nonsense.nc")

    def test_others(self):
        chain, p, sweep, trace = matrix(), matrix().predict(), gw.sweep(FIELD, {"forces.random_N": [1]}, trials=1), gw.trace(FIELD)
        for value in (5, None, object(), [], {}, b"\xff\0", {1}):
            self.refused(gw.load, "path", value)
            self.refused(chain.save, "path", value)
            self.refused(chain.export, "path", value)
        self.refused(chain.export, "path", "x.txt")
        for value in (5, object(), [], {}, "nobody", None):
            self.refused(chain.counts, "type", value)
            self.refused(chain.probabilities, "type", value)
        for value in (5, object(), [], "x"):
            for plotted in (chain, p, trace):
                self.refused(lambda v, plotted=plotted: plotted.plot(axes=v), "axes", value)
        for value in (5, -1, None, "x", 0.0, True, object()):
            self.refused(trace.to_frame, "run", value)
        for value in ("x", -1, 1.5, None, 2**40, True, object(), []):
            self.refused(gw.threads, "threads", value)
        for value in (5, object(), [], b"x"):
            self.refused(gw.options, "command", value)
            self.refused(gw.sample, "name", value)
        self.refused(gw.options, "command", "nonsense")
        self.refused(gw.sample, "sample", "nonsense")
        for value in (5, None, [], "parts", {}, [5], [None]):
            self.refused(gw.merge, "parts", value)
        for value in (5, None, object(), [], np.zeros(2)):
            self.refused(gw.Scene, "source", value)
        for value in ({"body": {"mass_kg": None}}, {"body": {"mass_kg": object()}}, {"body": {"mass_kg": {1}}}):
            self.refused(gw.Scene, "body.mass_kg", value)
        for name in ("start", "scene", "accuracy", "solver"):
            self.refused(lambda v, name=name: chain.predict(**{name: v}), name, object())
        for key in ("nonsense", 5, None, ["x"]):  # where Python expects a KeyError
            for keyed in (gw.Scene(FIELD), p, sweep):
                with self.assertRaises(gw.UsageError) as caught:
                    keyed[key]
                self.assertIsInstance(caught.exception, KeyError)
        self.assertNotIn("nonsense", p)
        self.assertIn("field.rows", gw.Scene(FIELD))
        self.assertNotIn("nonsense", gw.Scene(FIELD))
        with self.assertRaisesRegex(OSError, "'/nonsense/m.nc'"):
            chain.save("/nonsense/m.nc")

    def test_cells(self):
        for name, values in (("faces", (5, "S", {}, [5])), ("coordinates", (5, "s", [5])), ("costs", (5, "t")), ("memory", (-1, 1.5, "x", None, 61)),
                             ("normals", (-1, 1.5, "x")), ("uniforms", (True, "x")), ("parameters", (5, [1])), ("limits", (5, [1]))):
            for value in values:
                cell = Straight()
                setattr(cell, name, value)
                self.refused(gw.check_cell, name, cell) if name in ("faces", "coordinates") else None
                self.refused(lambda v: gw.lattice(UP, cell=v, trials=1), name, cell)
        cell = Straight()
        cell.parameters, cell.limits = {"a": 1.0}, {"a": 5}
        self.refused(lambda v: gw.lattice(UP, cell=v, trials=1), "limits", cell)

        class Ragged(Straight):
            def pass_(self, entries, random):
                return {**super().pass_(entries, random), "time_s": np.ones(len(random.seed) + 1)}

        self.refused(lambda v: gw.lattice(UP, cell=v, trials=5), "time_s", Ragged())

        for kind in (ValueError, RuntimeError, KeyError):
            class Own(Straight):
                def pass_(self, entries, random, kind=kind):
                    raise kind("--mine stays as it is")

            with self.assertRaisesRegex(kind, "^'?--mine stays as it is'?$") as caught:
                gw.lattice(UP, cell=Own(), trials=1)
            self.assertIs(type(caught.exception), kind)

    def test_no_option_is_named_as_on_the_command_line(self):
        """Whatever the sources say of an option."""
        said = set()
        for file in [*ROOT.glob("cli/*.cpp"), *ROOT.glob("cli/commands/*.cpp"), *ROOT.glob("cli/exchange/*.cpp"), *ROOT.glob("lattice/*/*.cpp")]:
            if file.name not in ("help.cpp", "main.cpp", "merge.cpp"):
                said |= set(re.findall(r'"((?:[^"\\\n]|\\.)*--[a-z](?:[^"\\\n]|\\.)*)"', file.read_text()))
        self.assertGreater(len(said), 150)
        for text in said:
            self.assertNotRegex(in_python(text, "predict"), r"(?<![\w-])--[a-z]", text)


class Words(unittest.TestCase):
    def test_in_pythons_words(self):
        for said, expected in (
                ("--start 1: must be 3 numbers", "start=1: must be 3 numbers"),
                ("--starts -5:5: must be all, or three ranges", "starts='-5:5': must be 'all', or three ranges"),
                ("--set forces.random_N=-3: must lie in", "set={'forces.random_N': -3}: must lie in"),
                ("--set run.method=x: no", "set={'run.method': 'x'}: no"),
                ("what x and y are in: --metres-per-unit X (1: metres)", "what x and y are in: metres_per_unit=X (1: metres)"),
                ("or --lattice COLUMNS,ROWS (all: without end)", "or lattice=(COLUMNS, ROWS) ('all': without end)"),
                ("frames go up by 5: --bridge 4 bridges them", "frames go up by 5: bridge=4 bridges them"),
                ("with --gate: .mtx; without --gate .umb", "with gate: .mtx; without gate=True .umb"),
                ("trust gatewalk lattice", "trust gatewalk.lattice"),
                ("other bins: gatewalk build --bins auto makes them", "other bins: gatewalk.build(bins='auto') makes them"),
                ("gatewalk build TABLE --cell CELL.toml -o M.nc makes one", "gatewalk.from_passages(table, cell=CELL.toml) makes one"),
                ("give --free KEY=LOW:HIGH", "give free={KEY: (LOW, HIGH)}"),
                ("see gatewalk predict --help", "see gatewalk.options('predict')"),
                ("a--b.csv and /x--y/z: cannot be read", "a--b.csv and /x--y/z: cannot be read"),
                ("--origin 0,1,2: must be two numbers with a comma between", "origin=(0, 1, 2): must be two numbers, (X, Y)"),
                ("--columns body=...,x=x* (time=... in place of frame=...; no body= for one body; give x=x*)",
                 "columns={'body': ..., 'x': 'x*'} ('time': ... in place of 'frame': ...; no 'body' for one body; give 'x': 'x*')"),
                ("no column nope (x= of --columns): give x=x*,y=y* and no body=)", "no column nope ('x' of columns=): give 'x': 'x*', 'y': 'y*' and no 'body')"),
                ("a gate IX,IY, or IX,IY,STATE", "a gate (IX, IY), or (IX, IY, STATE)"),
                ("--free a.b=x: must be KEY=LOW:HIGH", "free={'a.b': 'x'}: must be {KEY: (LOW, HIGH)}"),
                ("give --vary KEY=from:step:to, or", "give vary={KEY: [VALUE, ...]}, or"),
                ("which --gate --counts -o FILE.mtx writes", "which export('FILE.mtx', gate=True, counts=True) writes")):
            command = "export" if "gate:" in said else "passages" if any(word in said for word in ("lattice", "bridge", "columns")) else "predict"
            self.assertEqual(in_python(said, command), expected)
        # A value that was given is known, whatever it looks like.
        self.assertEqual(in_python("--start Q:0,0.5: must be seen, or 2 numbers s,v (m, m/s), behind a face S or W and a colon unless it is the first",
                                   "predict", ["--start=Q:0,0.5"]),
                         "start=('Q', 0, 0.5): must be 'seen', or 2 numbers s,v (m, m/s), with a face in front unless it is the first: ('S', s, v), of S or W")
        names = '"body=ID","frame=FRAME","x=x, m"'
        self.assertEqual(in_python(f"--columns {names}: y= is missing", "passages", [f"--columns={names}", "--confidence=0.5"]),
                         "columns={'body': 'ID', 'frame': 'FRAME', 'x': 'x, m'}: 'y' is missing")
        self.assertEqual(in_python("--only left side: no such end", "trace", ["--only=left side"]), "only='left side': no such end")

    def test_one_call_of_each_kind(self):
        chain = matrix()
        for call, said in ((lambda: gw.load(FIELD), r"gatewalk\.build makes a matrix of one"),
                           (lambda: chain.predict(start=1), "^start=1: the matrix has no state of that name or number|^start=1: must be"),
                           (lambda: gw.from_counts(CHAIN, STATES, start=9), "^start=9: the table of states has no such state$"),
                           (lambda: chain.first_passage(True), r"must be an ending, a gate \(i_x, i_y\), a state, or"),
                           (lambda: gw.predict(FIELD, start=pandas.DataFrame({"d": [0.0]})), r"of a DataFrame .to_numpy\(\)"),
                           (lambda: gw.power(gw.Scene(FIELD, SMALL), versus=chain), "^versus='the other matrix': two matrices are compared"),
                           (lambda: gw.predict(FIELD, accuracy=2), "^accuracy=2: must lie between 0 and 1"),
                           (lambda: gw.predict(FIELD, acuracy=2), r"^there is no parameter acuracy= \(did you mean accuracy=\?\)"),
                           (lambda: gw.gate(FIELD, strict="x"), "^strict: must be True or False, not 'x'$"),
                           (lambda: gw.predict(FIELD, figure="x.txt"), r"^figure='x.txt': must end in .svg"),
                           (lambda: gw.passages(tracks(9), CELL, columns=NAMES), r"fastest=M/S"),
                           (lambda: gw.passages(tracks(9), CELL, columns=NAMES, fastest=1), r"frames per second: fps=N"),
                           (lambda: gw.Scene(FIELD, {"forces.random_N": -3}), r"^set=\{'forces.random_N': -3\}: forces.random_N = -3")):
            with self.assertRaisesRegex(KINDS, said):
                call()

    def test_trajectories_count_from_0(self):
        states = {"state": [0, 1], "move_x": [0, 0], "move_y": [1, 1]}
        for wrong, step in (([0, 9, 1], 1), ([0, 1, 9], 2), ([0, -2, 1], 1), ([0, 1.5], 1)):
            with self.assertRaisesRegex(gw.UsageError, rf"^the chain: trajectory 1, step {step} \(counted from 0\): "):
                gw.from_counts([[0, 1, 1, 0], wrong], states)

    def test_warnings_too(self):
        with self.assertWarnsRegex(gw.GatewalkWarning, "^the chain has probabilities"):
            gw.from_counts(CHAIN / CHAIN.sum(), STATES)


class NoTemporaryFile(unittest.TestCase):
    """Files that only the package knows have no place in what users read."""

    def setUp(self):
        self.folder, self.before = tempfile.TemporaryDirectory(), tempfile.tempdir
        tempfile.tempdir = os.path.realpath(self.folder.name)

    def tearDown(self):
        tempfile.tempdir = self.before
        self.folder.cleanup()

    def texts(self, value):
        if isinstance(value, (dict, gw.Result)):
            return [text for one in value.values() for text in self.texts(one)]
        if isinstance(value, (list, tuple)):
            return [text for one in value for text in self.texts(one)]
        return [value] if isinstance(value, str) else []

    def test_in_results(self):
        scene, seen = {"field": {"rows": 2, "columns": 3}}, pandas.DataFrame({"ending": ["crossed", "trapped"], "count": [3, 17]})
        cut, chain, recorded = gw.passages([tracks(), tracks()], CELL + "# a text\n", **CUT, columns=NAMES), matrix(), group(20)
        trees, other = gw.build(scene, accuracy=0.4, bins="tree"), os.path.join(self.folder.name, "saved.nc")
        recorded.save(other)
        results = {"passages": cut.attrs, "from_passages": recorded.made_by, "load": gw.load(other).made_by, "from_counts": chain.made_by,
                   "build": trees.made_by, "predict": recorded.predict(), "of a dict": gw.predict(scene, accuracy=0.4),
                   "power": gw.power(recorded, versus=group(30), trials=20), "walk": gw.walk(chain), "analyze": chain.analyze(),
                   "validate": gw.validate(scene, observed=[seen, seen.copy()], accuracy=0.4, trials=100, null_draws=99)}
        for name, result in results.items():
            said = [text for text in self.texts(result) if tempfile.tempdir in text.replace(other, "")]
            self.assertEqual(said, [], name)
        self.assertEqual(cut.attrs["tracks"]["file"], "the table 0, the table 1")
        self.assertRegex(cut.attrs["made_by"]["command"], "^gatewalk passages table0.csv table1.csv .* --cell cell.toml$")
        self.assertRegex(recorded.made_by["command"], "^gatewalk build table.csv --cell cell.toml$")
        self.assertRegex(chain.made_by["command"], "^gatewalk import chain.npz .* --states states.csv$")
        self.assertRegex(" ".join(results["power"].summary), r"To tell this group from the other matrix \(power 80 %\) you need ")
        self.assertEqual(results["validate"].observed["files"], ["the table 0", "the table 1"])

    def test_in_errors(self):
        for cell in ({"cell": {"width_m": 1.0}}, "[cell]\nwidth_m = 1.0\n"):
            for call in (lambda v: gw.passages(tracks(9), v, **CUT, columns=NAMES), lambda v: gw.from_passages({"body": [1]}, v)):
                with self.assertRaisesRegex(gw.SceneError, r"^the cell:\d"):
                    call(cell)


class Taken(unittest.TestCase):
    """What users of numpy and pandas give."""

    def test_numpy_and_pathlib(self):
        plain = gw.lattice(FIELD, trials=20, seed=3, strict=False, set=SMALL)
        keys = {"field.rows": np.int32(2), "field.columns": np.int64(3)}
        for trials in (np.int64(20), np.uint8(20), np.float32(20), np.array(20), 2e1):
            for strict in (np.bool_(False), np.array(False), False):
                self.assertEqual(gw.lattice(str(FIELD), trials=trials, seed=np.uint64(3), strict=strict, set=keys), plain)
        self.assertEqual(gw.simulate(FIELD, trials=20, seed=3, set=SMALL), plain)
        self.assertEqual(gw.gate(FIELD, trials=5, strict=np.bool_(True)).trials, 5)
        self.assertEqual(gw.Scene({"forces": {"random_N": np.float64(3.5)}, "field": {"rows": np.int64(4)}}),
                         gw.Scene({"forces": {"random_N": 3.5}, "field": {"rows": 4}}))
        self.assertEqual(gw.Scene(gw.Scene(FIELD, SMALL), {"field.rows": 4}), gw.Scene(FIELD, {**SMALL, "field.rows": 4}))
        gw.threads(np.int64(0))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "m.nc"
            matrix().save(path)
            loaded = gw.load(path)
            self.assertEqual(loaded.export(Path(folder) / "x.umb").states, matrix().export(Path(folder) / "y.umb").states)
            gw.predict(FIELD, accuracy=np.float32(0.5), page=Path(folder) / "p.html", csv=Path(folder) / "p.csv", set=SMALL)
            self.assertTrue((Path(folder) / "p.html").exists() and (Path(folder) / "p.csv").exists())

    def test_pairs(self):
        expected = gw.predict(FIELD, accuracy=0.3, start=(1.0, 0.0, 15.0), set=SMALL)
        for start in ([1, 0, 15], np.array([1, 0, 15]), [np.float32(1), 0, 15.0], ([1, 0, 15],), np.array([[1.0, 0.0, 15.0]]), "1,0,15",
                      pandas.Series([1, 0, 15])):
            self.assertEqual(gw.predict(FIELD, accuracy=0.3, start=start, set=SMALL), expected)
        wide = dict(bins="tree", accuracy=0.4, set=SMALL)
        self.assertEqual(gw.build(FIELD, starts=[(-5, 5), (-10, 10), (10, 20)], **wide), gw.build(FIELD, starts="-5:5,-10:10,10:20", **wide))
        frame = tracks()
        cut = gw.passages(frame, CELL, **CUT, columns=NAMES, lattice="1,2", origin="0,0")
        self.assertEqual(len(cut), 3)
        for pair in ([1, 2], (1, 2), np.array([1, 2])):
            pandas.testing.assert_frame_equal(gw.passages(frame, CELL, **CUT, columns=NAMES, lattice=pair, origin=[0, 0]), cut)
        two = gw.from_counts(np.array([[6, 0, 4], [0, 3, 7]]), {"state": [0, 1], "move_x": [0, 0], "move_y": [1, 1]}, set=TWO_CELLS)
        for starts in ([0, 1], np.array([0, 1]), (np.int64(0), "1"), ["0", 1]):  # by hand 0.6^2 and 0.3^2 cross
            np.testing.assert_allclose([p.endings["crossed"] for p in two.predict(start=starts).starts], [0.36, 0.09], rtol=1e-12)
        recorded = group(20)  # by hand 0.5^4 cross
        for start in (("S", 0.0), ["S", np.float32(0)], [("S", 0.0)], [("S", 0.0), (0.0,), "S:0"], np.array([("S", 0.0)]), pandas.DataFrame({"in": ["S"], "s": [0.0]}).to_numpy()):
            for p in recorded.predict(start=start).starts:
                self.assertAlmostEqual(p.endings["crossed"], 0.0625, 12)
        outcome = gw.sweep(FIELD, {"forces.random_N": np.array([10, 20])}, trials=5, set=SMALL)
        self.assertEqual(outcome, gw.sweep(FIELD, {"forces.random_N": "10,20"}, trials=5, set=SMALL))

    def test_tables(self):
        frame = tracks()
        cut = gw.passages(frame, CELL, **CUT, columns=NAMES)
        self.assertEqual((len(cut), set(cut["in"])), (6, {"S"}))  # rows of 1 m up to y = 2.4 m
        columns = frame.to_dict("list")
        # Integers, and what CSV must quote.
        odd = {"body": 0, "frame": 'a "frame"', "x": "x, m", "y": " y;\n(m)"}
        renamed = frame.rename(columns=odd)
        for table, names in ((frame.set_index("frame"), NAMES), (frame.set_index(["body", "frame"]), NAMES), (columns, NAMES),
                             ({k: np.array(v) for k, v in columns.items()}, NAMES), ({k: frame[k] for k in frame}, NAMES),
                             (frame.to_records(index=False), NAMES), (renamed, odd), (renamed.to_dict("list"), odd)):
            pandas.testing.assert_frame_equal(gw.passages(table, CELL, **CUT, columns=names), cut)
        of_dict, of_frame = gw.from_passages(cut.to_dict("list"), CELL), gw.from_passages(cut, CELL)
        self.assertEqual((of_dict.counts() != of_frame.counts()).nnz, 0)
        for states in (STATES, pandas.DataFrame(STATES), pandas.DataFrame(STATES).set_index("state"), {k: np.array(v) for k, v in STATES.items()}):
            self.assertAlmostEqual(gw.from_counts(CHAIN, states, start=np.int64(0), set=TWO_CELLS).predict().endings["crossed"], 0.36, 12)
        counts = {"crossed": 3, "left_side": 0, "right_side": 0, "trapped": 17, "cut_off": 0}
        how = dict(accuracy=0.3, trials=100, null_draws=99, set=SMALL)
        expected = gw.validate(FIELD, observed=counts, **how)["observed"]["trials"]
        self.assertEqual(expected, 20)
        table = {"ending": list(counts), "count": np.array(list(counts.values()))}
        for observed in (table, pandas.DataFrame(table), pandas.DataFrame(table).set_index("ending"), pandas.Series(counts),
                         {k: np.int64(v) for k, v in counts.items()}):
            self.assertEqual(gw.validate(FIELD, observed=observed, **how)["observed"]["trials"], expected)

    def test_two_groups(self):
        one, other = group(20), group(36)
        of_matrix = gw.power(one, versus=other, trials=20)
        self.assertAlmostEqual(of_matrix.versus["endings"]["crossed"], 0.9**4, 12)
        with tempfile.TemporaryDirectory() as folder:
            other.save(Path(folder) / "other.nc")
            of_file = gw.power(one, versus=Path(folder) / "other.nc", trials=20)
        self.assertEqual(of_file.versus["apart"], of_matrix.versus["apart"])

    def test_what_is_missing_in_a_dict_is_missing(self):
        frame = tracks()
        frame.loc[5:8, "x"] = np.nan
        holes = frame.to_dict("list")
        pandas.testing.assert_frame_equal(gw.passages(holes, CELL, **CUT, bridge=6, columns=NAMES), gw.passages(frame, CELL, **CUT, bridge=6, columns=NAMES))
        for missing in (None, pandas.NA, pandas.NaT):
            holes["x"] = [missing if pandas.isna(x) else x for x in holes["x"]]
            pandas.testing.assert_frame_equal(gw.passages(holes, CELL, **CUT, bridge=6, columns=NAMES), gw.passages(frame, CELL, **CUT, bridge=6, columns=NAMES))
        nullable = frame.convert_dtypes()
        pandas.testing.assert_frame_equal(gw.passages({name: nullable[name] for name in nullable}, CELL, **CUT, bridge=6, columns=NAMES),
                                          gw.passages(frame, CELL, **CUT, bridge=6, columns=NAMES))

    def test_deeplabcut(self):
        y = 0.01 + 0.01 * np.arange(240)
        lines = ["scorer,net,net,net", "bodyparts,nose,nose,nose", "coords,x,y,likelihood"] + [f"{k},0.5,{v!r},1.0" for k, v in enumerate(map(float, y))]
        how = dict(**CUT, confidence=0.5, key_point="nose")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "dlc.csv"
            path.write_text("\n".join(lines) + "\n")

            def passages(table):
                return gw.passages(table, CELL, **how).drop(columns="body")  # which is named by the file

            cut = passages(path)
            self.assertEqual(len(cut), 2)
            for read in (dict(header=[0, 1, 2]), dict(header=[0, 1, 2], index_col=0)):
                pandas.testing.assert_frame_equal(passages(pandas.read_csv(path, **read)), cut)
            poses = pandas.read_csv(path, header=[0, 1, 2], index_col=0)
            pandas.testing.assert_frame_equal(passages(poses.droplevel("scorer", axis=1)), cut)
            several = pandas.concat({"mouse": poses.droplevel("scorer", axis=1)}, axis=1, names=["individuals"])
            for table in (several, pandas.concat({"net": several}, axis=1, names=["scorer"])):
                pandas.testing.assert_frame_equal(passages(table), cut)
            nameless = pandas.read_csv(path, header=[0, 1, 2], index_col=0)
            nameless.columns.names, nameless.index.name = [None] * 3, "frame"
            pandas.testing.assert_frame_equal(passages(nameless), cut)

    def test_threads_print_nothing(self):
        """HDF5 has its switch for printing in every thread, and NetCDF asks it for much that is not there."""
        code = ("import sys, gatewalk as gw\nfrom multiprocessing.pool import ThreadPool\n"
                "def call(path):\n    try:\n        return str(gw.load(path).predict().endings)\n    except ValueError as error:\n        return str(error)\n"
                "with ThreadPool(6) as pool:\n    print(len(pool.map(call, sys.argv[1:])))\n")
        with tempfile.TemporaryDirectory() as folder:
            good, cut, none = (Path(folder) / name for name in ("good.nc", "cut.nc", "none.nc"))
            matrix().save(good)
            cut.write_bytes(good.read_bytes()[:-100])
            done = subprocess.run([sys.executable, "-c", code, *map(str, [good, cut, none, good, FIELD, good])], capture_output=True, text=True, check=True)
            self.assertEqual((done.stdout, done.stderr), ("6\n", ""))


if __name__ == "__main__":
    unittest.main()
