#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes DIR/summary.csv from DIR/own_trials.csv: how often chains are said to err, by how wrong they are."""
import csv, sys
from collections import defaultdict
from pathlib import Path

OUT = Path(sys.argv[1])
ERRORS = [0.02, 0.04, 0.06, 0.1, 1.0]  # classes of total variation from the truth
found, of = defaultdict(int), defaultdict(int)
for row in csv.DictReader((OUT / "own_trials.csv").open()):
    error = float(row["error"])
    # A chain as it should be may err by as much as was asked for; one that was broken counts by what it errs.
    classes = ["all"] + [f"{a:g} to {b:g}" for a, b in zip([0.0] + ERRORS, ERRORS) if a < error <= b]
    for key in classes if row["how"] != "right" else ["all"]:
        for accuracy in (row["accuracy"], "both"):
            found[row["how"], key, accuracy] += int(row["differs"])
            of[row["how"], key, accuracy] += 1
            if row["how"] != "right":
                found["any", key, accuracy] += int(row["differs"])
                of["any", key, accuracy] += 1
with open(OUT / "summary.csv", "w", newline="") as file:
    table = csv.writer(file)
    table.writerow(["how", "error", "accuracy", "chains", "said_to_err_percent"])
    for key in sorted(of):
        table.writerow([*key, of[key], f"{100 * found[key] / of[key]:.1f}"])
