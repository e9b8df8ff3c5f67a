#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""As study.py, for experiments that measured when bodies left the field: times.py GATEWALK SCENE EXPERIMENTS TRIALS

Push and drag are drawn uniformly from their ranges; 60 bodies make the experiment, a line for each with its ending and time.
Prints how often 95 % intervals hold the truth, whether its ranks in the posteriors are uniform (simulation-based calibration),
and how much wider the intervals are without the times.
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
RANGES = {"forces.propulsion_N": (10, 16), "forces.drag_Ns_per_m": (0.06, 0.24)}
FIELD = [scene, "--set", "run.method=moreau", "--set", "field.rows=4", "--threads", "1", "--quiet", "--force"]
BODIES = 60


def run(*words: str) -> None:
    subprocess.run([gatewalk, *words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def one(number: int) -> dict:
    chance = random.Random(number)
    truth = {key: chance.uniform(*ends) for key, ends in RANGES.items()}
    answers = {}
    with tempfile.TemporaryDirectory() as folder:
        path = lambda name: os.path.join(folder, name)  # noqa: E731
        run("trace", *FIELD, *(f"--set={key}={value}" for key, value in truth.items()), "--field", "--trials", str(BODIES), "--seed",
            str(1_000_000 + number), "--json", path("truth.json"))
        runs = json.load(open(path("truth.json")))["runs"]
        for timed in (True, False):
            with open(path("lines.csv"), "w") as file:
                file.write("trial,ending,time_s\n" if timed else "trial,ending\n")
                for r in runs:
                    time = "" if r["ending"] in ("trapped", "cut off") else r["t"][-1]
                    file.write(f"{r['trial']},{r['ending']}" + (f",{time}" if timed else "") + "\n")
            run("fit", *FIELD, path("lines.csv"), *(f"--free={key}={low}:{high}" for key, (low, high) in RANGES.items()), "--trials",
                trials, "--seed", str(number), "--json", path("fit.json"), "--draws", path("draws.csv"))
            draws = list(csv.DictReader(open(path("draws.csv"))))
            for n in json.load(open(path("fit.json")))["numbers"]:
                low, high = n["median_95"]
                key, value = n["key"], truth[n["key"]]
                answers[key, timed] = (low <= value <= high, high - low, sum(float(d[key]) < value for d in draws) / len(draws))
    return answers


with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    answers = list(pool.map(one, range(1, experiments + 1)))
for key in RANGES:
    of = {timed: [a[key, timed] for a in answers] for timed in (True, False)}
    wider = statistics.median(without[1] / with_times[1] for with_times, without in zip(of[True], of[False]))
    print(f"{key}: 95 % intervals hold in {100 * sum(a[0] for a in of[True]) / experiments:.1f} % of {experiments}; "
          f"ranks are uniform, p = {kstest([a[2] for a in of[True]], 'uniform').pvalue:.3f}; "
          f"without the times they are {wider:.1f} times as wide (median), and hold in "
          f"{100 * sum(a[0] for a in of[False]) / experiments:.1f} %")
