#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# How long do predictions of two versions of the program take, side by side on one thread?
#   results/tree/versions.sh NEW OLD      about 6 minutes on an idle machine, needs python3
# Writes versions.csv: seconds, and those of gate runs alone, of six predictions of one start with 0.02 asked, and of a
# hundred starts unknown to a chain of build --accuracy 0.06 --starts all.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
python3 - "$here" "$@" >"$here/versions.csv" <<'EOF'
import importlib.util, subprocess, sys, tempfile
from pathlib import Path

here, *programs = sys.argv[1:]
spec = importlib.util.spec_from_file_location("tree", f"{here}/study.py")
sys.argv = ["study.py", programs[0], here]
tree = importlib.util.module_from_spec(spec)
spec.loader.exec_module(tree)
print("scene,starts,program,seconds,run_seconds,gate_runs")
for scene in "ABC":
    for count in (1, 100):
        for tree.GATEWALK in programs:
            said = subprocess.run([tree.GATEWALK, "--version"], capture_output=True, text=True, check=True).stdout
            if count == 1:
                all_of = [tree.run("predict", *tree.SCENES[scene], "--accuracy", 0.02, "--seed", seed)
                          for seed in range(1, 7)]
            else:
                with tempfile.TemporaryDirectory() as folder:
                    matrix = Path(folder) / "m.nc"
                    tree.run("build", *tree.SCENES[scene], "--accuracy", 0.06, "--starts", "all", "-o", matrix)
                    words = [w for s in tree.hundred(scene) for w in ("--start", ",".join(map(str, s)))]
                    all_of = [tree.run("predict", matrix, *words)]
            sums = [sum(j[key] for j in all_of) for key in ("seconds", "run_seconds", "gate_runs")]
            print(scene, count, " ".join(said.split()[1:3]), f"{sums[0]:.1f}", f"{sums[1]:.1f}", sums[2], sep=",",
                  flush=True)
EOF
