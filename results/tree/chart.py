#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws tree.svg and runs.svg in DIR from the points.csv and summary.txt that study.py wrote there (gnuplot)."""
import csv, math, re, subprocess, sys
from collections import defaultdict
from pathlib import Path

OUT = Path(sys.argv[1])
TITLES = {"A": "A: 7 N, Rm 50 N (field.toml)", "B": "B: 8 N, Rm 10 N",
          "C": "C: 8.5 N, Rm 25 N, k 300 / 450"}


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
    for i, scene in enumerate(TITLES):
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
        left, top = 82 + 224 * (i % 2), 34 + 196 * (i // 2)
        plots.append(
            f"unset label\neval text('{TITLES[scene]}', {left}, {top - 14}).\" font ',12'\"\n"
            f"eval panel({left}, {left + 170}, {top}, {top + 132})\n"
            f"set ylabel '{'' if i % 2 else 'total variation'}'\nset xlabel '{'' if i == 0 else 'seconds on one core'}'\n"
            f"plot sqrt({constant}/x) with lines lt -1 lw 1.5 title 'direct simulation', "
            f"${scene}p with linespoints pt 5 lc rgb second title 'chain, bins of the paper', "
            f"${scene}t with linespoints pt 7 lc rgb first title 'trees, one start', "
            f"${scene}h with linespoints pt 9 lc rgb third title 'trees, each of a hundred'\n"
            "unset key\n")
    script = f"""
call '{Path(__file__).parent.parent / "look.gp"}' 424
set output '{OUT / "tree.svg"}'
set multiplot
set logscale xy
set xrange [0.03:100]
set yrange [0.003:0.7]
set format xy '%g'
set grid lt -1 lw 0.2
set style data linespoints
set pointsize 0.7
eval key_at(298, 260)
""" + "\n".join(data + plots) + "unset multiplot\n"
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


SCENES = {"A": "A", "B": "B", "C": "C", "M": "unlike", "R": "robot"}


def runs():
    """Error against gate runs, of the chain and of direct simulation with as small errors."""
    text = (OUT / "summary.txt").read_text()
    data, plots = [], []
    looks = ["lc rgb first", "lc rgb second", "lc rgb third", "lc rgb fourth", "lt -1"]
    for look, (scene, name) in zip(looks, SCENES.items()):
        line = re.search(rf"^{scene}: slope (\S+); (.*)$", text, re.M)
        points = [p.split() for p in line.group(2).split(", ")]
        data.append(f"${scene} << EOD\n" + "".join(f"{n} {e} {d}\n" for n, e, d in points) + "EOD")
        plots.append(f"${scene} using 3:2 with lines {look} dt 2 lw 1.2 notitle, "
                     f"${scene} using 1:2 with linespoints {look} pt 7 title '{name}: {line.group(1)}'")
    script = f"""
call '{Path(__file__).parent.parent / "look.gp"}' 300
set output '{OUT / "runs.svg"}'
set logscale xy
set xrange [2e3:2e6]
set yrange [0.004:0.04]
set format x '10^{{%T}}'
set ytics (0.004, 0.01, 0.02, 0.04)
set grid lt -1 lw 0.2
set pointsize 0.7
eval panel(96, 350, 20, 240)
set xlabel 'gate runs'
set ylabel 'total variation' offset 1.6,0
eval key_at(362, 20)
eval text('Solid: the chain, with', 362, 150).\" font ',12'\"
eval text('its slope. Dashed:', 362, 166).\" font ',12'\"
eval text('direct simulation, -0.5.', 362, 182).\" font ',12'\"
{chr(10).join(data)}
plot {", ".join(plots)}
"""
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


main()
runs()
