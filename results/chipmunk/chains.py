#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Chains and their predictions: chains.py GATEWALK PROGRAM DIR [KIND...]

Writes DIR/chain.csv, a line per kind of pool, seed and start: endings with their 95 % intervals, the bar of the
final gates, and the final gates; and DIR/cost.csv, what each command took. A pool is of full trials from the start
of cell.toml; each of the starts has some first runs on top. Lines of kinds that are not named stay.
"""
import csv, json, sys, tempfile
from pathlib import Path

from common import ENDINGS, FIELD, GATES, STARTS, cpu_of, key_of

gatewalk, program, folder = sys.argv[1], sys.argv[2], Path(sys.argv[3])
cell = folder / "cell.toml"
FIRST_RUNS = 100
# Seeds, starts and what the pool's size is chosen by: an error bar, or not by what it shows.
POOLS = {
    "pool": ((1, 2, 3), 300, ("--accuracy", 0.02)),
    "coarse pool": ((1, 2, 3), 300, ("--accuracy", 0.05)),
    "more pools": (range(4, 10), 40, ("--accuracy", 0.05)),
    "pools of 5000": (range(4, 10), 40, ("--accuracy", 0.001, "--gate-runs", 5000)),
}
CHAINS = {"chain, Chipmunk": [cell, "--cell-program", program], "chain, ours": [FIELD]}
HEADS = {"chain.csv": ["what", "seed", "start", *(e + x for e in ENDINGS for x in ("", "_low", "_high")),
                       "error_95", "unseen", "answer_from", *GATES],
         "cost.csv": ["what", "step", "seed", "runs", "cpu_s"]}
kinds = sys.argv[4:] or [*POOLS, *CHAINS]


def kept(name):
    path = folder / name
    if not path.exists():
        return []
    return [r for r in list(csv.reader(path.open()))[1:] if r[0] not in kinds]


costs, rows = kept("cost.csv"), kept("chain.csv")


def ask(what, step, seed, *words):
    """The answer of a command that prints JSON; its cost is kept."""
    with tempfile.TemporaryDirectory() as where:
        out = Path(where) / "out.json"
        cpu = cpu_of([gatewalk, *words, "--seed", seed, "--json", out, "--threads", 2, "--quiet", "--force"])
        j = json.loads(out.read_text())
    runs = j["gate_runs"] if "gate_runs" in j else j["state_space"]["gate_runs"]
    costs.append([what, step, seed, runs, round(cpu, 2)])
    return j


def row(what, seed, start, a):
    values = [*(x for e in ENDINGS for x in (a["endings"][e], *a["endings_95"][e])), a["error_95"], a["unseen_entries"]]
    rows.append([what, seed, start, *(f"{x:.5g}" for x in values), a["answer_from"],
                 *(f"{x:.5g}" for line in a["final_gates"] for x in line)])


for what in kinds:
    if what in CHAINS:
        row(what, 1, "", ask(what, "all", 1, "predict", *CHAINS[what], "--accuracy", 0.03))
        continue
    seeds, count, size = POOLS[what]
    for seed in seeds:
        with tempfile.TemporaryDirectory() as where:
            matrix = Path(where) / "chain.nc"
            ask(what, "pool", seed, "build", cell, "--cell-program", program, *size, "-o", matrix)
            j = ask(what, "starts", seed, "predict", matrix, "--cell-program", program, "--first-runs", FIRST_RUNS,
                    *(f"--start={','.join(map(str, s))}" for s in STARTS[:count]))
        for s, a in zip(STARTS, j["starts"]):
            row(what, seed, key_of(s), a)
for name, lines in ("chain.csv", rows), ("cost.csv", costs):
    with open(folder / name, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(HEADS[name])
        table.writerows(sorted(lines, key=lambda r: [*POOLS, *CHAINS].index(r[0])))
