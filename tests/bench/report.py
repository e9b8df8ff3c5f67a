# SPDX-License-Identifier: MIT
"""report.py WORK FOLDER: what run.sh measured, as dynamics.csv, chain.csv and the tables of speed.md.

Dynamics: the median of the interleaved rounds, CPU time. Chain: the best of the rounds.
"""
import csv
import json
import statistics
import sys
import textwrap
from collections import defaultdict


def rounds(path):
    """Single measurements of a Google Benchmark run, by name."""
    with open(path) as f:
        found = [b for b in json.load(f)["benchmarks"] if b["run_type"] == "iteration"]
    to_seconds = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
    by_name = defaultdict(list)
    for b in found:
        b["seconds"] = b["cpu_time"] * to_seconds[b["time_unit"]]
        by_name[tuple(b["name"].split("/")[:3])].append(b)
    return by_name


def write_csv(path, rows):
    with open(path, "w", newline="") as f:
        writer = csv.DictWriter(f, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read_csv(path, names=None):
    with open(path) as f:
        return list(csv.DictReader(f, names))


def digits(x, n=3):
    return f"{float(x):.{n}g}" if x != "" else ""


def shown(x):
    """Counts in full, other numbers in three digits, anything else as it is."""
    if str(x).isdigit():
        return f"{int(x):,}".replace(",", " ")
    try:
        x = float(digits(x))
    except ValueError:
        return x
    return f"{x:,.0f}".replace(",", " ") if abs(x) >= 100 else f"{x:g}"


def table(rows, columns):
    """Markdown; columns: heading -> key of a row, or function of it."""
    yield "| " + " | ".join(columns) + " |"
    yield "|" + "---|" * len(columns)
    for row in rows:
        cells = (c(row) if callable(c) else row[c] for c in columns.values())
        yield "| " + " | ".join(shown(c) for c in cells) + " |"
    yield ""


# ---- Dynamics ----

ENDS = ["traversed", "exited", "trapped"]


def one_engine(condition, engine, measured):
    """measured: of each round seconds, trials, steps and how they ended."""
    trials = sum(m["trials"] for m in measured)
    row = {"condition": condition, "engine": engine, "trials": int(trials),
           "trials_per_s": statistics.median(m["trials"] / m["seconds"] for m in measured),
           "steps_per_s": statistics.median(m["steps"] / m["seconds"] for m in measured)}
    for end in ENDS:
        row[end + "_percent"] = digits(100 * sum(m[end] for m in measured) / trials)
    return row


def dynamics(work):
    rows = []
    main, debian = rounds(f"{work}/dynamics.json"), rounds(f"{work}/debian.json")
    octave = read_csv(f"{work}/octave.csv", ["condition", "trials", "seconds", "steps", *ENDS])
    for condition in "AB":
        def speed(found, engine):
            measured = next(m for k, m in found.items() if k[:2] == (engine, condition))
            return one_engine(condition, engine, measured)

        here = {k[0]: speed(main, k[0]) for k in main if k[1] == condition}
        # Debian's build ran beside `stable` in a run of its own: by that yardstick.
        its, yardstick = speed(debian, "Chipmunk"), speed(debian, "stable")
        scale = here["stable"]["trials_per_s"] / yardstick["trials_per_s"]
        its["engine"] = "Chipmunk (Debian's build)"
        its["trials_per_s"] *= scale
        its["steps_per_s"] *= scale
        slow = [{k: float(v) for k, v in o.items() if k != "condition"}
                for o in octave if o["condition"] == condition]
        names = ["ODE", "Box2D", "Chipmunk", "paper", "stable", "stable lanes", "moreau",
                 "moreau lanes"]
        for row in [one_engine(condition, "Octave (paper's scheme)", slow), its, *(here[n] for n in names)]:
            row["over_chipmunk"] = digits(row["trials_per_s"] / here["Chipmunk"]["trials_per_s"])
            row["over_stable"] = digits(row["trials_per_s"] / here["stable"]["trials_per_s"])
            rows.append(row | {k: digits(row[k], 4) for k in ("trials_per_s", "steps_per_s")})
    return rows


# ---- Chain ----


def chain(work):
    best = {}
    fields = ["task", "tool", "field", "seconds", "walks", "difference", "floor"]
    lines = read_csv(f"{work}/peers.csv", fields)
    for i in (1, 2, 3):
        for (task, tool, field), measured in rounds(f"{work}/chain.{i}.json").items():
            lines += [{"task": task, "tool": tool, "field": field, "seconds": m["seconds"], **{
                k: m.get(k, "") for k in fields[4:]}} for m in measured]
    for line in lines:
        key = line["task"], line["field"], line["tool"]
        if key not in best or float(line["seconds"]) < float(best[key]["seconds"]):
            best[key] = line
    rows = []
    per = lambda b: float(b["seconds"]) / float(b["walks"] or 1)
    for task, field in [("13 gates", "9x9"), ("no limit", "9x9"), ("walks", "9x9"), ("walks", "3x3"),
                        ("prepare", "9x9"), ("prepare", "3x3")]:
        group = [b for k, b in best.items() if k[:2] == (task, field)]
        ours = min((per(b) for b in group if b["tool"].startswith("gatewalk")), default=None)
        for b in sorted(group, key=per):
            rows.append({"task": task, "field": field, "tool": b["tool"],
                         "seconds": digits(b["seconds"], 4), "walks": digits(b["walks"], 9),
                         "walks_per_s": digits(1 / per(b), 4) if b["walks"] else "",
                         "times_as_long_as_ours": digits(per(b) / ours) if task != "prepare" else "",
                         "difference": digits(b["difference"], 2), "floor": digits(b["floor"], 2)})
    return rows


# ---- speed.md ----


def dynamics_text(folder, rows):
    yield """## One gate, beside general engines

From rest, Rm 10 N; A: F_prop 8 N, k 400/400; B: F_prop 7 N, k 300/500. Trials of the same random streams, under the same random
force (Octave: its own). Step 0.004 s, `stable` 0.02 s. Medians of interleaved rounds, CPU time. Chipmunk is
Debian's source in Chipmunk's own Release profile; Debian's build of it has the assertions on. All others are
Debian's builds.
"""
    yield from table(rows, {
        "": "condition", "engine": "engine", "trials/s": "trials_per_s", "steps/s": "steps_per_s",
        "traversed / exited / trapped %": lambda r: " / ".join(r[end + "_percent"] for end in ENDS),
        "trials": "trials", "over Chipmunk": "over_chipmunk", "over plain `stable`": "over_stable"})
    for r in rows:
        if r["engine"].endswith("lanes"):
            over_stable, over_chipmunk = float(r["over_stable"]), float(r["over_chipmunk"])
            met = "reached" if over_stable >= 4 and over_chipmunk >= 40 else "not reached"
            yield (f"{r['condition']}: {r['engine']} run {over_stable:g} times as many trials as plain `stable`, "
                   f"{over_chipmunk:g} times as many as Chipmunk; wanted: 4 and 40, {met}.\n")
    yield "Lanes beside the plain methods: total variation of the outcomes, and what chance alone gives.\n"
    yield from table(read_csv(f"{folder}/lanes.csv"), {
        "": "condition", "method": "method", "trials each": "trials", "random force": "noise",
        "total variation": "total_variation", "chance (mean)": "chance", "chance (95 %)": "chance_95", "p": "p"})
    yield ("`stable` in the registers of each instruction set that this machine has: times as many trials as the plain "
           "loop in the same rounds (best of seven).\n")
    sets = defaultdict(dict)
    for r in read_csv(f"{folder}/registers.csv"):
        sets[r["scene"]]["scene"] = r["scene"]
        sets[r["scene"]][r["registers"]] = float(r["times_plain"])
        if r["registers"] == "plain":
            sets[r["scene"]]["plain"] = float(r["microseconds"])
    names = [n for n in next(iter(sets.values())) if n not in ("scene", "plain")]
    yield from table(sets.values(), {"": "scene", "plain, us": "plain", **{n: n for n in names}})
    yield "Work: evaluations of gaps and forces per trial.\n"
    work = defaultdict(dict)
    for r in read_csv(f"{folder}/evaluations.csv"):
        work[r["scene"]]["scene"] = r["scene"]
        work[r["scene"]][r["method"]] = float(r["evaluations_per_trial"])
    yield from table(work.values(), {
        "": "scene", **{m: m for m in ("paper", "moreau", "stable", "event")},
        "`stable` over `moreau`": lambda w: w["stable"] / w["moreau"],
        "`event` over `moreau`": lambda w: w["event"] / w["moreau"]})


def chain_text(rows):
    yield """## The chain, beside general libraries

The matrix of scenes/field.toml, 100 trials per row, start (0, 0, 15); best of the rounds. Difference: from plain
`propagate`, the largest absolute one; of walks, total variation from the exact answer, beside the floor of chance.
R walks on a 3 x 3 field: its class is a dense matrix, 7209 states take minutes to construct.
"""
    yield from table(rows, {
        "task": "task", "field": "field", "tool": "tool", "seconds": "seconds", "walks/s": "walks_per_s",
        "times as long as ours": "times_as_long_as_ours", "difference": "difference", "floor": "floor"})


def size_text(folder):
    rows = read_csv(f"{folder}/size.csv")
    yield "## Cost against size\n"
    yield from table(rows, {"what": "study", "size": "size", "threads": "threads", "seconds": "seconds",
                            "peak MiB": "peak_MiB", "": "note"})
    yield "Time on one thread over time on two:\n"
    pieces = defaultdict(dict)
    for r in rows:
        if r["seconds"]:
            pieces[r["study"], r["size"]][r["threads"]] = float(r["seconds"])
    yield from table([p for p in pieces.items() if len(p[1]) == 2], {
        "what": lambda p: p[0][0], "size": lambda p: p[0][1], "ratio": lambda p: p[1]["1"] / p[1]["2"]})


def budget_text(folder):
    b = {r["what"]: float(r["value"]) for r in read_csv(f"{folder}/budget.csv")}
    yield "## Time to a total variation of 0.01\n"
    yield textwrap.fill(f"""Direct simulation needs {b['trials_for_0.01']:.0f} trials to be off by 0.01 on average. With the matrix at hand one
exact prediction takes {1e3 * b['predict_seconds']:.3g} ms; the matrix takes {b['matrix_seconds']:.2g} s.""", 115) + "\n"
    yield from table(["stable", "moreau"], {
        "full dynamics by": lambda m: m,
        "seconds": lambda m: b[m + "_seconds"],
        "over one prediction": lambda m: b[m + "_over_predict"],
        "over matrix and prediction": lambda m: b[m + "_over_matrix_and_predict"],
        "the matrix pays from start": lambda m: b[m + "_pays_from_starts"]})
    yield textwrap.fill(f"""But the chain is not the truth: the prediction of this matrix is off by {b['chain_total_variation']:.2g} (the
truth's own trials make some {b['truth_floor']:.1g} of it). Direct simulation is that close after
{b['trials_for_chains_error']:.0f} trials, {b['stable_seconds_to_chains_error']:.2g} s by `stable`,
{b['moreau_seconds_to_chains_error']:.2g} s by `moreau`; at this error the matrix pays from start
{b['stable_pays_from_starts_at_chains_error']:.0f} and {b['moreau_pays_from_starts_at_chains_error']:.0f} on.""", 115)


def main(work, folder):
    dynamics_rows, chain_rows = dynamics(work), chain(work)
    write_csv(f"{folder}/dynamics.csv", dynamics_rows)
    write_csv(f"{folder}/chain.csv", chain_rows)
    with open(f"{folder}/speed.md", "w") as f:
        f.write("# Speed\n\nWritten by `tests/bench/run.sh`; where and when: manifest.txt. "
                "One thread unless said.\n\n")
        for part in (dynamics_text(folder, dynamics_rows), chain_text(chain_rows), size_text(folder),
                     budget_text(folder)):
            f.writelines(line + "\n" for line in part)


main(*sys.argv[1:])
