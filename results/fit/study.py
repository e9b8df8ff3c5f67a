#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Made-up experiments, whose numbers are known, and what gatewalk fit says of them: study.py GATEWALK SCENE EXPERIMENTS TRIALS OUT

Numbers are drawn uniformly from their ranges; 200 bodies make the experiment. OUT/experiments.csv has a line for each number of
each experiment: the truth, median and 95 % interval of its posterior, the share of the posterior below the truth (uniform
where posteriors are right: Talts et al. 2018, simulation-based calibration), p of the experiment. Prints how often intervals
hold the truth, and p of chi-squared that the shares are uniform.
"""
import concurrent.futures
import csv
import json
import math
import os
import random
import subprocess
import sys
import tempfile

gatewalk, scene, experiments, trials, out = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4], sys.argv[5]
RANGES = {"forces.propulsion_N": (5, 9), "forces.random_N": (10, 40), "beams.stiffness_left_Nm_per_rad": (300, 500),
          "beams.stiffness_right_Nm_per_rad": (300, 500)}
FIELD = [scene, "--set", "run.method=moreau", "--set", "field.rows=4", "--threads", "1", "--quiet", "--force"]
BODIES, BINS = 200, 15


def run(*words: str) -> None:
    subprocess.run([gatewalk, *words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def one(number: int) -> list:
    chance = random.Random(number)
    truth = {key: chance.uniform(*ends) for key, ends in RANGES.items()}
    with tempfile.TemporaryDirectory() as folder:
        path = lambda name: os.path.join(folder, name)  # noqa: E731
        run("lattice", *FIELD, *(f"--set={key}={value}" for key, value in truth.items()), "--trials", str(BODIES), "--seed",
            str(1_000_000 + number), "--json", path("truth.json"))
        gates = json.load(open(path("truth.json")))["final_gates"]
        with open(path("counts.csv"), "w") as file:
            file.write("gate_x,gate_y,count\n")
            file.writelines(f"{x - len(row) // 2},{y},{n}\n" for y, row in enumerate(gates) for x, n in enumerate(row))
        run("fit", *FIELD, path("counts.csv"), *(f"--free={key}={low}:{high}" for key, (low, high) in RANGES.items()), "--trials",
            trials, "--seed", str(number), "--json", path("fit.json"), "--draws", path("draws.csv"))
        fit = json.load(open(path("fit.json")))
        draws = list(csv.DictReader(open(path("draws.csv"))))
    rows = []
    for n in fit["numbers"]:
        key = n["key"]
        below = sum(float(d[key]) < truth[key] for d in draws) / len(draws)
        rows.append([number, key, truth[key], n["median"], *n["median_95"], below, fit["p"], int(fit["settled"]), fit["seconds"]])
    return rows


def chi_squared_p(value: float, degrees: int) -> float:
    """The chance of more, by the series of the incomplete gamma function."""
    a, x = degrees / 2, value / 2
    term = total = 1 / a
    k = a
    while term > 1e-15 * total:
        k += 1
        term *= x / k
        total += term
    return 1 - total * math.exp(-x + a * math.log(x) - math.lgamma(a))


with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    rows = [row for rows in pool.map(one, range(1, experiments + 1)) for row in rows]
with open(os.path.join(out, "experiments.csv"), "w") as file:
    file.write("experiment,number,truth,median,low_95,high_95,below,p,settled,seconds\n")
    file.writelines(",".join(f"{v:.6g}" if isinstance(v, float) else str(v) for v in row) + "\n" for row in rows)
for key in RANGES:
    of_key = [row for row in rows if row[1] == key]
    inside = sum(low <= truth <= high for _, _, truth, _, low, high, *_ in of_key)
    bins = [0] * BINS
    for row in of_key:
        bins[min(BINS - 1, int(BINS * row[6]))] += 1
    expected = len(of_key) / BINS
    p = chi_squared_p(sum((n - expected) ** 2 / expected for n in bins), BINS - 1)
    print(f"{key}: 95 % intervals hold in {100 * inside / len(of_key):.1f} % of {len(of_key)}; ranks are uniform, p = {p:.3f}")
last = [row for row in rows if row[1] == key]
print(f"settled: {sum(row[8] for row in last)} of {len(last)}; p of the experiments below 0.05: {sum(row[7] < 0.05 for row in last)}")
