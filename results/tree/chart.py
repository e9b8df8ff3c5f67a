#!/usr/bin/env python3
"""Draws tree.svg in DIR from the points.csv and summary.txt that study.py wrote there (gnuplot)."""
import csv, math, re, subprocess, sys
from collections import defaultdict
from pathlib import Path

OUT = Path(sys.argv[1])
TITLES = {"A": "A: 7 N, Rm 50 N (scenes/field.toml)", "B": "B: 8 N, Rm 10 N",
          "C": "C: 8.5 N, Rm 25 N, k 300 / 450"}
LABELS = "".join(
    f"set label '{text}' at graph {x},{y} tc rgb '{colour}'\n" for text, x, y, colour in (
        ("paper, 87 bins", 0.22, 0.87, "#cc6677"), ("direct simulation", 0.46, 0.46, "#777777"),
        ("tree, one start", 0.03, 0.14, "#332288"),
        ("tree, each of a hundred", 0.03, 0.06, "#117733")))


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def main():
    rows = list(csv.DictReader((OUT / "points.csv").open()))
    text = (OUT / "summary.txt").read_text()
    one = defaultdict(list)  # (scene, accuracy): error, seconds, seconds of direct simulation
    for m in re.finditer(r"^([ABC]) +\S+,\S+ +([\d.]+) +([\d.]+) +[\d.]+ +\d+ +([\d.]+) +([\d.]+) \(", text, re.M):
        scene, accuracy, error, seconds, ratio = m.group(1), *map(float, m.groups()[1:])
        one[scene, accuracy].append((error, seconds, ratio * seconds))
    many = defaultdict(list)  # scene: seconds of a hundredth of all, error
    for m in re.finditer(r"^([ABC]) +[\d.]+ +([\d.]+) +[\d.]+ +\d+ +([\d.]+) +\d+ +([\d.]+) +[\d.]+ \(", text, re.M):
        error, build, start = map(float, m.groups()[1:])
        many[m.group(1)].append((start + build / 100, error))
    paper = {m.group(1): [float(e) for e in re.findall(r"\d+: ([\d.]+)", m.group(2))]
             for m in re.finditer(r"^([ABC]): (10: .*)$", text, re.M)}
    plots, data = [], []
    for scene in TITLES:
        points = {a: p for (s, a), p in one.items() if s == scene}
        constant = math.exp(mean(math.log(d * e * e) for p in points.values() for e, _, d in p))
        tree = sorted((mean(s for _, s, _ in p), mean(e for e, _, _ in p)) for p in points.values())
        hundred = sorted(many[scene])
        seconds = defaultdict(list)
        for r in rows:
            if r["kind"] == "paper" and r["scene"] == scene:
                seconds[float(r["accuracy"])].append(float(r["seconds"]))
        table = list(zip((mean(seconds[n]) for n in sorted(seconds)), paper[scene]))
        for name, block in (("t", tree), ("h", hundred), ("p", table)):
            data.append(f"${scene}{name} << EOD\n" + "".join(f"{x} {y}\n" for x, y in block) + "EOD")
        plots.append(
            f"set title '{TITLES[scene]}'\n"
            f"plot sqrt({constant}/x) with lines lw 2 lc rgb '#999999', "
            f"${scene}p with linespoints pt 5 lw 2 lc rgb '#cc6677', "
            f"${scene}t with linespoints pt 7 lw 2 lc rgb '#332288', "
            f"${scene}h with linespoints pt 9 ps 1.2 lw 2 lc rgb '#117733'\n")
    script = "\n".join(data) + f"""
set terminal svg size 1050,360 font 'sans,13' background rgb 'white'
set output '{OUT / "tree.svg"}'
set multiplot layout 1,3 margins 0.08,0.98,0.18,0.9 spacing 0.07
set logscale xy
set xrange [0.03:100]
set yrange [0.003:0.7]
set format x '%g'
set xlabel 'seconds on one core'
set ylabel 'error: total variation of the final gates'
unset key
set grid lc rgb '#dddddd'
""" + LABELS + "unset label\n".join([plots[0], "set ylabel ' '\n" + plots[1] + plots[2]]) + "unset multiplot\n"
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


main()
