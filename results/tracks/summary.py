#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Says how often bars held: python3 summary.py DIR, with the files of run.sh in it.
Writes coverage.csv and prints the page's table."""
import csv, json, math, sys
from pathlib import Path

DIR = Path(sys.argv[1])
NAMES = ["crossed", "left_side", "right_side", "trapped", "cut_off", "went_back"]


def share(part, whole):
    """In %, with its 95 % interval (Wilson's)."""
    p, z = part / whole, 1.96
    middle = (p + z * z / (2 * whole)) / (1 + z * z / whole)
    half = z * math.sqrt(p * (1 - p) / whole + z * z / (4 * whole * whole)) / (1 + z * z / whole)
    return f"{100 * p:.1f} [{100 * (middle - half):.1f}, {100 * (middle + half):.1f}]"


truth = json.loads((DIR / "truth.json").read_text())
films = [{k: float(v) for k, v in row.items()} for row in csv.DictReader((DIR / "many.csv").open())]
n = len(films)
prediction = json.loads((DIR / "predict.json").read_text())
validation = json.loads((DIR / "validate.json").read_text())

print(f"One film: 200 bodies, {prediction['recorded']['trials']} trials, {prediction['recorded']['passages']} passages, of "
      f"which {prediction['recorded']['lost']} were lost from sight.\n")
print("| ending | truth, % | predicted, % | off, points |\n|---|---|---|---|")
for e in NAMES:
    low, high = prediction["endings_95"][e]
    print(f"| {e.replace('_', ' ')} | {100 * truth[e]:.2f} | {100 * prediction['endings'][e]:.2f} "
          f"[{100 * low:.2f}, {100 * high:.2f}] | {100 * (prediction['endings'][e] - truth[e]):+.2f} |")
print(f"\nvalidate: {validation['verdict']}. Memory: {validation['memory']['verdict']}.\n")

rows = []
for e in NAMES:
    held = sum(f[e + "_low"] <= truth[e] <= f[e + "_high"] for f in films)
    halves = sum(abs(f[f"seen{h}_{e}"] - f[f"chain{h}_{e}"]) <= f[f"chance{h}_{e}"] for f in films for h in (1, 2))
    mean = sum(f[e] for f in films) / n
    rows.append((e, held, halves, mean))
with (DIR / "coverage.csv").open("w") as out:
    print("ending,films,bars_hold_truth,halves,bars_hold_other_half,mean_prediction,truth", file=out)
    for e, held, halves, mean in rows:
        print(e, n, held, 2 * n, halves, f"{mean:.5f}", truth[e], sep=",", file=out)
print(f"{n} films of 200 bodies each, two halves of each:\n")
print("| ending | intervals that hold the truth, % of films | intervals from one half that hold the share of the other half, % of halves | mean prediction less truth, points |"
      "\n|---|---|---|---|")
for e, held, halves, mean in rows:
    print(f"| {e.replace('_', ' ')} | {share(held, n)} | {share(halves, 2 * n)} | {100 * (mean - truth[e]):+.2f} |")
k = len(rows)
print(f"| all | {share(sum(r[1] for r in rows), k * n)} | {share(sum(r[2] for r in rows), 2 * k * n)} | |")
tv = sum(f[f"tv{h}"] <= f[f"tv{h}_95"] for f in films for h in (1, 2))
print(f"| total variation of final gates | | {share(tv, 2 * n)} | |")
print(f"\nFalse alarms at 5 %: the halves {share(sum(f['p_halves'] <= 0.05 for f in films), n)} %, memory "
      f"{share(sum(f['p_memory'] <= 0.05 for f in films), n)} %.")

turning = json.loads((DIR / "turning_truth.json").read_text())
by_noise = {mm: [{k: float(v) for k, v in row.items()} for row in csv.DictReader((DIR / f"turning_{mm}.csv").open())]
            for mm in (1, 2, 3, 4)}
print(f"\nBodies that turn round at borders, {len(by_noise[1])} films for each noise; went back in truth: "
      f"{100 * turning['went_back']:.1f} %\n")
print("| noise of places, mm | went back, mean prediction less truth, points | intervals that hold, % | of all endings, % |"
      "\n|---|---|---|---|")
for mm, films in by_noise.items():
    holds = {e: sum(f[e + "_low"] <= turning[e] <= f[e + "_high"] for f in films) for e in NAMES}
    mean = sum(f["went_back"] for f in films) / len(films)
    print(f"| {mm} | {100 * (mean - turning['went_back']):+.1f} | {share(holds['went_back'], len(films))} "
          f"| {share(sum(holds.values()), len(NAMES) * len(films))} |")
