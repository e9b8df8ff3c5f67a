# SPDX-License-Identifier: MIT
"""chain_scipy.py FOLDER: the work of chain_bench by numpy and scipy, one thread.

FOLDER is what chain_bench wrote. Prints task,tool,field,seconds,walks,difference,floor: the best of
several rounds; `difference` from chain_bench's answer, the largest absolute one (walks: total variation,
beside the `floor` that chance alone gives).
"""
import math
import os
import sys
import time

for library in ("OMP", "OPENBLAS", "MKL"):
    os.environ[library + "_NUM_THREADS"] = "1"
import numpy as np
import scipy.io
import scipy.sparse as sp
import scipy.sparse.csgraph
import scipy.sparse.linalg

GATES = 13
WALKS = 100_000
SIDE = 9
CELLS = SIDE * SIDE


def best(work, rounds):
    """Least seconds of some rounds, and the answer."""
    least = math.inf
    for _ in range(rounds):
        begin = time.perf_counter()
        answer = work()
        least = min(least, time.perf_counter() - begin)
    return least, answer


def by_cell(p, inputs):
    """Mass that still walks, trapped and that left the field, by cell."""
    walking = p[: CELLS * inputs].reshape(CELLS, inputs).sum(axis=1)
    return walking, p[CELLS * inputs :][:CELLS], p[CELLS * (inputs + 1) :]


def after_13_gates(onward, p0, inputs):
    p = p0
    for _ in range(GATES - 1):
        p = onward @ p
    walking, trapped, left = by_cell(p, inputs)
    final = walking + trapped + left  # whoever would leave the 13th gate is cut off in it
    walking, trapped, left = by_cell(onward @ p, inputs)
    return np.concatenate([final, [trapped.sum(), left.sum(), walking.sum()]])


def ends(trapped, left):
    return np.concatenate([trapped + left, [trapped.sum(), left.sum(), 0.0]])


def neumann(onward, p0, inputs):
    n = CELLS * inputs
    p = p0
    while p[:n].sum() > 1e-13:
        p = onward @ p
    _, trapped, left = by_cell(p, inputs)
    return ends(trapped, left)


def solve(system, ending, start):
    visits = scipy.sparse.linalg.spsolve(system, start)
    final = ending @ visits
    return ends(final[:CELLS], final[CELLS:])


def final_cells_of_walks(kernel, exits, start, rng):
    """All walkers at once. One search in the cumulated rows, row r shifted by r, draws for all."""
    rows = np.repeat(np.arange(kernel.shape[0]), np.diff(kernel.indptr))
    sums = np.concatenate([[0.0], np.cumsum(kernel.data)])
    cumulated = sums[1:] - sums[kernel.indptr[rows]]
    cumulated[kernel.indptr[1:] - 1] = 1.0
    cumulated += rows
    next_input, di_x, di_y = (exits[kernel.indices, k] for k in range(3))
    final = np.zeros(CELLS, dtype=np.int64)
    column, row, state = (np.full(WALKS, v) for v in (SIDE // 2, 0, start))
    for _ in range(GATES):
        slot = np.searchsorted(cumulated, state + rng.random(len(state)), side="right")
        to_column, to_row = column + di_x[slot], row + di_y[slot]
        on = (next_input[slot] >= 0) & (to_column >= 0) & (to_column < SIDE) & (to_row >= 0) & (to_row < SIDE)
        final += np.bincount((row * SIDE + column)[~on], minlength=CELLS)
        last = (row * SIDE + column)[on]
        column, row, state = to_column[on], to_row[on], next_input[slot][on]
    return final + np.bincount(last, minlength=CELLS)


def main(folder):
    global_chain = scipy.io.mmread(f"{folder}/chain_{SIDE}.mtx").tocsr()
    kernel = scipy.io.mmread(f"{folder}/kernel.mtx").tocsr()
    exits = np.loadtxt(f"{folder}/exits.csv", delimiter=",", dtype=np.int64)
    start = int(np.loadtxt(f"{folder}/start.txt"))
    limited = np.loadtxt(f"{folder}/limited_{SIDE}.txt")
    unlimited = np.loadtxt(f"{folder}/unlimited_{SIDE}.txt")
    inputs = kernel.shape[0]
    n = CELLS * inputs
    p0 = np.zeros(global_chain.shape[0])
    p0[SIDE // 2 * inputs + start] = 1.0
    onward = global_chain.T.tocsr()
    reached = sp.csgraph.breadth_first_order(global_chain, p0.argmax(), return_predecessors=False)
    reached = np.sort(reached[reached < n])  # a smaller system
    system = (sp.identity(len(reached)) - global_chain[reached][:, reached].T).tocsc()
    ending = global_chain[reached][:, n:].T.tocsr()

    def line(task, tool, seconds, answer, truth):
        print(f"{task},{tool},9x9,{seconds:.6g},,{np.abs(answer - truth).max():.3g},")

    line("13 gates", "scipy CSR", *best(lambda: after_13_gates(onward, p0, inputs), 100), limited)
    line("no limit", "scipy Neumann sum", *best(lambda: neumann(onward, p0, inputs), 20), unlimited)
    line("no limit", "scipy spsolve", *best(lambda: solve(system, ending, p0[reached]), 3), unlimited)
    rng = np.random.default_rng(1)
    seconds, counts = best(lambda: final_cells_of_walks(kernel, exits, start, rng), 5)
    p = limited[:CELLS]
    difference = 0.5 * np.abs(counts / WALKS - p).sum()
    floor = 0.5 * np.sqrt(2 * p * (1 - p) / (math.pi * WALKS)).sum()
    print(f"walks,numpy all walkers at once,9x9,{seconds:.6g},{WALKS},{difference:.3g},{floor:.3g}")


main(sys.argv[1])
