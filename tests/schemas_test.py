#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""JSON as its schemas promise it: many command lines of every command, validated; a schema that has a
key no result has any more is told too.   schemas_test.py GATEWALK"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)

gatewalk = Path(sys.argv[1]).resolve()
schemas = {}  # by command
failures = []
seen = {}  # by command: the keys at the top

# What makes the files that the others read; no results of interest.
MAKE = """
sample runs -o runs.csv
sample cell -o cell.toml
sample tracks -o tracks.csv
sample observed -o observed.csv
sample field -o field.toml
sample mixed -o mixed.toml
sample walker -o walker.toml
"""
# Small fields, and short time limits where a method is chosen: the keys are those of the full ones.
LINES = """
sample
sample walker
scene walker.toml
scene mixed.toml
scene field.toml --set actions.a.forces.propulsion_N=6 --set actions.b={}
gate field.toml --trials 100
gate field.toml --set run.method=auto --set run.time_limit_s=2 --trials 50
sweep field.toml --vary forces.propulsion_N=6,8 --trials 20
trace field.toml --trials 2
trace mixed.toml --field --trials 1
build field.toml --trials 5 -o bins.nc
build field.toml --bins auto --trials 5 -o auto.nc
build field.toml --gate-runs 500 -o tree.nc
build field.toml --gate-runs 500 --starts all -o all.nc
build mixed.toml --gate-runs 500 -o mixed.nc
build runs.csv --cell cell.toml -o runs.nc
passages tracks.csv --cell cell.toml -o passages.csv --fps 10 --metres-per-unit 0.001 --fastest 0.4 --lattice 9,9 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y
build passages.csv --cell cell.toml -o passages.nc
show bins.nc
show tree.nc
show mixed.nc
show passages.nc
walk bins.nc
walk passages.nc
export tree.nc --set field.max_gates=0 -o x.drn
export bins.nc --gate --counts -o gate.csv
export tree.nc -o x.dtrajs
import gate.csv --states gate.states.csv --start 12 -o own.nc
predict own.nc
analyze own.nc
show own.nc
predict field.toml --accuracy 0.2
predict field.toml --accuracy 0.2 --start 0,0,15 --start 4,5,10
predict bins.nc
predict bins.nc --start 4,5,10 --set field.max_gates=0
predict mixed.toml --accuracy 0.2
predict passages.nc
predict runs.nc
predict tree.nc --set field.columns=317 --set field.rows=317
analyze field.toml --accuracy 0.2 --runs 200
analyze mixed.toml --accuracy 0.2 --runs 0 --trials 50 --target trapped
analyze bins.nc --runs 0 --first-passage 0,1
analyze passages.nc --set field.rows=4
analyze field.toml --accuracy 0.2 --runs 0 --set field.max_gates=0 --lump 2,1,1 --first-passage crossed
lattice field.toml --trials 50
lattice mixed.toml --trials 50
rare field.toml --row 4 --accuracy 0.5
plan field.toml --set field.rows=2 --set actions.a.forces.propulsion_N=6 --set actions.b.forces.propulsion_N=9 --accuracy 0.2 --policy policy.json --gate-policy gates.json
lattice field.toml --set field.rows=2 --set actions.a.forces.propulsion_N=6 --set actions.b.forces.propulsion_N=9 --policy policy.json --trials 20
trace field.toml --set field.rows=2 --set actions.a.forces.propulsion_N=6 --set actions.b.forces.propulsion_N=9 --policy policy.json --trials 2
plan field.toml --set field.rows=2 --set actions.a.forces.propulsion_N=6 --set actions.b.forces.propulsion_N=9 --accuracy 0.2 --least work_J
plan mixed.toml --set field.rows=2 --set run.method=auto --set run.time_limit_s=4 --accuracy 0.2
plan field.toml --set field.rows=2 --over start.x_m=-5:5 --accuracy 0.2
plan field.toml --set field.rows=2 --set actions.a.forces.propulsion_N=6 --set actions.b.forces.propulsion_N=9 --accuracy 0.2 --robust
design mixed.toml --set field.rows=2 --changes 2 --accuracy 0.2
design mixed.toml --set field.rows=2 --set run.method=auto --types s --least --accuracy 0.2
fit field.toml observed.csv --set field.rows=2 --set field.columns=3 --set run.method=auto --set run.time_limit_s=4 --free forces.propulsion_N=5:9 --free forces.random_N=5:20 --trials 24576
validate field.toml --trials 50 --accuracy 0.2
validate field.toml --trials 50 --bins paper
validate field.toml --trials 50 --accuracy 0.2 --observed observed.csv
validate passages.nc
power field.toml --set field.rows=2 --set field.columns=3 --trials 20 --accuracy 0.2 --versus forces.propulsion_N=8
power passages.nc --set field.rows=3 --set field.columns=3 --trials 20
"""
# Those with a folder of results, in which their JSON stands.
FOLDERS = {"landscape field.toml": "landscape.json", "landscape field.toml --trials 20": "landscape.json",
           "chart limits field.toml --quick --trials 4": "limits.json", "chart field field.toml --trials 50": "fidelity.json",
           "chart methods field.toml --trials 20": "chart.json"}


def run(words, want=(0,)):
    quiet = [] if words[0] == "help" else ["--quiet", "--force"]
    done = subprocess.run([gatewalk, *words, *quiet], capture_output=True, text=True, check=False)
    if done.returncode not in want:
        failures.append(f"{' '.join(words)}: status {done.returncode}: {done.stderr.strip()[:300]}")
    return done.returncode


def check(name, result, line):
    if name not in schemas:
        failures.append(f"{name}: has no schema")
        return
    seen.setdefault(name, set()).update(result)
    for error in list(Draft202012Validator(schemas[name]).iter_errors(result))[:3]:
        failures.append(f"{line}: {'/'.join(map(str, error.absolute_path))}: {error.message[:300]}")


def main():
    run(["help", "--write", "share"])
    for path in Path("share/gatewalk/schemas").glob("*.schema.json"):
        schemas[path.name.split(".")[0]] = json.loads(path.read_text())
    for schema in schemas.values():
        Draft202012Validator.check_schema(schema)
    for line in filter(None, MAKE.split("\n")):
        run(line.split())
    for line in filter(None, LINES.split("\n")):
        words = line.split()
        if run([*words, "--json", "result.json"]) == 0:
            check(words[0], json.loads(Path("result.json").read_text()), line)
    for line, file in FOLDERS.items():
        words = line.split()
        if run([*words, "-o", "out"]) == 0:
            name = "-".join(words[:2]) if words[0] == "chart" else words[0]
            check(name, json.loads(Path("out", file).read_text()), line)
    # A key that the schemas promise always is in each result, by the schema; others were seen in some.
    for name, keys in seen.items():
        for key in set(schemas[name].get("required", ())) - keys:
            failures.append(f"{name}: no result has {key}")
    commands = subprocess.run([gatewalk, "--help"], capture_output=True, text=True, check=True).stdout
    for command in re.findall(r"^  ([a-z]+(?: [a-z]+)?)  ", commands, re.M):
        if command not in ("merge", "simulate") and command.replace(" ", "-") not in schemas:
            failures.append(f"{command}: has no schema")
    # A schema refuses what it does not know.
    wrong = json.loads(Path("result.json").read_text())
    wrong["no_such_key"] = 1
    if Draft202012Validator(schemas["power"]).is_valid(wrong):
        failures.append("a key that is none is taken")


with tempfile.TemporaryDirectory() as folder:
    import os

    os.chdir(folder)
    main()
for failure in failures:
    print("FAILED:", failure)
sys.exit(1 if failures else 0)
