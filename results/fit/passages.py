#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""As study.py, for experiments that recorded passages through gates: passages.py GATEWALK SCENE EXPERIMENTS TRIALS

Push and noise are drawn uniformly from their ranges; 30 bodies make the experiment, whose passages are in runs.csv. Prints how
often 95 % intervals hold the truth, whether its ranks in the posteriors are uniform (simulation-based calibration), and how much
wider the intervals are if only final gates were counted.
"""
import concurrent.futures
import csv
import json
import os
import random
import statistics
import subprocess
import sys
import tempfile

from scipy.stats import kstest

gatewalk, scene, experiments, trials = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4]
RANGES = {"forces.propulsion_N": (5, 9), "forces.random_N": (10, 60)}
FIELD = [scene, "--set", "run.method=moreau", "--set", "field.rows=4", "--threads", "1", "--quiet", "--force"]
BODIES = 30


def run(*words: str) -> None:
    subprocess.run([gatewalk, *words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def one(number: int) -> dict:
    chance = random.Random(number)
    truth = {key: chance.uniform(*ends) for key, ends in RANGES.items()}
    answers = {}
    with tempfile.TemporaryDirectory() as folder:
        path = lambda name: os.path.join(folder, name)  # noqa: E731
        run("lattice", *FIELD, *(f"--set={key}={value}" for key, value in truth.items()), "--trials", str(BODIES), "--seed",
            str(1_000_000 + number), "--json", path("truth.json"), "--passages", path("runs.csv"), "--cell-file", path("cell.toml"))
        with open(path("gates.csv"), "w") as file:
            file.write("gate_x,gate_y,count\n")
            for y, row in enumerate(json.load(open(path("truth.json")))["final_gates"]):
                for x, count in enumerate(row):
                    file.write(f"{x - 4},{y},{count}\n")
        for table in ("runs.csv", "gates.csv"):
            run("fit", *FIELD, path(table), *(f"--free={key}={low}:{high}" for key, (low, high) in RANGES.items()), "--trials",
                trials, "--seed", str(number), "--json", path("fit.json"), "--draws", path("draws.csv"))
            draws = list(csv.DictReader(open(path("draws.csv"))))
            fit = json.load(open(path("fit.json")))
            for n in fit["numbers"]:
                low, high = n["median_95"]
                key, value = n["key"], truth[n["key"]]
                answers[key, table] = (low <= value <= high, high - low, sum(float(d[key]) < value for d in draws) / len(draws))
            answers["p", table] = fit["p"]
    return answers


with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    answers = list(pool.map(one, range(1, experiments + 1)))
for key in RANGES:
    passages, gates = ([a[key, table] for a in answers] for table in ("runs.csv", "gates.csv"))
    wider = statistics.median(g[1] / p[1] for p, g in zip(passages, gates))
    print(f"{key}: 95 % intervals hold in {100 * sum(p[0] for p in passages) / experiments:.1f} % of {experiments}; "
          f"ranks are uniform, p = {kstest([p[2] for p in passages], 'uniform').pvalue:.3f}; "
          f"by final gates alone they are {wider:.1f} times as wide (median)")
print(f"p of the experiments below 0.05: {sum(a['p', 'runs.csv'] < 0.05 for a in answers)}")
