#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Do two programs that know nothing of each other agree? second.py FOLDER SCENE..., run by second.sh.

Each comparison is a line: total variation of the two distributions, what chance alone would make it on
average (the floor), and p: how often chance would make a difference as large (chi^2, classes in which fewer
than ten are expected put together). Of predicted final gates, whose counts are not independent, the floor is
that of their standard errors, and there is no p.
"""
import csv, json, math, subprocess, sys
from pathlib import Path

import numpy as np
from scipy.stats import chi2

FOLDER = Path(sys.argv[1])
ROWS = COLUMNS = 9


def lines(name):
    with open(FOLDER / name) as file:
        return list(csv.DictReader(file))


def compared(a, b):
    """Chi^2 of homogeneity and its degrees of freedom; total variation and its floor."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    n, m = a.sum(), b.sum()
    share = (a + b) / (n + m)
    tv = 0.5 * np.abs(a / n - b / m).sum()
    floor = 0.5 * np.sqrt(2 / math.pi * share * (1 - share) * (1 / n + 1 / m)).sum()
    few = share * min(n, m) < 10
    if few.any():
        a, b = (np.append(x[~few], x[few].sum()) for x in (a, b))
    both = a + b
    a, b, both = a[both > 0], b[both > 0], both[both > 0]
    square = ((a - both * n / (n + m)) ** 2 / (both * n / (n + m))).sum() + \
             ((b - both * m / (n + m)) ** 2 / (both * m / (n + m))).sum()
    return square, len(a) - 1, tv, floor


def chance(square, freedom):
    return chi2.sf(square, freedom) if freedom > 0 else None


def gate(scene):
    ours = json.loads((FOLDER / f"{scene}.gate.json").read_text())
    ours = [ours["trapped"], ours["traversed"], ours["exited_left"], ours["exited_right"]]
    theirs = [0] * 4
    for line in lines(f"{scene}.gate.csv"):
        theirs[int(line["ending"])] = int(line["runs"])
    square, freedom, tv, floor = compared(theirs, ours)
    return "gate: endings", sum(theirs), sum(ours), tv, floor, chance(square, freedom)


def matrix(name):
    counts = np.zeros((87, 88))
    for line in lines(name):
        state = lambda s: 87 if s == "trapped" else int(s.split("_")[-1])
        if "runs" in line:
            counts[int(line["from"]) - 1, int(line["to"]) - 1] = int(line["runs"])
        else:
            counts[state(line["from"]), state(line["to"])] = int(line["count"])
    return counts


def chain(scene):
    theirs, ours = matrix(f"{scene}.chain.csv"), matrix(f"{scene}.ours.csv")
    rows = [compared(a, b) for a, b in zip(theirs, ours)]
    square, freedom, tv, floor = (sum(r[i] for r in rows) for i in range(4))
    return ("chain: 87 rows of the matrix (mean)", int(theirs.sum()), int(ours.sum()), tv / 87, floor / 87,
            chance(square, freedom))


def predicted(scene):
    """Second program's prediction from its own counts, the program's from its own."""
    theirs, error = np.zeros((ROWS, COLUMNS)), np.zeros((ROWS, COLUMNS))
    for line in lines(f"{scene}.predicted.csv"):
        theirs[int(line["row"]), int(line["column"])] = float(line["share"])
        error[int(line["row"]), int(line["column"])] = float(line["error"])
    ours = np.array(json.loads((FOLDER / f"{scene}.predicted.json").read_text())["final_gates"])
    again = np.zeros((ROWS, COLUMNS))
    for line in lines(f"{scene}.again.csv"):
        again[int(line["row"]), int(line["column"])] = float(line["share"])
    few, many = matrix(f"{scene}.chain.csv").sum(), matrix(f"{scene}.ours.csv").sum()
    floor = 0.5 * math.sqrt(2 / math.pi) * error.sum() * math.sqrt(1 + few / many)
    yield "chain: predicted final gates", int(few), int(many), 0.5 * np.abs(theirs - ours).sum(), floor, None
    off = 0.5 * np.abs(again - ours).sum()
    yield "chain: the same counts, predicted by both", int(many), int(many), off, 1e-12, None


def field(scene):
    report = json.loads((FOLDER / f"{scene}.field.json").read_text())
    ours = np.array(report["final_gates"]).ravel()
    theirs, endings = np.zeros((ROWS, COLUMNS)), np.zeros(5)
    for line in lines(f"{scene}.field.csv"):
        theirs[int(line["row"]), int(line["column"])] += int(line["trials"])
        endings[int(line["ending"])] += int(line["trials"])
    square, freedom, tv, floor = compared(theirs.ravel(), ours)
    yield "field: final gates", int(theirs.sum()), int(ours.sum()), tv, floor, chance(square, freedom)
    names = ["trapped", "crossed", "left_side", "right_side", "cut_off"]
    square, freedom, tv, floor = compared(endings, [report["endings"][e] for e in names])
    yield "field: endings", int(theirs.sum()), int(ours.sum()), tv, floor, chance(square, freedom)


table = csv.writer(sys.stdout, lineterminator="\n")
table.writerow(["scene", "compared", "second_runs", "runs", "total_variation", "floor", "p", "agree"])
agree = True
for scene in sys.argv[2:]:
    for what, few, many, tv, floor, p in [gate(scene), chain(scene), *predicted(scene), *field(scene)]:
        fine = bool(tv <= 2 * floor if p is None else p >= 0.001)
        agree = agree and fine
        table.writerow([scene, what, few, many, f"{tv:.2g}", f"{floor:.2g}", "" if p is None else f"{p:.2g}",
                        "yes" if fine else "NO"])
sys.exit(0 if agree else 1)
