# SPDX-License-Identifier: MIT
"""What a Python user without gatewalk does with its files: scipy, xarray, h5py."""
import csv

import h5py
import numpy as np
import scipy.io
import scipy.sparse as sp
import scipy.sparse.linalg
import xarray

P = sp.load_npz("field.npz")
assert (P != scipy.io.mmread("field.mtx").tocsr()).nnz == 0
states = list(csv.DictReader(open("field.states.csv")))
number = {s["name"]: int(s["number"]) for s in states}
Q = sp.lil_matrix(P.shape)
for line in csv.DictReader(open("field.csv")):
    Q[number[line["from"]], number[line["to"]]] = float(line["probability"])
assert (P != Q.tocsr()).nnz == 0
ends = [int(s["number"]) for s in states if s["ending"]]
inside = [int(s["number"]) for s in states if not s["ending"]]
absorbed = sp.linalg.spsolve(sp.identity(len(inside), format="csc") - P[inside][:, inside].tocsc(), P[inside][:, ends].tocsc())
for k, end in enumerate(ends):
    print("absorbed", states[end]["ending"], repr(float(absorbed[0, k])))

with h5py.File("p.nc") as f:
    n = f["trials"].size
    counts = sp.csr_matrix((f["count"][:], (f["count_row"][:], f["count_column"][:])), (n, n + 1))
    print("counts", counts.sum())
    print("name", b"".join(f["state_name"][2]).decode().strip())
    assert (counts.sum(axis=1).A1 == f["trials"][:]).all()

# The file says itself what its codes mean, and its runs have one dimension.
tree = xarray.open_dataset("tree.nc")
words = tree.run_ending.flag_meanings.split()
assert list(tree.run_ending.flag_values) == list(range(len(words))) and words[3] == "trapped", words
assert tree.run_ending.dims == tree.run_d.dims == ("run",) and tree.trial_runs.dims == ("trial",)
assert int(tree.trial_runs.sum()) == tree.sizes["run"]
assert "mirror image" in tree.comment
assert (tree.state_d_low <= tree.state_d_high).all()

# Trajectories of trials: as many steps as runs, and what trapped them is the number of states.
trials = np.load("trials.dtrajs.npz")
assert len(trials.files) == tree.sizes["trial"] and sum(len(trials[k]) - 1 for k in trials.files) == tree.sizes["run"]
last = [int(trials[k][-1]) for k in trials.files]
assert max(last) == tree.sizes["input_state"]
assert last.count(tree.sizes["input_state"]) == int((tree.run_ending == words.index("trapped")).sum())
