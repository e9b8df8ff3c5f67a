#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""As study.py, for posteriors with several modes: modes.py GATEWALK EXPERIMENTS TRIALS OUT

Both stiffnesses are drawn uniformly from 50 to 900 Nm/rad; 80 bodies make the experiment. A third of the experiments count final
gates in a field that is its own mirror image, from a start in its middle: left and right may be exchanged, so that the posterior
has two equal modes. A third count endings from a start 3 m off the middle, of which some have two modes. A third have push and
noise drawn instead, and one mode. OUT/modes.csv has a line for each number of each experiment; `left_below_right` is the share of
draws in one of the two halves that are mirror images. Prints how often 95 % intervals hold the truth, and whether its ranks are uniform.
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

gatewalk, experiments, trials, out = sys.argv[1], int(sys.argv[2]), sys.argv[3], sys.argv[4]
SCENE = """[forces]
propulsion_N = 7.0
random_N = 4.0
[run]
method = "moreau"
[field]
columns = 1
rows = {rows}
max_gates = 0
[start]
x_m = {x}
vy_m_per_s = 14.0
"""
STIFFNESSES = {"beams.stiffness_left_Nm_per_rad": (50, 900), "beams.stiffness_right_Nm_per_rad": (50, 900)}
# Rows, where bodies start, whether gates are counted (else endings), what is free.
KINDS = {"mirrored": (4, 0.0, True, STIFFNESSES), "off the middle": (2, 3.0, False, STIFFNESSES),
         "one mode": (4, 0.0, True, {"forces.propulsion_N": (5, 9), "forces.random_N": (10, 40)})}
BODIES = 80


def run(*words: str) -> None:
    subprocess.run([gatewalk, *words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def one(number: int) -> list:
    kind = list(KINDS)[number % len(KINDS)]
    rows, x, of_gates, ranges = KINDS[kind]
    chance = random.Random(number)
    truth = {key: chance.uniform(*ends) for key, ends in ranges.items()}
    with tempfile.TemporaryDirectory() as folder:
        path = lambda name: os.path.join(folder, name)  # noqa: E731
        with open(path("scene.toml"), "w") as file:
            file.write(SCENE.format(rows=rows, x=x))
        field = [path("scene.toml"), "--threads", "1", "--quiet", "--force"]
        run("lattice", *field, *(f"--set={key}={value}" for key, value in truth.items()), "--trials", str(BODIES), "--seed",
            str(1_000_000 + number), "--json", path("truth.json"))
        seen = json.load(open(path("truth.json")))
        with open(path("counts.csv"), "w") as file:
            if of_gates:
                file.write("gate_x,gate_y,count\n")
                file.writelines(f"0,{y},{row[0]}\n" for y, row in enumerate(seen["final_gates"]))
            else:
                file.write("ending,count\n")
                file.writelines(f"{ending},{n}\n" for ending, n in seen["endings"].items() if ending != "broken")
        try:
            run("fit", *field, path("counts.csv"), *(f"--free={key}={low}:{high}" for key, (low, high) in ranges.items()), "--trials",
                trials, "--seed", str(number), "--json", path("fit.json"), "--draws", path("draws.csv"))
        except subprocess.CalledProcessError:
            return []  # nearly all end alike, which fit refuses
        fit = json.load(open(path("fit.json")))
        draws = list(csv.DictReader(open(path("draws.csv"))))
    first, second = ranges
    half = sum(float(d[first]) < float(d[second]) for d in draws) / len(draws)
    lines = []
    for n in fit["numbers"]:
        key = n["key"]
        below = sum(float(d[key]) < truth[key] for d in draws) / len(draws)
        lines.append([number, kind, key, truth[key], n["median"], *n["median_95"], below, half, fit["p"], int(fit["settled"]),
                      fit["outside"], fit["seconds"]])
    return lines


with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    all_lines = list(pool.map(one, range(experiments)))
lines = [line for of_experiment in all_lines for line in of_experiment]
with open(os.path.join(out, "modes.csv"), "w") as file:
    file.write("experiment,kind,number,truth,median,low_95,high_95,below,left_below_right,p,settled,outside,seconds\n")
    file.writelines(",".join(f"{v:.6g}" if isinstance(v, float) else str(v) for v in line) + "\n" for line in lines)
for kind, (_, _, _, ranges) in KINDS.items():
    for key in ranges:
        these = [line for line in lines if line[1:3] == [kind, key]]
        held = [low <= truth <= high for _, _, _, truth, _, low, high, *_ in these]
        settled = [h for h, line in zip(held, these) if line[10]]
        print(f"{kind}, {key}: 95 % intervals hold in {100 * sum(held) / len(held):.1f} % of {len(held)}, "
              f"in {sum(settled)} of {len(settled)} that are settled; "
              f"ranks are uniform, p = {kstest([line[7] for line in these], 'uniform').pvalue:.3f}")
mirrored = [of_experiment for of_experiment in all_lines if of_experiment and of_experiment[0][1] == "mirrored"]
both = [min(of[0][8], 1 - of[0][8]) for of in mirrored]
apart = [max(abs(of[0][k] - of[1][k]) for k in (5, 6)) / 850 for of in mirrored]
print(f"mirrored: the lesser of two equal modes has {100 * statistics.median(both):.0f} % of the draws (median), less than 10 % in "
      f"{sum(b < 0.1 for b in both)} of {len(both)}; ends of the two intervals, which are the same, differ by "
      f"{100 * statistics.median(apart):.1f} % of the range (median)")
print(f"refused, as nearly all end alike: {sum(not of for of in all_lines)} of {experiments}")
