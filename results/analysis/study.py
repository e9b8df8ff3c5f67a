#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether gatewalk analyze is right: chain beside full dynamics.

study.py GATEWALK DIR: writes summary.txt into DIR. Scenes A, C and M of results/tree, and the mixed
field; 10^5 trials each of another seed. Derivatives of one scene beside central differences of the
full dynamics.
"""
import json, math, subprocess, sys, tempfile, time
from pathlib import Path

GATEWALK, OUT = sys.argv[1], Path(sys.argv[2])
ROOT = Path(__file__).resolve().parents[2]
FIELD = [str(ROOT / "scenes/field.toml")]
SCENES = {
    "A: field.toml": FIELD,
    "C: 8.5 N, Rm 25 N, k 300 / 450": FIELD + [
        "--set", "forces.propulsion_N=8.5", "--set", "forces.random_N=25",
        "--set", "beams.stiffness_left_Nm_per_rad=300",
        "--set", "beams.stiffness_right_Nm_per_rad=450"],
    "M: 9 N, Rm 35 N, k 150 / 800": FIELD + [
        "--set", "forces.propulsion_N=9", "--set", "forces.random_N=35",
        "--set", "beams.stiffness_left_Nm_per_rad=150",
        "--set", "beams.stiffness_right_Nm_per_rad=800"],
    "mixed.toml": [str(ROOT / "scenes/mixed.toml")],
}
TRIALS = 100_000
# What parameters are looked at in: many cross, so that trials can show what changes that.
DERIVATIVES = FIELD + ["--set", "field.rows=3", "--set", "forces.propulsion_N=8.5", "--set",
                       "forces.random_N=25"]
STEP = 0.01  # the tips of the beams just meet at 1 to 2 % more or less
DERIVATIVE_TRIALS = 1_000_000


def run(*words):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.json"
        subprocess.run([GATEWALK, *words, "--json", str(out), "--quiet"], check=True)
        return json.loads(out.read_text())


def analysis(lines):
    lines.append(f"Chain (--accuracy 0.01) beside {TRIALS} trials of the full dynamics, another seed")
    for name, scene in SCENES.items():
        a = run("analyze", *scene, "--accuracy", "0.01", "--runs", "0", "--seed", "1")
        d = run("lattice", *scene, "--trials", str(TRIALS), "--seed", "4711")
        b = run("analyze", *scene, "--accuracy", "0.01", "--runs", "0", "--seed", "1", "--trials",
                str(TRIALS))
        ends = {e: (p, d["endings"][e] / TRIALS) for e, p in a["endings"].items()}
        worst = max(ends, key=lambda e: abs(ends[e][0] - ends[e][1]))
        inside = sum(low <= ends[e][1] <= high for e, (low, high) in a["endings_95"].items())
        all_ = d["costs"]["all"]
        se = all_["sd_time_s"] / math.sqrt(TRIALS)
        ks, chance = (b["by_ending"]["all"][k] for k in ("kolmogorov_distance", "kolmogorov_chance_q95"))
        ratio = lambda ours, theirs: f"{100 * (ours / theirs - 1):+.2f} %"
        lines.append(
            f"{name}\n  endings: largest difference {abs(ends[worst][0] - ends[worst][1]):.4f} "
            f"({worst}), {inside} of {len(ends)} inside the interval\n"
            f"  seconds {a['expected_seconds']:.2f} beside {all_['mean_time_s']:.2f} "
            f"({ratio(a['expected_seconds'], all_['mean_time_s'])}, chance {100 * se / all_['mean_time_s']:.2f} %), "
            f"gates {a['expected_gates']:.3f}\n"
            f"  work of the propulsion {ratio(a['expected_work_J'], all_['mean_work_J'])}, "
            f"of the random force {ratio(a['expected_random_work_J'], all_['mean_random_work_J'])}, "
            f"lost {ratio(a['expected_lost_J'], all_['mean_lost_J'])}\n"
            f"  distribution of the time: Kolmogorov distance {ks:.4f} (chance {chance:.4f})\n"
            f"  the analysis took {a['seconds']:.1f} s")


def derivatives(lines):
    lines.append("\nCrossing of 3 rows (8.5 N, Rm 25 N): per cent more for 1 % more of each number,\n"
                 f"beside central differences of the full dynamics ({100 * STEP:g} % to each side, {DERIVATIVE_TRIALS} "
                 "trials each, 95 %)")
    begin = time.monotonic()
    a = run("analyze", *DERIVATIVES, "--accuracy", "0.01", "--runs", "50000", "--step", str(STEP), "--seed", "1")
    seconds = time.monotonic() - begin
    inside = known = overlaps = 0
    parameters = a["sensitivities"]["parameters"]
    for p in parameters:
        sides = [1 + STEP, 1 - STEP]
        if p["key"] == "contact.tip_restitution":  # 1, the largest there is
            sides[0] = 1
        crossed = []
        for side in sides:
            d = run("lattice", *DERIVATIVES, "--set", f"{p['key']}={p['value'] * side!r}", "--trials",
                    str(DERIVATIVE_TRIALS), "--seed", "4711")
            crossed.append(d["endings"]["crossed"] / DERIVATIVE_TRIALS)
        width = (sides[0] - sides[1]) * a["target_probability"]
        central = (crossed[0] - crossed[1]) / width
        half = 1.96 * math.sqrt(sum(c * (1 - c) for c in crossed) / DERIVATIVE_TRIALS) / width
        said = f"  {p['key']:33} {p['elasticity']:7.2f} "
        if p["elasticity_95"]:
            low, high = p["elasticity_95"]
            known += 1
            inside += low <= central <= high
            overlap = low <= central + half and central - half <= high
            overlaps += overlap
            said += f"[{low:.2f}, {high:.2f}]"
        lines.append(f"{said}   dynamics {central:7.2f} [{central - half:.2f}, {central + half:.2f}]"
                     f"{'' if not p['elasticity_95'] or overlap else '  apart'}")
    lines.append(f"  {inside} of {known} central differences lie inside the chain's interval, {overlaps} agree within "
                 f"both; {len(parameters)} numbers took {a['sensitivities']['seconds']:.1f} s, all of it {seconds:.1f} s")


lines = []
analysis(lines)
derivatives(lines)
(OUT / "summary.txt").write_text("\n".join(lines) + "\n")
