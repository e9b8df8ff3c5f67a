#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes DIR/summary.csv from DIR/assumptions.csv: by kind of fault and error, how often an assumption is said to be
wrong, how often the right one, how often the chain's own trials show the fault, and how often either does."""
import csv, sys
from collections import defaultdict
from pathlib import Path

OUT = Path(sys.argv[1])
ERRORS = [0.0, 0.02, 0.03, 0.04, 0.06, 1.0]  # classes of total variation from the truth
CAUSES = {"mirror": {"mirror"}, "states": {"states"}, "traps": {"face_before"}, "keeps": {"face_before"},
          "types": {"quarters", "cells"}, "right": set()}
table = defaultdict(list)
for row in csv.DictReader((OUT / "assumptions.csv").open()):
    how, error = row["how"], float(row["error"])
    for low, high in zip(ERRORS, ERRORS[1:]):
        if how != "right" and low < error <= high:
            table[how, f"{low:g} to {high:g}"].append(row)
    if how == "right" or 0.02 < error <= 0.06:
        table[how, "all" if how == "right" else "0.02 to 0.06"].append(row)
        if how != "right":
            table["any fault", "0.02 to 0.06"].append(row)
with open(OUT / "summary.csv", "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(["how", "error", "chains", "found", "cause_right", "own_trials", "by_either"])
    for key in sorted(table):
        rows = table[key]
        found = [r for r in rows if r["wrong"] != "none"]
        right = [r for r in found if r["wrong"] in CAUSES[r["how"]]]
        own = [r for r in rows if 0.0 <= float(r["own_p"]) <= 0.01]
        out.writerow([*key, len(rows), len(found), len(right), len(own), sum(r in found or r in own for r in rows)])
