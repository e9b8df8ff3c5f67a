# SPDX-License-Identifier: MIT
"""The Python module against the program: GATEWALK and ROOT say where the program and the checkout are."""

import atexit
import copy
import doctest
import json
import locale
import math
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import tarfile
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path

import numpy as np
import pandas
import scipy.io
import scipy.sparse

import gatewalk as gw

PROGRAM, ROOT = os.environ["GATEWALK"], Path(os.environ["ROOT"])
FIELD, SINGLE = ROOT / "scenes/field.toml", ROOT / "scenes/single_gate.toml"
TIMES = {"made_by", "seconds", "run_seconds", "chain_seconds", "direct_seconds", "speed_ratio"}


def program(*words):
    """What the program says as JSON."""
    done = subprocess.run([PROGRAM, *map(str, words), "--json", "-", "--quiet"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def plain(value):
    """As JSON has it, without times."""
    if isinstance(value, (gw.Result, dict)):
        return {k: plain(v) for k, v in value.items() if k not in TIMES}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(v) for v in (value.tolist() if isinstance(value, np.ndarray) else value)]
    return None if isinstance(value, float) and not math.isfinite(value) else value


class Pillars(gw.Cell):
    """Square cells with a slow patch; leaves straight on, or to a side, by one uniform number."""

    faces = [{"name": "S", "move": [0, 1], "odd": ["s"]}, {"name": "W", "move": [1, 0], "mirror": "E"},
             {"name": "E", "move": [-1, 0], "mirror": "W"}]
    coordinates = [{"name": "s", "unit": "m", "scale": 0.1}]
    symmetric = True
    uniforms = 2
    memory = 1
    parameters = {"side": 0.2, "stay": 0.05}

    def pass_(self, entries, random):
        u = random.uniforms
        out = np.where(u[:, 0] < self.parameters["side"] * (1 + 0.5 * entries["s"]), 1,
                       np.where(u[:, 0] < 2 * self.parameters["side"], 2, 0))
        out = np.where(u[:, 1] < self.parameters["stay"], gw.TRAPPED, out)
        return {"face": out, "s": 0.5 * entries["s"] + 0.2 * (u[:, 1] - 0.5), "time_s": 1.0 + u[:, 0],
                "memory": entries["memory"] + 1.0}


CELLS = """[cell]
width_m = 1.0
length_m = 1.0
symmetric = true
[[cell.faces]]
name = "S"
move = [0, 1]
odd = ["s"]
[[cell.faces]]
name = "W"
move = [1, 0]
mirror = "E"
odd = []
[[cell.faces]]
name = "E"
move = [-1, 0]
mirror = "W"
odd = []
[[cell.coordinates]]
name = "s"
unit = "m"
scale = 0.1
[field]
columns = 5
rows = 4
max_gates = 20
[start]
face = "S"
s_m = 0.05
"""


class SameAsTheProgram(unittest.TestCase):
    def check(self, result, *words):
        self.assertEqual(plain(result), plain(program(*words)))

    def test_a_page_is_the_programs(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, options in (("predict", {}), ("analyze", {"runs": 0})):
                ours, theirs = Path(folder, "ours.html"), Path(folder, "theirs.html")
                getattr(gw, name)(FIELD, accuracy=0.2, set={"field.rows": 3}, page=str(ours), force=True, **options)
                words = [word for key, value in options.items() for word in (f"--{key}", value)]
                program(name, FIELD, "--accuracy", 0.2, "--set", "field.rows=3", *words, "--page", theirs, "--force")
                data = [re.search(r'id="data">(.*)</script>', page.read_text()).group(1) for page in (ours, theirs)]
                self.assertEqual(*data)

    def test_all_commands(self):
        key = {"forces.random_N": 40.0}
        of = ["--set", "forces.random_N=40.0", "--seed", 7]
        self.check(gw.predict(FIELD, accuracy=0.1, seed=7, set=key), "predict", FIELD, "--accuracy", 0.1, *of)
        self.check(gw.predict(FIELD, accuracy=0.1, start=[(0.0, 0.0, 15.0), (-4.0, 5.0, 10.0)]), "predict", FIELD, "--accuracy", 0.1,
                   "--start=0,0,15", "--start=-4,5,10")
        self.check(gw.lattice(gw.Scene(FIELD, key), trials=300, seed=7), "lattice", FIELD, "--trials", 300, *of)
        self.check(gw.gate(FIELD, trials=300, seed=7, set=key), "gate", FIELD, "--trials", 300, *of)
        self.check(gw.sweep(SINGLE, {"forces.propulsion_N": [5, 6.5]}, trials=50), "sweep", SINGLE, "--trials", 50,
                   "--vary", "forces.propulsion_N=5,6.5")
        self.check(gw.trace(FIELD, trials=2, field=True), "trace", FIELD, "--trials", 2, "--field")
        self.check(gw.validate(FIELD, accuracy=0.2, trials=100, null_draws=99), "validate", FIELD, "--accuracy", 0.2, "--trials", 100,
                   "--null-draws", 99)
        self.check(gw.analyze(FIELD, accuracy=0.2, runs=200), "analyze", FIELD, "--accuracy", 0.2, "--runs", 200)
        self.check(gw.rare(FIELD, row=3, accuracy=0.3), "rare", FIELD, "--row", 3, "--accuracy", 0.3)
        self.check(gw.power(FIELD, trials=50, accuracy=0.2), "power", FIELD, "--trials", 50, "--accuracy", 0.2)
        self.check(gw.analyze(FIELD, accuracy=0.2, runs=0, over={"forces.propulsion_N": (6, 8), "forces.random_N": (30, 60)}, over_trials=4096),
                   "analyze", FIELD, "--accuracy", 0.2, "--runs", 0, "--over", "forces.propulsion_N=6:8", "--over", "forces.random_N=30:60",
                   "--over-trials", 4096)

    def test_fit(self):
        few, free = {"field.rows": 3, "run.method": "moreau"}, {"forces.propulsion_N": (5, 9)}
        seen = gw.fit(FIELD, {"crossed": 20, "trapped": 60, "left side": 2}, free=free, trials=12288, set=few)
        low, high = seen["numbers"][0]["median_95"]
        self.assertTrue(5 < low < high < 9)
        days = gw.fit(FIELD, [{"crossed": 12, "trapped": 60}, {"crossed": 8, "left side": 2}], free=free, trials=12288, set=few)
        self.assertEqual(days["numbers"], seen["numbers"])
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "counts.csv"
            table.write_text("ending,count\ncrossed,20\ntrapped,60\nleft side,2\n")
            self.check(seen, "fit", FIELD, table, "--free", "forces.propulsion_N=5:9", "--trials", 12288, "--set", "field.rows=3", "--set",
                       "run.method=moreau")
            runs = Path(folder) / "runs.csv"
            subprocess.run([PROGRAM, "lattice", FIELD, "--set", "field.rows=3", "--set", "run.method=moreau", "--trials", "20", "--passages", runs,
                            "--cell-file", Path(folder) / "cell.toml", "--quiet"], check=True, stdout=subprocess.DEVNULL)
            of_passages = gw.fit(FIELD, runs, free=free, trials=12288, set=few)
            self.assertEqual(of_passages["of"], "passages")
            self.check(of_passages, "fit", FIELD, runs, "--free", "forces.propulsion_N=5:9", "--trials", 12288, "--set", "field.rows=3", "--set",
                       "run.method=moreau")
        with self.assertRaises(gw.SceneError):
            gw.fit(FIELD, {"crossed": 20, "trapped": 60}, free={"forces.push": (5, 9)})

    def test_landscape(self):
        with tempfile.TemporaryDirectory() as folder:
            seen = gw.landscape(SINGLE, beam="left", trials=20)
            said = program("landscape", SINGLE, "--beam", "left", "--trials", 20, "-o", folder)
            self.assertEqual(plain({k: v for k, v in seen.items() if k != "table"}), plain(said))
            lines = (Path(folder) / "landscape.csv").read_text().splitlines()
            self.assertEqual(list(seen.to_frame().columns), lines[0].split(","))
            self.assertEqual(len(seen.to_frame()), len(lines) - 1)

    def test_merge(self):
        with tempfile.TemporaryDirectory() as folder:
            def parts(*words):
                names = [Path(folder) / f"{words[0]}{i}" for i in (1, 2)]
                for i, name in enumerate(names, 1):
                    subprocess.run([PROGRAM, *words, "--shard", f"{i}/2", "--part", name, "--quiet"], check=True, capture_output=True)
                return names
            self.assertEqual(gw.merge(parts("lattice", FIELD, "--trials", "100")), gw.lattice(FIELD, trials=100))
            built = gw.merge(parts("build", FIELD, "--bins", "paper", "--trials", "20", "-o", Path(folder) / "m.nc"))
            self.assertEqual((built.counts() != gw.build(FIELD, bins="paper", trials=20).counts()).nnz, 0)
            with self.assertRaisesRegex(gw.UsageError, "missing|lacks|other part"):
                gw.merge([Path(folder) / "lattice1"])
            with self.assertRaisesRegex(gw.UsageError, "takes a list"):
                gw.merge("x")

    def test_observed(self):
        import pandas

        counts = {"crossed": 0, "left_side": 5, "right_side": 2, "trapped": 48, "cut_off": 5}
        how = dict(accuracy=0.2, trials=1200, null_draws=99)
        of_file = gw.validate(FIELD, observed=ROOT / "scenes/observed.csv", **how)["observed"]
        self.assertEqual(of_file["trials"], 60)
        for table in (counts, pandas.DataFrame({"ending": counts.keys(), "count": counts.values()})):
            of_table = gw.validate(FIELD, observed=table, **how)["observed"]
            self.assertEqual(of_table["files"], ["the table"])
            self.assertEqual(plain({**of_table, "files": 0}), plain({**of_file, "files": 0}))
        for wrong, text in (({"crosed": 1}, '^the table:2: column ending: "crosed" is not permitted'), ({"crossed": 1.5}, "^the table: the count of crossed must be a whole number, it is 1.5")):
            with self.assertRaisesRegex(ValueError, text):
                gw.validate(FIELD, observed=wrong, **how)

    def test_matrices(self):
        with tempfile.TemporaryDirectory() as folder:
            theirs = Path(folder) / "theirs.nc"
            words = ["--bins", "paper", "--trials", "20"]
            subprocess.run([PROGRAM, "build", FIELD, *words, "-o", theirs, "--quiet"], check=True, stdout=subprocess.DEVNULL)
            ours = gw.build(FIELD, bins="paper", trials=20)
            other = gw.load(theirs)
            self.assertEqual((ours.counts() != other.counts()).nnz, 0)
            self.assertEqual(plain(ours.walk(walks=50)), plain(program("walk", theirs, "--walks", 50)))
            self.check(ours.predict(start=(0.0, 0.0, 15.0)), "predict", theirs, "--start=0,0,15")
            matrix = ours.matrix
            np.testing.assert_allclose(np.asarray(matrix.sum(axis=1)).ravel(), 1.0, rtol=1e-12)
            self.assertTrue(np.shares_memory(matrix.data, ours.matrix.data))  # no copy
            with self.assertRaises(ValueError):
                matrix.data[0] = 2.0
            self.assertEqual(len(ours.states), 87)
            self.assertEqual(ours.moves["EN"], (0, 1))
            saved = Path(folder) / "saved.nc"
            ours.save(saved)
            self.assertEqual(gw.load(saved), ours)
            for twin in (pickle.loads(pickle.dumps(ours)), copy.copy(ours), copy.deepcopy(ours)):
                self.assertEqual(twin, ours)
            kept = gw.load(saved)
            old = kept.predict(start=(0.0, 0.0, 15.0))
            self.assertEqual(old, ours.predict(start=(0.0, 0.0, 15.0)))  # nothing that was left in memory has changed
            other_seed = gw.build(FIELD, bins="paper", trials=20, seed=2)
            self.assertNotEqual(other_seed.predict(start=(0.0, 0.0, 15.0)), old)
            other_seed.save(saved)
            for asked in (kept.predict, kept.walk, lambda: kept.save(Path(folder) / "x.nc"), lambda: pickle.dumps(kept),
                          lambda: kept == ours, lambda: gw.validate(FIELD, matrix=kept)):
                with self.assertRaisesRegex(gw.BadFile, "saved.nc: was changed or removed since it was loaded"):
                    asked()
            self.assertEqual(gw.load(saved).predict(start=(0.0, 0.0, 15.0)), other_seed.predict(start=(0.0, 0.0, 15.0)))
            saved.write_bytes(saved.read_bytes()[:-100])
            with self.assertRaisesRegex(gw.BadFile, "saved.nc"):
                gw.load(saved)


def read_umb(path):
    """By the format's specification: (matrix, initial state, states by label)."""
    from scipy.sparse import csr_matrix

    with tarfile.open(path) as tar:
        names = tar.getnames()
        assert names[0] == "index.json", names
        def numbers(name, kind):
            return np.frombuffer(tar.extractfile(name).read(), kind)
        index = json.load(tar.extractfile("index.json"))
        n = index["transition-system"]["#states"]
        def bits(name):
            return np.flatnonzero(np.unpackbits(numbers(name, "u1"), bitorder="little")[:n])
        first = numbers("choice-to-branches.bin", "<u8").astype(np.int64)
        target, p = numbers("branch-to-target.bin", "<u8").astype(np.int64), numbers("branch-to-probability.bin", "<f8")
        assert len(first) == n + 1 and first[-1] == len(target) == len(p) == index["transition-system"]["#branches"]
        labels = {label: bits(f"annotations/aps/{label}/states/values.bin")[0] for label in index["annotations"]["aps"]}
        return csr_matrix((p, target, first), shape=(n, n)), bits("state-is-initial.bin")[0], labels


def read_drn(path):
    from scipy.sparse import csr_matrix

    lines = path.read_text().splitlines()
    n = int(lines[lines.index("@nr_states") + 1])
    rows, columns, values, labels, initial = [], [], [], {}, None
    for line in lines[lines.index("@model") + 1:]:
        words = line.split()
        if words[0] == "state":
            state = int(words[1])
            for word in words[2:]:
                if word == "init":
                    initial = state
                else:
                    labels[word] = state
        elif words[0] != "action":
            assert line.startswith("\t\t") and words[1] == ":", line
            rows.append(state), columns.append(int(words[0])), values.append(float(words[2]))
    return csr_matrix((values, (rows, columns)), shape=(n, n)), initial, labels


def read_prism(path):
    from scipy.sparse import csr_matrix

    n, m = map(int, path.read_text().splitlines()[0].split())
    table = np.loadtxt(path, skiprows=1)
    assert len(table) == m
    names, *rows = path.with_suffix(".lab").read_text().splitlines()
    label = {int(k): v.strip('"') for k, v in (word.split("=") for word in names.split())}
    where = {label[int(number)]: int(state) for state, numbers in (row.split(":") for row in rows) for number in numbers.split()}
    assert len(path.with_suffix(".sta").read_text().splitlines()) == n + 1
    initial = where.pop("init")
    return csr_matrix((table[:, 2], (table[:, 0].astype(int), table[:, 1].astype(int))), shape=(n, n)), initial, where


class Elsewhere(unittest.TestCase):
    def test_chains_for_model_checkers(self):
        with tempfile.TemporaryDirectory() as folder:
            for made in (dict(bins="paper", trials=30), dict(accuracy=0.1)):
                matrix = gw.build(FIELD, **made)
                for limit in (0, 13):
                    more = dict(first_runs=0) if "accuracy" in made else {}
                    key = {"field.max_gates": limit}
                    exact = matrix.predict(set=key, **more).starts[0].endings
                    for ending, read in ((".umb", read_umb), (".drn", read_drn), (".tra", read_prism)):
                        path = Path(folder) / f"field{ending}"
                        said = matrix.export(path, set=key, force=True)
                        chain, initial, labels = read(path)
                        self.assertEqual((chain.shape[0], initial, labels), (said.states, 0, dict(said.endings)))
                        np.testing.assert_allclose(np.asarray(chain.sum(axis=1)).ravel(), 1.0, rtol=1e-12)
                        share = np.zeros(chain.shape[0])
                        share[initial] = 1.0
                        for _ in range(600):
                            share = chain.T @ share
                        for name, p in exact.items():
                            self.assertAlmostEqual(share[labels[name]], p, 11, (made, limit, ending, name))
            with self.assertRaisesRegex(gw.UsageError, "must end in .umb, .drn, .tra"):
                matrix.export(Path(folder) / "x.txt")
            matrix.save(Path(folder) / "x.sta")
            with self.assertRaisesRegex(gw.UsageError, "x.sta, .* is an input"):
                gw.load(Path(folder) / "x.sta").export(Path(folder) / "x.tra")

    def test_first_passages_solve_the_exported_chain(self):
        matrix = gw.build(FIELD, bins="paper", trials=30, set={"field.rows": 3, "field.columns": 3})
        for limit, target in ((0, (0, 2)), (0, "EN_7"), (0, "left_side"), (0, (1, 0, "LD_60")), (4, (0, 2)), (4, "crossed")):
            key = {"field.max_gates": limit}
            with tempfile.TemporaryDirectory() as folder:
                matrix.export(Path(folder) / "field.npz", set=key)
                chain = scipy.sparse.load_npz(Path(folder) / "field.npz").toarray()
                states = pandas.read_csv(Path(folder) / "field.states.csv")
            if isinstance(target, str):
                there = (states["ending"] == target) | (states["state"] == target)
            else:
                there = (states["column"] == target[0] + 1) & (states["row"] == target[1])
                there &= (states["state"] == target[2]) if len(target) > 2 else states["ending"].isna()
            walks = (states["ending"].isna() & ~there).to_numpy()
            left = np.eye(walks.sum()) - chain[np.ix_(walks, walks)]
            chance = np.linalg.solve(left, chain[np.ix_(walks, there.to_numpy())].sum(axis=1))
            gates = np.linalg.solve(left, chance)
            first = matrix.first_passage(target, set=key)
            table = first.to_frame()
            # With a limit states of the exported chain know how many gates came before: only the start's had none.
            where = states[walks & (states["entered_before"] == 0).to_numpy()]
            own = table.loc[list(zip(where["row"].astype(int), where["column"].astype(int) - 1, where["state"]))]
            count = len(own)
            np.testing.assert_allclose(own["probability"], chance[:count], rtol=1e-9, atol=1e-300)
            reached = chance[:count] > 1e-12
            np.testing.assert_allclose(own["mean_gates"][reached], gates[:count][reached] / chance[:count][reached], rtol=1e-9)
            self.assertAlmostEqual(first.probability, chance[0], 12)
            limits = matrix.analyze(runs=0, paths=0, set=key).endings_95.get(target) if isinstance(target, str) else None
            self.assertEqual(first.probability_95, limits)  # of one number one interval
            self.assertEqual(target in ("left_side", "crossed"), isinstance(limits, tuple))
            self.assertEqual(first.of_states["probability"].shape, (3, 3, 87))
            self.assertEqual(first.states, [f"{face}_{k}" for k, face in enumerate(matrix.states["face"])])
        np.testing.assert_array_equal(*(matrix.first_passage(state).of_states["mean_time_s"] for state in (3, "EN_3")))
        with self.assertRaisesRegex(gw.UsageError, "must be an ending .crossed, .* a gate .IX, IY. .IX -1 to 1, IY 0 to 2.*EN_0, ..., 87 in all"):
            matrix.first_passage((0, 3))

    def test_time_scales_are_those_of_the_kernel(self):
        matrix = gw.build(FIELD, bins="paper", trials=30)
        moduli = np.sort(abs(np.linalg.eigvals(matrix.matrix.toarray()[:, :-1])))[::-1][:6]
        found = matrix.analyze(runs=0, paths=0).quasi_stationary
        np.testing.assert_allclose(found["eigenvalues"], moduli, rtol=1e-12)
        np.testing.assert_allclose(found["time_scales_gates"], -1 / np.log(moduli), rtol=1e-10)
        # What deeptime's timescales() are of: trapped as a state that stays.
        n = len(matrix.states)
        stochastic = np.vstack([matrix.matrix.toarray(), np.eye(n + 1)[n]])
        np.testing.assert_allclose(np.sort(abs(np.linalg.eigvals(stochastic)))[::-1][:7], [1.0, *moduli], rtol=1e-12)

    def test_chains_from_elsewhere(self):
        states = {"state": [0, 1, 2], "move_x": [0, 1, 0], "move_y": [1, 0, 1], "name": ["up", "aside", "again"]}
        counts = np.array([[5, 3, 0, 2], [0, 0, 4, 0], [1, 0, 0, 0]])
        field = dict(start=0, set={"field.rows": 2, "field.columns": 5, "field.max_gates": 0})
        dense = gw.from_counts(counts, states, **field)
        sparse = gw.from_counts(scipy.sparse.csr_matrix(counts), pandas.DataFrame(states), **field)
        steps = gw.from_counts([[0] * 6 + [1, 2, 0], [0, 1, 2], [0, 1, 2], [1, 2], [0, 3], [0, 3]], states, **field)
        for other in (sparse, steps):
            self.assertEqual(dense.predict(), other.predict())
        with tempfile.TemporaryDirectory() as folder:  # and back
            path = Path(folder) / "counts.npz"
            dense.export(path, gate=True, counts=True)
            np.testing.assert_array_equal(scipy.sparse.load_npz(path).toarray(), counts)
        # The order of the table, though states of one face (up, again) stand together in the file.
        np.testing.assert_array_equal(dense.counts().toarray(), counts)
        np.testing.assert_array_equal(dense.matrix.toarray(), counts / counts.sum(axis=1, keepdims=True))
        self.assertEqual(list(dense.states.name), states["name"])
        self.assertEqual(list(dense.states.face), ["ahead", "right", "ahead"])
        for number, name in enumerate(states["name"]):
            self.assertEqual(dense.predict(start=number).endings, dense.predict(start=name).endings)
        shares = gw.from_counts(counts / counts.sum(axis=1, keepdims=True), states, **field)
        certain = shares.predict()
        self.assertEqual(set(certain.endings_95.values()), {None})
        self.assertTrue(certain.to_frame()[["low_95", "high_95"]].isna().all(axis=None))
        self.assertIn("crossed 0.7, ", repr(certain))
        with self.assertRaisesRegex(gw.UsageError, "the chain: is 2 x 2; of 3 states it must be 3 x 4"):
            gw.from_counts(counts[:2, :2], states)

    def test_chains_as_scipy_writes_them(self):
        states = {"state": [0, 1, 2], "move_x": [0, 1, 0], "move_y": [1, 0, 1]}
        counts = np.array([[5, 2, 1, 1], [3, 0, 0, 1], [3, 0, 0, 1]])
        square = np.array([[4, 2, 1], [2, 0, 0], [1, 0, 0]])  # mmwrite finds out that it is symmetric
        shares = counts / counts.sum(axis=1, keepdims=True)

        def read(path):
            return gw.from_counts(path, states, start=0)

        def equals(matrix, wanted, probabilities=False):
            if probabilities:
                self.assertIsNone(matrix.predict().endings_95["crossed"])
                np.testing.assert_allclose(matrix.matrix.toarray()[:, : wanted.shape[1]], wanted, rtol=0, atol=2e-7)
            else:
                np.testing.assert_array_equal(matrix.counts().toarray()[:, : wanted.shape[1]], wanted)

        with tempfile.TemporaryDirectory() as folder:
            def path(name):
                return os.path.join(folder, name)
            for kind in ("int64", "uint64", "int8", "float32", "float64"):
                for matrix in (counts, square):
                    for made in (scipy.sparse.coo_matrix(matrix.astype(kind)), matrix.astype(kind)):
                        with self.subTest(kind=kind, symmetric=matrix is square, dense=made.ndim and isinstance(made, np.ndarray)):
                            scipy.io.mmwrite(path("a.mtx"), made)
                            equals(read(path("a.mtx")), matrix)
                    for form in ("csr", "csc", "coo"):
                        with self.subTest(kind=kind, form=form):
                            scipy.sparse.save_npz(path("a.npz"), scipy.sparse.coo_matrix(matrix.astype(kind)).asformat(form))
                            equals(read(path("a.npz")), matrix)
                with self.subTest(kind=kind):
                    equals(gw.from_counts(counts.astype(kind), states, start=0), counts)
            # Rows out of order, and a 5 that is 2 and 3, as scipy itself adds them.
            twice = scipy.sparse.csr_matrix((np.array([2, 3, 1, 2, 1, 1, 3, 1, 3]), np.array([0, 0, 3, 1, 2, 3, 0, 3, 0]), np.array([0, 5, 7, 9])),
                                            shape=(3, 4))
            np.testing.assert_array_equal(twice.toarray(), counts)
            scipy.sparse.save_npz(path("a.npz"), twice)
            equals(read(path("a.npz")), counts)
            self.assertEqual(read(path("a.npz")).made_by["understood"], "entries with the row and column of another are added to it, as scipy does: 1")
            scipy.io.mmwrite(path("a.mtx"), twice)
            equals(read(path("a.mtx")), counts)
            for made in (shares, shares.astype("float32"), shares.astype("float32").astype("float64")):
                scipy.sparse.save_npz(path("a.npz"), scipy.sparse.csr_matrix(made))
                equals(read(path("a.npz")), shares, True)
                scipy.io.mmwrite(path("a.mtx"), scipy.sparse.csr_matrix(made))
                equals(read(path("a.mtx")), shares, True)
                equals(gw.from_counts(made, states, start=0), shares, True)
            np.savetxt(path("a.dtrajs"), [[0, 1, 0, 2, 0], [0, 0, 1, 0, 3]])  # as 0.000000000000000000e+00
            equals(read(path("a.dtrajs")), np.array([[1, 2, 1, 1], [2, 0, 0, 0], [1, 0, 0, 0]]))
            gaps = [np.array([0, 1, -1, -1, 0, 2]), np.array([-1.0, 0.0, 3.0])]  # 0 1, 0 2, 0 trapped
            np.savez(path("a.dtrajs.npz"), *gaps)
            for matrix in (read(path("a.dtrajs.npz")), gw.from_counts(gaps, states, start=0)):
                equals(matrix, np.array([[0, 1, 1, 1], [0, 0, 0, 0], [0, 0, 0, 0]]))
                self.assertEqual(matrix.made_by["understood"], "-1 is a gap: 2 of 2 trajectories are cut there, into 3")
            for made, words in ((scipy.sparse.bsr_matrix(counts), "must be csr, csc or coo, not bsr: scipy.sparse.save_npz"),
                                (scipy.sparse.csr_matrix(counts > 0), "true and false, and no counts"),
                                (scipy.sparse.csr_matrix(counts * 0.9), "round effective counts to whole numbers"),
                                (scipy.sparse.csr_matrix(counts.astype(complex)), "holds c16")):
                scipy.sparse.save_npz(path("a.npz"), made)
                with self.assertRaisesRegex(gw.UsageError, words):
                    read(path("a.npz"))
            for made, words in (([np.array([0]), np.array([1])], "no trajectory has a second state"), ([counts], "has two dimensions: .*save_npz"),
                                ([np.array([True, False])], "whole numbers"), ([np.array([0, 0.5])], "0.5 is no whole number"),
                                ([np.array([0, 2**63], dtype=np.uint64)], r"above 2\^63 - 1")):
                np.savez(path("b.npz"), *made)
                with self.assertRaisesRegex(gw.UsageError, words):
                    read(path("b.npz"))

    def test_chains_that_would_have_to_be_guessed(self):
        states = {"state": [0, 1], "move_x": [0, 0], "move_y": [1, 1]}
        field = dict(start=0, set={"field.rows": 2, "field.columns": 1, "field.max_gates": 0})
        # Two lists of two or three numbers: counts, or ways 0 -> 1 -> 1? By hand the answers differ.
        nested = [[0, 1, 1], [1, 0, 1]]
        for ambiguous in (nested, [[0, 1], [1, 0]], ((0, 1), (1, 0)), [[0.5, 0.5], [1.0, 0.0]], [[6, 4]]):
            with self.assertRaisesRegex(gw.UsageError, r"may be a matrix or trajectories: numpy.array\(chain\) is a matrix"):
                gw.from_counts(ambiguous, states, **field)
        np.testing.assert_array_equal(gw.from_counts(np.array(nested), states, **field).counts().toarray(), nested)
        unsigned = gw.from_counts(np.array(nested, dtype=np.uint64), states, **field)
        np.testing.assert_array_equal(unsigned.counts().toarray(), nested)
        # 0 -> 1, 1 -> 1 and 1 -> 0, 0 -> 1.
        np.testing.assert_array_equal(gw.from_counts([np.array(one) for one in nested], states, **field).counts().toarray(), [[0, 2, 0], [1, 1, 0]])
        whole = [np.array([0.0, 1.0, 1.0]), pandas.Series([1, 0, 1], dtype="Int64"), range(2)]
        np.testing.assert_array_equal(gw.from_counts(whole, states, **field).counts().toarray(), [[0, 3, 0], [1, 1, 0]])
        good = np.array([0, 1, 1, 0])
        for wrong, words in ((np.array([0, 1.5, 1]), "step 1 .*: 1.5 is no whole number"),
                             (np.array([0, 1, np.nan]), "step 2 .*: nan is no whole number; cut the trajectory there"),
                             (np.array([0, np.inf]), "step 1 .*: inf is no whole number"),
                             ([0, 1, None], "step 2 .*: None is no whole number"),
                             ([0, "1"], "step 1 .*: '1' is no whole number"),
                             ([0, 0.25, 1, 0], "step 1 .*: 0.25 is no whole number"),
                             (np.array([True, False]), "step 0 .*True.* is no whole number"),
                             (np.array([0, 1j]), "step 0 .* is no whole number"),
                             (pandas.Series([0, None, 1], dtype="Int64"), "step 1 .*: <NA> is no whole number"),
                             (np.ma.masked_array([0, 1, 1], [False, False, True]), "step 2 .*: masked; cut"),
                             ([0, True, 1, 0], "step 1 .*: True is no whole number"),
                             ((0, 1, np.bool_(False), 0), "step 2 .*False.* is no whole number"),
                             (np.array([0, 1], dtype="timedelta64[s]"), "step 0 .*timedelta64.* is no whole number"),
                             ([0, np.timedelta64(1, "s"), 0, 0], "step 1 .*timedelta64.* is no whole number"),
                             ([0, np.ma.masked, 1, 0], "step 1 .*: masked; cut the trajectory there"),
                             (np.array([0, -2, 1]), "step 1 .*: -2 is no state"),
                             (np.zeros((2, 2)), "is no sequence of states")):
            with self.assertRaisesRegex(gw.UsageError, "the chain: trajectory 1[, ].*" + words), warnings.catch_warnings():
                warnings.simplefilter("error")
                gw.from_counts([good, wrong], states, **field)
        for none in ([], (), [np.array([0])], [[0], [1], []]):
            with self.assertRaisesRegex(gw.UsageError, "the chain: no trajectory has a step"):
                gw.from_counts(none, states, **field)
        with self.assertRaisesRegex(gw.UsageError, "row 1, column 0 .* is masked"):
            gw.from_counts(np.ma.masked_array([[1, 2], [3, 4]], [[False, False], [True, False]]), states, **field)
        for wrong, words in ((np.array([[True, False], [False, True]]), "a matrix of bool"), (np.array([[1j, 0], [0, 1]]), "a matrix of complex"),
                             (np.array([[2**63, 1], [1, 1]], dtype=np.uint64), r"more than 2\^63 - 1"),
                             (np.array([[0.5, np.nan], [1, 0]]), "the chain"), (np.array([[1, -1], [1, 0]]), "the chain"),
                             (pandas.DataFrame([[1, 2], [3, 4]]), "is DataFrame; a matrix is a numpy array"), (good, "of shape"),
                             ([0, 1, 1], "one trajectory is a list of one array"), ({0: [0, 1]}, "is dict"), ("01", "01")):
            with self.assertRaisesRegex(ValueError, words):
                gw.from_counts(wrong, states, **field)
        for count in (1.5, float("nan"), True, None, "3"):
            with self.assertRaisesRegex(gw.UsageError, "the table: the count of crossed must be a whole number"):
                gw.validate(FIELD, observed={"crossed": count, "trapped": 17})

    def test_what_the_endings_leave_out_has_a_name(self):
        # Nobody was seen to leave "right", which 1/2 enter in the first cell and 1/4 in the second; 1/4 cross.
        states = {"state": [0, 1], "move_x": [0, 1], "move_y": [1, 0], "name": ["up", "right"]}
        half = gw.from_counts(np.array([[5, 5, 0], [0, 0, 0]]), states, start=0,
                              set={"field.rows": 2, "field.columns": 3, "field.max_gates": 20})
        with self.assertWarnsRegex(gw.GatewalkWarning, "add up to 25.00 %: 75.00 % reach a state that was never sampled"):
            p = half.predict()
        self.assertEqual((p.endings["crossed"], p.never_sampled, p.still_walking), (0.25, 0.75, 0.0))
        for start in (1, np.int64(1), "right"):
            with self.assertWarnsRegex(gw.GatewalkWarning, "never sampled"):
                self.assertEqual(half.predict(start=start).never_sampled, 1.0)
        frame = p.to_frame()
        self.assertEqual((frame.value["never_sampled"], frame.value.sum()), (0.75, 1.0))
        self.assertNotIn("still_walking", frame.index)
        self.assertEqual(float(p.to_xarray().endings.sum()), 1.0)
        self.assertIn("never sampled 0.75", repr(p))
        with self.assertWarnsRegex(gw.GatewalkWarning, "never sampled"):
            self.assertEqual(half.analyze().never_sampled, 0.75)
        with self.assertWarnsRegex(gw.GatewalkWarning, "never sampled"):
            walked = gw.walk(half, walks=100)
        self.assertEqual(sum(walked.endings.values()) + walked.never_sampled, walked.walks)

    def test_limits_of_counts_are_counts(self):
        seen = gw.lattice(FIELD, trials=50)
        for ending, (low, high) in seen.endings_95.items():
            self.assertTrue(low <= seen.endings[ending] <= high, ending)
        frame = seen.to_frame()
        np.testing.assert_array_equal(frame[["low_95", "high_95"]], list(seen.endings_95.values()))
        self.assertTrue((frame.low_95 <= frame.value).all() and (frame.value <= frame.high_95).all())
        self.assertGreater(frame.high_95.max(), 1.0)
        data = seen.to_xarray()
        self.assertTrue((data.endings_95.sel(bound="low") <= data.endings).all())
        self.assertTrue((data.endings <= data.endings_95.sel(bound="high")).all())
        np.testing.assert_array_equal(data.endings_95, frame[["low_95", "high_95"]])
        one = gw.gate(FIELD, trials=50)
        self.assertTrue(one.traversed_95[0] <= one.traversed <= one.traversed_95[1] and one.trapped_95[1] > 1.0)


class Scenes(unittest.TestCase):
    def test_sources(self):
        text = FIELD.read_text()
        self.assertEqual(gw.Scene(FIELD), gw.Scene(text))
        tables = gw.Scene({"body": {"radius_cm": 4.0, "mass_g": 250.0}, "forces": {"propulsion_N": 1.2}})
        self.assertEqual(tables["body.radius_m"], 0.04)
        self.assertEqual(tables["body.mass_kg"], 0.25)
        self.assertNotEqual(tables, tables.with_set({"body.mass_g": 240}))
        for twin in (pickle.loads(pickle.dumps(tables)), copy.deepcopy(tables)):
            self.assertEqual(twin, tables)
            self.assertEqual(hash(twin), hash(tables))
        self.assertIn("<td>body.radius_m</td>", tables._repr_html_())
        walker = gw.Scene(gw.sample("walker"))
        said = " ".join(subprocess.run([PROGRAM, "sample", "walker"], capture_output=True, check=True, text=True).stdout.split())
        self.assertEqual(said, " ".join(gw.sample("walker").split()))
        shown = subprocess.run([PROGRAM, "scene", ROOT / "scenes/walker.toml"], capture_output=True, check=True, text=True).stdout
        self.assertGreaterEqual(len(walker.remarks), 5)
        for remark in walker.remarks:
            self.assertIn(remark.split(": ", 1)[1], " ".join(shown.split()))
        self.assertIn("<li>sideways: noise moves the body", walker._repr_html_())
        self.assertEqual([r.split(": ")[0] for r in gw.Scene(FIELD).remarks],
                         ["size", "speed", "sideways", "beams", "beams", "trapped"] + ["far from what walks"] * 4)

    def test_terrain_is_part_of_a_scene(self):
        mixed = (ROOT / "scenes/mixed.toml").read_text()
        one, other = gw.Scene(mixed), gw.Scene(mixed.replace("seed = 5", "seed = 6"))
        self.assertNotEqual(one, other)
        self.assertNotEqual(hash(one), hash(other))
        self.assertEqual(one, gw.Scene(ROOT / "scenes/mixed.toml"))

    def test_values_of_numpy(self):
        frame = gw.sweep(SINGLE, {"forces.propulsion_N": np.array([6.0, 7.0])}, trials=10).to_frame()
        self.assertEqual(list(frame["forces.propulsion_N"]), [6, 7])
        for start in ((1.0, 0.0, 15.0), [1.0, 0.0, 15.0], np.array([1.0, 0.0, 15.0])):
            self.assertEqual(len(gw.predict(FIELD, accuracy=0.2, start=start).starts), 1)
        self.assertIn("crossed", gw.predict(FIELD, accuracy=0.2, start=start).endings)
        two = gw.predict(FIELD, accuracy=0.2, start=[(1.0, 0.0, 15.0), (0.0, 0.0, 15.0)])
        with self.assertRaisesRegex(ValueError, "there are 2 starts"):
            two.to_frame()
        for wrong in ({"start": []}, {"accuracy": [0.1, 0.2]}, {"output": "x.nc"}):
            with self.assertRaises(gw.UsageError):
                gw.predict(FIELD, **wrong)
        thin = gw.lattice(FIELD, trials=10, set={"field.columns": 2, "field.rows": 2})
        self.assertEqual(thin.final_gates.shape, (2, 2))
        self.assertEqual(gw.trace("[forces]\npropulsion_N = 7\n", trials=1), gw.trace("[forces]\npropulsion_N = 7\n", trials=1))

    def test_errors_are_the_programs(self):
        for wrong, text in (({"forces.propulsion_N": -1.0}, "must lie in"), ({"forces.propulsion": 1.0}, "did you mean|closest known key")):
            with self.assertRaisesRegex(gw.SceneError, text) as caught:
                gw.Scene(FIELD, wrong)
            self.assertIsInstance(caught.exception, ValueError)
            key, value = next(iter(wrong.items()))
            said = subprocess.run([PROGRAM, "scene", FIELD, f"--set={key}={value}"], capture_output=True, text=True, check=False).stderr
            in_python = said.replace(f"--set {key}={value}", f"set={{{key!r}: {value}}}")
            self.assertEqual(f"gatewalk: {caught.exception}\n", in_python)
            self.assertNotEqual(said, in_python)
        with self.assertRaisesRegex(gw.UsageError, "did you mean accuracy=[?]"):
            gw.predict(FIELD, acuracy=0.1)
        with self.assertRaisesRegex(gw.UsageError, "has no meaning in Python"):
            gw.predict(FIELD, checkpoint="x")
        with self.assertRaisesRegex(gw.SceneError, "nosuch.toml"):
            gw.Scene("nosuch.toml")
        with self.assertRaisesRegex(gw.SceneError, "^scene.toml:2: "):
            gw.predict("[forces]\npropulsion_N = -1\n")


class Loaded(unittest.TestCase):
    """Matrices in memory answer as the program does from their files."""

    def check(self, matrix, *words, **asked):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "m.nc"
            matrix.save(path)
            said = plain(program("predict", path, *words))
            for _ in range(2):  # the first call leaves nothing behind
                self.assertEqual(plain(matrix.predict(**asked)), said)

    def test_trees(self):
        matrix = gw.build(FIELD, accuracy=0.1)
        self.check(matrix)
        self.check(matrix, "--set", "field.rows=3", set={"field.rows": 3})
        self.check(matrix, "--start=1,0,15", "--first-runs", 100, start=(1.0, 0.0, 15.0), first_runs=100)
        self.check(matrix, "--first-runs", 0, first_runs=0)
        self.check(matrix, "--accuracy", 0.05, accuracy=0.05)
        with tempfile.TemporaryDirectory() as folder:
            text = FIELD.read_text()
            (Path(folder) / "other.toml").write_text(text)
            self.check(matrix, Path(folder) / "other.toml", "--set", "field.rows=4", scene=gw.Scene(text, {"field.rows": 4}))
        with self.assertRaisesRegex(ValueError, "the scene is not the one"):
            matrix.predict(scene=gw.Scene(FIELD, {"forces.random_N": 10.0}))

    def test_types_of_gates_and_cells(self):
        self.check(gw.build(ROOT / "scenes/mixed.toml", accuracy=0.2))
        recorded = gw.from_passages(ROOT / "scenes/tracks/runs.csv", ROOT / "scenes/tracks/cell.toml")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", gw.GatewalkWarning)
            self.check(recorded)


class Results(unittest.TestCase):
    def test_tables(self):
        p = gw.predict(FIELD, accuracy=0.1)
        self.assertAlmostEqual(sum(p.endings.values()), 1.0, 12)
        self.assertEqual(p.final_gates.shape, (9, 9))
        data = p.to_xarray()
        self.assertEqual(data.final_gates.dims, ("i_y", "i_x"))
        self.assertEqual(list(data.i_x.values), list(range(-4, 5)))
        np.testing.assert_array_equal(data.final_gates.values, p.final_gates)
        # An interval is a tuple; of a table they are an array, as the program has them.
        self.assertEqual({type(limits) for limits in p.endings_95.values()}, {tuple})
        self.assertEqual(p.final_gates_95.shape, (9, 9, 2))
        np.testing.assert_array_equal(p.final_gates_95, program("predict", FIELD, "--accuracy", 0.1)["final_gates_95"])
        self.assertEqual(data.final_gates_95.dims, ("i_y", "i_x", "bound"))
        np.testing.assert_array_equal(data.final_gates_95.values, p.final_gates_95)
        low, high = data.final_gates_95.sel(bound="low"), data.final_gates_95.sel(bound="high")
        self.assertTrue((low <= data.final_gates).all() and (data.final_gates <= high).all() and (low < high).any())
        self.assertEqual(list(p.to_frame().index), list(p.endings))
        twin = pickle.loads(pickle.dumps(p))
        self.assertEqual(twin, p)
        self.assertNotEqual(gw.predict(FIELD, accuracy=0.1, seed=2), p)
        self.assertIn("crossed", repr(p))
        self.assertIn("<table>", p._repr_html_())
        with self.assertRaisesRegex(AttributeError, "has no endngs"):
            p.endngs
        frame = gw.sweep(SINGLE, {"forces.propulsion_N": [6, 7]}, trials=20).to_frame()
        self.assertEqual(list(frame["forces.propulsion_N"]), [6, 7])
        self.assertEqual(list(frame["trials"]), [20, 20])
        self.assertIn("vy", gw.trace(FIELD).to_frame())

    def test_fields_of_two_columns(self):
        """Their rows have two numbers, as intervals do."""
        import matplotlib

        matplotlib.use("Agg")
        field = {"field.columns": 2, "field.rows": 3}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", gw.GatewalkWarning)
            few = gw.from_passages(ROOT / "scenes/tracks/runs.csv", ROOT / "scenes/tracks/cell.toml").predict(set=field)
        many = gw.predict(FIELD, accuracy=0.2, set=field)
        self.assertIsNone(few.final_gates_95)  # of fewer than 16 bodies there are no intervals
        self.assertEqual(set(few.endings_95.values()), {None})
        self.assertEqual(many.final_gates_95.shape, (3, 2, 2))
        for p, has_intervals in ((few, False), (many, True)):
            self.assertEqual(p.final_gates.shape, (3, 2))
            data = p.to_xarray()
            self.assertEqual(data.final_gates.shape, (3, 2))
            self.assertEqual("final_gates_95" in data, has_intervals)
            self.assertEqual("95 % intervals" in p.plot()[1].get_xlabel(), has_intervals)

    def test_lists_of_intervals_and_of_bounds(self):
        v = gw.validate(FIELD, accuracy=0.2, trials=200, null_draws=99, start=[(0.0, 0.0, 15.0), (1.0, 0.0, 15.0)])
        step = v.markov["gates_ahead"]["steps"][0]
        self.assertEqual(step["time_scales_chance_95"].shape, (len(step["time_scales_gates"]), 2))
        self.assertEqual(v.state_space["error_95"].shape, (2,))  # no interval: a bound for each start
        low, high = v.starts[0]["endings"]["dynamics_95"]["trapped"]
        self.assertTrue(1 < low <= v.starts[0]["endings"]["dynamics"]["trapped"] <= high < 200)

    def test_columns_are_numbered_as_in_the_program(self):
        import matplotlib
        import netCDF4

        matplotlib.use("Agg")
        # One state, which is entered ahead: all bodies stay in the column in which they start.
        ahead = gw.from_counts(np.array([[10, 0]]), {"state": [0], "move_x": [0], "move_y": [1]}, start=0, set={"field.rows": 3})
        for columns, start, first in ((1, {}, 0), (2, {}, -1), (3, {}, -1), (4, {}, -2), (5, {}, -2), (5, {"field.start_column": 1}, -1)):
            with self.subTest(columns=columns, start=start), tempfile.TemporaryDirectory() as folder:
                there = {"field.columns": columns, **start}
                p = ahead.predict(set=there, netcdf=str(Path(folder) / "p.nc"))
                data = p.to_xarray()
                with netCDF4.Dataset(Path(folder) / "p.nc") as file:
                    np.testing.assert_array_equal(data.i_x, file["i_x"][:])
                    np.testing.assert_array_equal(data.final_gates, file["final_gates"][0])
                self.assertEqual(data.i_x[0], first)
                self.assertEqual(float(data.final_gates.sel(i_y=2, i_x=0)), 1.0)
                image = p.plot()[0].images[0]
                left, right, *_ = image.get_extent()
                self.assertEqual((left, right), (first - 0.5, first + columns - 0.5))
                self.assertEqual(left + 0.5 + np.argmax(image.get_array()[2]), 0)
                table = ahead.first_passage("crossed", set=there).to_frame()
                self.assertEqual(sorted(table.index.unique("i_x")), list(data.i_x))
                matplotlib.pyplot.close("all")

    def test_pictures(self):
        import matplotlib

        matplotlib.use("Agg")
        with tempfile.TemporaryDirectory() as folder:
            for name, axes in (("prediction", gw.predict(FIELD, accuracy=0.1).plot()[0]), ("lattice", gw.lattice(FIELD, trials=50).plot()[0]),
                               ("matrix", gw.build(FIELD, bins="paper", trials=5).plot()), ("trace", gw.trace(FIELD, field=True).plot()),
                               ("landscape", gw.landscape(SINGLE).plot())):
                file = Path(os.environ.get("KEEP", folder)) / f"{name}.png"
                axes.figure.savefig(file, dpi=100)
                self.assertGreater(file.stat().st_size, 5000)

    def test_warnings_are_heard(self):
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            gw.predict(FIELD, accuracy=0.01, gate_runs=200)
        self.assertTrue(any(issubclass(w.category, gw.GatewalkWarning) for w in heard))


class Cells(unittest.TestCase):
    def test_batches_of_numpy(self):
        gw.threads(1)
        one = gw.predict(CELLS, cell=Pillars(), accuracy=0.03, seed=3)
        gw.threads(0)
        self.assertEqual(one, gw.predict(CELLS, cell=Pillars(), accuracy=0.03, seed=3))  # same bits for any threads
        seen = gw.lattice(CELLS, cell=Pillars(), trials=4000)
        for ending, count in seen.endings.items():
            low, high = one.endings_95.get(ending, (0.0, 0.0))
            self.assertLess(abs(count / 4000 - one.endings[ending]), high - low + 0.02, ending)
        matrix = gw.build(CELLS, cell=Pillars(), accuracy=0.05)
        self.assertEqual(plain(matrix.predict(cell=Pillars()).endings.keys()), plain(one.endings.keys()))
        influences = gw.analyze(CELLS, cell=Pillars(), accuracy=0.05, runs=500)
        self.assertIn("stay", str(influences._data))

    def test_wrong_cells(self):
        def with_answer(change):
            class Wrong(Pillars):
                def pass_(self, entries, random):
                    return change(super().pass_(entries, random))
            return Wrong()

        for change, text in ((lambda a: {**a, "face": a["face"] + 7}, "the face [789]; faces are 0 to 2"),
                             (lambda a: {**a, "s": a["s"] * np.nan}, "s that is not finite"),
                             (lambda a: {**a, "time_s": -a["time_s"]}, "a time that is negative"),
                             (lambda a: {k: v for k, v in a.items() if k != "s"}, "gave no s"),
                             (lambda a: {**a, "face": a["face"] * 1.0}, "whole numbers as face"),
                             (lambda a: 1 / 0, "division by zero"),
                             (lambda a: {**a, "face": a["face"].astype(np.int64) + 2**32}, "the face 42949"),
                             (lambda a: {**a, "memory": np.zeros((2, len(a["face"])))}, "memory of shape"),
                             (lambda a: {**a, "vx": 0.0}, "gave vx; it may give"),
                             (lambda a: None, "must give a dict"),
                             (lambda a: gw.gate(FIELD, trials=1), "a command cannot be called")):
            with self.assertRaisesRegex((ValueError, ZeroDivisionError), text):
                gw.lattice(CELLS, cell=with_answer(change), trials=10)
        with self.assertRaisesRegex(gw.UsageError, "not the class itself"):
            gw.lattice(CELLS, cell=Pillars, trials=10)
        with self.assertRaisesRegex(gw.UsageError, "is of gates"):
            gw.gate(FIELD, cell=Pillars())
        with self.assertRaisesRegex(NotImplementedError, "pass_"):
            class Bare(gw.Cell):
                faces, coordinates = Pillars.faces, Pillars.coordinates
            gw.lattice(CELLS.replace("symmetric = true\n", ""), cell=Bare(), trials=10)


    def test_nothing_is_cast(self):
        def answering(**more):
            class Wrong(Pillars):
                def pass_(self, entries, random):
                    out = super().pass_(entries, random)
                    return {**out, **{key: change(out[key]) for key, change in more.items()}}
            return Wrong()

        def masked(values):
            return np.ma.masked_array(values, np.arange(len(values)) == 0)

        for cell, text in ((answering(s=masked), "s with masked entries"), (answering(time_s=masked), "time_s with masked entries"),
                           (answering(face=masked), "face with masked entries"), (answering(memory=masked), "memory with masked entries"),
                           (answering(s=lambda s: s + 0j), "numbers as s, it gave complex128"), (answering(s=lambda s: s > 0), "numbers as s, it gave bool"),
                           (answering(time_s=lambda s: s.astype(str)), "numbers as time_s, it gave <U"),
                           (answering(face=lambda f: np.full(len(f), 2**64 - 1, dtype=np.uint64)), "the face 18446744073709551615; faces are 0 to 2")):
            with self.assertRaisesRegex(ValueError, text):
                gw.lattice(CELLS, cell=cell, trials=10)
        for value in ("0.2", True, None, np.array([0.2])):
            cell = Pillars()
            cell.parameters = {**Pillars.parameters, "side": value}
            with self.assertRaisesRegex(ValueError, "side of parameters must be a number"):
                gw.lattice(CELLS, cell=cell, trials=10)

    def test_cells_that_depend_on_more_than_the_row(self):
        class Forgetful(Pillars):
            def pass_(self, entries, random):
                random.uniforms = np.random.default_rng().random(random.uniforms.shape)
                return super().pass_(entries, random)

        class OfTheBatch(Pillars):
            def pass_(self, entries, random):
                random.uniforms = np.random.default_rng(random.seed[0]).random(random.uniforms.shape)
                return super().pass_(entries, random)

        class Counting(Pillars):
            passed = 0

            def pass_(self, entries, random):
                out = super().pass_(entries, random)
                self.passed += len(out["face"])
                return {**out, "time_s": 1.0 + self.passed + np.arange(len(out["face"]))}

        for threads in (1, 3):
            gw.threads(threads)
            for wrong in (Forgetful, OfTheBatch, Counting):
                for trials in (5, 3000):
                    with self.assertRaisesRegex(RuntimeError, r"in two ways: a body that entered by [SWE] .* sent once more, with the same noise"):
                        gw.lattice(CELLS, cell=wrong(), trials=trials)
        gw.threads(0)

    def test_check_cell(self):
        self.assertEqual(gw.check_cell(Pillars()), [])
        self.assertEqual(gw.check_cell(Pillars(), [{"face": "W", "s": 0.05}], trials=50, cells=3, seed=2), [])

        class Timeless(Pillars):
            def pass_(self, entries, random):
                return {**super().pass_(entries, random), "time_s": 0.0}

        class Lopsided(Pillars):
            def pass_(self, entries, random):
                out = super().pass_(entries, random)
                return {**out, "face": np.where(out["face"] == 1, 2, out["face"])}

        class Stateful(Pillars):
            passed = 0

            def pass_(self, entries, random):
                self.passed += 1
                return {**super().pass_(entries, random), "time_s": float(self.passed)}

        for cell, words in ((Timeless(), "time_s is not > 0"), (Lopsided(), "it says that it is symmetric"), (Stateful(), "is another one")):
            self.assertTrue(any(words in complaint for complaint in gw.check_cell(cell)), gw.check_cell(cell))
        for bad in ([{"face": "Q", "s": 0.0}], [{"face": "S"}], [{"face": "S", "s": 0.0, "vx": 1.0}]):
            with self.assertRaisesRegex(gw.UsageError, "start 0 must have a face, one of S, W, E, and s"):
                gw.check_cell(Pillars(), bad)
        with self.assertRaisesRegex(gw.UsageError, "derived from gatewalk.Cell"):
            gw.check_cell(Pillars)
        for value, words in (("0.1", "must be a number, not '0.1'"), (True, "must be a number, not True"), (None, "must be a number, not None"),
                             (float("nan"), "must be finite, not nan"), (np.inf, "must be finite, not inf")):
            with self.assertRaisesRegex(gw.UsageError, "check_cell: s of start 1 " + words):
                gw.check_cell(Pillars(), [{"face": "S", "s": 0.0}, {"face": "S", "s": value}])
        for starts in ({"face": "S", "s": 0.0}, pandas.DataFrame({"face": ["S"], "s": [0.0]}), [("S", 0.0)], [], "S"):
            with self.assertRaisesRegex(gw.UsageError, "starts must be a list of dicts, at least one, not " + type(starts).__name__):
                gw.check_cell(Pillars(), starts)
        for name, most, wrong in (("trials", 2**63 - 1, (0, 2.5, "5", True, 2**63)), ("cells", 2**31 - 1, (0, 2.0, 2**31)),
                                  ("seed", 2**64 - 1, (-1, 1.5, None, 2**64))):
            for value in wrong:
                with self.assertRaisesRegex(gw.UsageError, f"check_cell: {name} must be a whole number from [01] to {most}, not {value!r}"):
                    gw.check_cell(Pillars(), **{name: value})
        self.assertEqual(gw.check_cell(Pillars(), ({"face": "S", "s": np.float32(0.5)},), trials=np.int64(20), cells=np.uint8(3), seed=2**64 - 1), [])

        class Nameless(Pillars):
            faces = [{"move": [0, 1]}]

        with self.assertRaisesRegex(gw.UsageError, r"cell: faces\[0\] must be a dict with a name, not {'move': \[0, 1\]}"):
            gw.check_cell(Nameless())

        class OfNumpy(Pillars):  # whose numbers JSON does not know
            faces = [{**face, "move": np.array(face["move"])} for face in Pillars.faces]
            coordinates = [{**c, "scale": np.float32(0.5)} for c in Pillars.coordinates]
            uniforms, normals, symmetric = np.int64(Pillars.uniforms), np.int64(Pillars.normals), np.bool_(Pillars.symmetric)

        self.assertEqual(gw.check_cell(OfNumpy(), trials=20), [])


class Recorded(unittest.TestCase):
    def test_tables_and_tracks(self):
        import pandas

        with tempfile.TemporaryDirectory() as folder:
            runs, cell = Path(folder) / "runs.csv", Path(folder) / "cell.toml"
            subprocess.run([PROGRAM, "lattice", FIELD, "--trials", "400", "--passages", runs, "--cell-file", cell, "--quiet"], check=True,
                           stdout=subprocess.DEVNULL)
            frame = pandas.read_csv(runs, comment="#", float_precision="round_trip")
            of_frame, of_file = gw.from_passages(frame, cell), gw.from_passages(runs, cell)
            self.assertEqual((of_frame.counts() != of_file.counts()).nnz, 0)
            self.assertEqual(of_frame.predict().endings, of_file.predict().endings)
            wrong = frame.copy()
            wrong.loc[3, "in"] = "Q"
            with self.assertRaisesRegex(ValueError, "^the table:"):
                gw.from_passages(wrong, cell)
        n = 240
        steps = np.arange(n)
        tracks = pandas.concat([pandas.DataFrame({"body": f"b{b}", "frame": steps, "x": 0.5 + 0.002 * b + 0.0 * steps,
                                                  "y": 0.01 + 0.01 * steps}) for b in range(3)])
        plain_cell = CELLS.replace("symmetric = true\n", "").replace('odd = ["s"]\n', "").replace("odd = []\n", "").replace(
            'mirror = "E"\n', "").replace('mirror = "W"\n', "")
        cut = gw.passages(tracks, plain_cell, fps=60, metres_per_unit=1, fastest=5.0, columns={"body": "body", "frame": "frame", "x": "x", "y": "y"})
        self.assertGreaterEqual(len(cut), 3)
        self.assertEqual(set(cut["in"]), {"S"})
        # Rows of 1 m, up to y = 2.4 m; in a field of one row two more of the bodies' rows are outside.
        fewer = gw.passages(tracks, plain_cell + "\n", fps=60, metres_per_unit=1, fastest=5.0, lattice="1,2",
                            columns={"body": "body", "frame": "frame", "x": "x", "y": "y"})
        self.assertEqual((len(fewer), fewer.attrs["lattice"]), (3, {"columns": 1, "rows": 2}))
        self.assertEqual(fewer.attrs["endings"], {"left": 3, "trapped": 0, "lost": 0})
        self.assertAlmostEqual(fewer.attrs["places_outside"], 3 * 40, delta=3)


class AsAGuest(unittest.TestCase):
    def test_other_threads_run(self):
        ticks, stop = [], threading.Event()

        def tick():
            while not stop.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.005)

        thread = threading.Thread(target=tick)
        thread.start()
        gw.lattice(FIELD, trials=4000)
        stop.set()
        thread.join()
        self.assertGreater(len(ticks), 10)

    def test_interrupt(self):
        code = ("import signal, sys, time, gatewalk as gw\n"
                "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
                "print('go', flush=True)\n"
                "try:\n    gw.lattice(sys.argv[1], trials=10**8)\n"
                "except KeyboardInterrupt:\n    print('stopped', flush=True)\n")
        waited = []
        for _ in range(5):  # others may keep the machine busy meanwhile
            child = subprocess.Popen([sys.executable, "-c", code, str(FIELD)], stdout=subprocess.PIPE, text=True)
            child.stdout.readline()
            time.sleep(1.0)
            begin = time.monotonic()
            child.send_signal(signal.SIGINT)
            self.assertEqual(child.stdout.readline(), "stopped\n")
            waited.append(time.monotonic() - begin)
            child.stdout.close()
            child.wait()
            if waited[-1] < 0.3:
                break
        self.assertLess(min(waited), 0.3)

    def test_another_locale(self):
        """Qt, for one, takes the user's for the whole process."""
        with tempfile.TemporaryDirectory() as name:
            folder, locales = Path(name) / "out", Path(name) / "locales"
            locales.mkdir()
            subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", locales / "de_DE.UTF-8"], check=True)

            def written():
                """What some calls say, write and draw."""
                folder.mkdir()
                self.assertEqual(gw.Scene({"body": {"radius_cm": 12.5}})["body.radius_m"], 0.125)
                matrix = gw.build(FIELD, bins="paper", trials=10)
                said = [matrix.predict(figure=folder / "p.svg"), gw.landscape(SINGLE, spacing=2.5, trials=20),
                        gw.landscape(SINGLE, spacing=2.5).to_frame().to_dict(),
                        gw.sweep(SINGLE, {"forces.propulsion_N": "4:0.5:6"}, trials=20, csv=folder / "s.csv", figure=folder / "s.pdf"),
                        gw.trace(SINGLE, csv=folder / "t.csv", figure=folder / "t.png"), gw.predict(FIELD, accuracy=0.2, start="1.5,0,15.25")]
                matrix.export(folder / "chain.tra")
                for ending in (".mtx", ".csv"):
                    matrix.export(folder / f"gate{ending}", gate=True)
                files = {f.name: re.sub(rb"/CreationDate[^\n]*|gatewalk-[\w-]+\.nc", b"", f.read_bytes()) for f in folder.iterdir()}
                shutil.rmtree(folder)
                return [plain(one) for one in said], files

            here, before = written(), locale.setlocale(locale.LC_ALL)
            os.environ["LOCPATH"] = str(locales)
            try:
                locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
                self.assertEqual(locale.str(0.5), "0,5")
                there = written()
            finally:
                del os.environ["LOCPATH"]
                locale.setlocale(locale.LC_ALL, before)
            self.assertGreater(len(here[1]), 8)
            self.assertEqual(here, there)

    def test_forked_processes(self):
        matrix = gw.build(FIELD, bins="paper", trials=5)
        child = os.fork()
        if child == 0:
            os._exit(0 if gw.gate(FIELD, trials=1).trials == 1 else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        child = os.fork()
        if child == 0:
            atexit._run_exitfuncs()
            os._exit(0)
        os.waitpid(child, 0)
        self.assertEqual(len(matrix.predict().starts), 1)

    def test_import_is_light(self):
        code = ("import sys, time, numpy\nbegin = time.monotonic()\nimport gatewalk\ntook = time.monotonic() - begin\n"
                "assert not {'pandas', 'xarray', 'matplotlib', 'scipy'} & set(sys.modules), sys.modules.keys()\nassert took < 1.0, took\n")
        subprocess.run([sys.executable, "-c", code], check=True)

    def test_help_and_examples(self):
        self.assertIn("--gate-runs", gw.options("predict"))
        import gatewalk._cell
        import gatewalk._matrix
        import gatewalk._results
        import gatewalk._scene
        for module in (gw, gatewalk._scene, gatewalk._cell, gatewalk._matrix, gatewalk._results):
            self.assertEqual(doctest.testmod(module).failed, 0, module)

    def test_stubs(self):
        try:
            import mypy  # noqa: F401
        except ImportError:
            self.skipTest("mypy is not installed")
        with tempfile.TemporaryDirectory() as folder:
            allow = Path(folder) / "allow"
            allow.write_text("gatewalk._core.Matrix\n")  # pybind11's metaclass, which only some versions of mypy mind
            alone = Path(folder) / "alone.ini"  # the stub names nothing of the package's other modules, nor of numpy
            alone.write_text("[mypy]\n[mypy-gatewalk,numpy.*]\nfollow_imports = skip\nfollow_imports_for_stubs = True\n")
            for words in (["mypy.stubtest", "gatewalk._core", "--allowlist", str(allow), "--ignore-unused-allowlist",
                           "--mypy-config-file", str(alone)],
                          ["mypy", "--strict", "--ignore-missing-imports", "--cache-dir", folder, str(Path(gw.__file__).parent)]):
                done = subprocess.run([sys.executable, "-m", *words], cwd=folder, capture_output=True, text=True, check=False,
                                      env={**os.environ, "MYPYPATH": os.environ["PYTHONPATH"]})
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
