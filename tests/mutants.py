#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Do the tests see a mistake? Small mistakes (mutants) are put into the kernels, one at a time, and the tests run.

    tests/mutants.py [--build build] [--per-file 10] [--seed 1] [--jobs 2] [--only TEXT] [--survivors] [SOURCE ...]

Needs a Release build of the last sources with its tests (gatewalk, *_tests). Of a mutant only its source is compiled,
with -O1 and without ccache, and linked before the build's own objects: the linker takes the first definition of a name
(-z muldefs; the libraries are position-independent code, in which g++ inlines no function that another may replace).
So the build folder is only read. The tests that KERNELS names first run first, then all others of the program, up to
the first that fails, within ten times the processor time that they take without a mutant.

A mutant is killed (a test fails, also by its time limit), survives, does not compile, or is the same machine code.
Why the others survive is told in results/reliability/survivors.tsv: source, change,
reason. Writes results/reliability/mutants.csv (rows of other sources are kept) and mutants.txt.
Exit status: 0; 1 where fewer than 90 % of those compiled are killed, or a survivor has no reason.
--only runs mutants whose mutated line holds TEXT, writes nothing. --survivors runs those again that survived by the
table: where tests were added. The choice follows from seed and source alone.
"""
import argparse, csv, json, os, platform, random, re, resource, shutil, signal, subprocess, sys, tempfile, threading, time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "results/reliability"

# Source: its test programs, each with the tests that run first; a script is one of tests/program. Sources that are
# included name those that are compiled.
TREES = "TreeChain.*:PooledPrediction.*:RunPool.*:PoolChains.*:Prediction.*"
KERNELS = {
    "dynamics/disc/contact.cpp": {"dynamics": "Nearest.*:Impulses.*:ContactForces.*:GapRate.*:Impact.*:*/ExactHits.*"},
    "dynamics/disc/contact-inl.h": {"dynamics": "StableLanes.*:Lanes.*:PushO*:OutOfReach.*:Nearest.*"},
    "dynamics/disc/methods/stable.cpp": {"dynamics": "*/ExactHits.*:Stable.*:StableLanes.*:*/HeldContacts.*"},
    "dynamics/disc/stable-inl.h": {"dynamics": "StableLanes.*:Stable.*"},
    "dynamics/disc/stable_lanes.cpp": {"dynamics": "StableLanes.*:Stable.*"},
    "dynamics/base/points.cpp": {"dynamics": "Points.*", "lattice": "RqmcTrials.*"},
    "dynamics/base/work.cpp": {"dynamics": "KeptPieces.*:Pieces.*:PieceSize.*:Work.*:Ranks.*", "parts": ""},
    "dynamics/cells/tree_space.cpp": {"dynamics": "TreeSpace.*", "lattice": TREES},
    "markov/predict/row_elimination.cpp": {"markov": "RowElimination.*:LargeField.*:Predictor.*"},
    "markov/predict/by_rows.cpp": {"markov": "RowSweeps.*:Exact.*:Predictor.*:LargeField.*:Outcomes.*"},
    "markov/predict/by_steps.cpp": {"markov": "Exact.*:Predictor.*:Adjoint.*:Outcomes.*"},
    "lattice/field/rqmc_trials.cpp": {"lattice": "RqmcTrials.*:RunPool.*", "cli": "ProgramCell.*"},
    "lattice/pool/reactive_visits.cpp": {"lattice": "Analysis.*:Costs.*:Terrain.*"},
    "lattice/pool/pooled_prediction.cpp": {"lattice": "HausmanCheck.*:" + TREES},
    "lattice/pool/run_pool.cpp": {"lattice": TREES},
    "lattice/pool/tree_chain.cpp": {"lattice": TREES},
    "lattice/statistics/group_spread.cpp": {"lattice": "GroupSpread.*:GroupDifference.*:" + TREES},
    "lattice/study/rare.cpp": {"lattice": "Splitting.*"},
    "cli/kept/kept_run.cpp": {"parts": "", "resume": ""},
}
INCLUDED = {
    "dynamics/disc/contact-inl.h": ["dynamics/disc/lanes.cpp", "dynamics/disc/stable_lanes.cpp"],
    "dynamics/disc/stable-inl.h": ["dynamics/disc/stable_lanes.cpp"],
}


def code_only(text):
    """The text with blanks for comments, texts, directives, exceptions and their messages."""
    blank = lambda m: re.sub(r"[^\n]", " ", m[0])
    text = re.sub(r"//[^\n]*|/\*.*?\*/|\"(\\.|[^\"\\\n])*\"|(?<![0-9a-fA-F])'(\\.|[^'\\\n])'", blank, text, flags=re.S)
    text = re.sub(r"^[ \t]*#[^\n]*", blank, text, flags=re.M)
    return re.sub(r"\b(throw|static_assert|template|using)\b[^;{]*", blank, text)


def closing(code, at):
    depth = 0
    for i in range(at, len(code)):
        depth += {"(": 1, ")": -1}.get(code[i], 0)
        if depth == 0:
            return i
    return None


def constant(m, chance):
    text = m[0].replace("'", "")
    if not re.fullmatch(r"\d+", text):
        return re.sub(r"^\d+", lambda n: str(int(n[0]) + 1), m[0])
    return {"0": "1", "1": chance.choice(["0", "2"])}.get(text) or str(int(text) + chance.choice([-1, 1]))


def mutations(text, chance):
    """All (operator, from, to, new text)."""
    code = code_only(text)
    # Each is changed into one of these; a text that + puts behind another is no sum.
    swaps = [("relational", r"(?<= )(<=|>=|<|>|==|!=)(?= )",
              {"<": "<= >", "<=": "< >", ">": ">= <", ">=": "> <", "==": "!=", "!=": "=="}),
             ("arithmetic", r"(?<= )[-+*/]=?(?= )",
              {a + e: b + e for a, b in ("+-", "-+", "*/", "/*") for e in ("", "=")}),
             ("logical", r"(?<= )(&&|\|\|)(?= )", {"&&": "||", "||": "&&"}),
             ("min-max", r"\b(min|max)(?=(<[\w:]+>)?\((?!\)))", {"min": "max", "max": "min"})]
    for operator, pattern, to in swaps:
        for m in re.finditer(pattern, code):
            if '"' not in text[m.start() - 2] + text[m.end() + 1]:
                yield operator, m.start(), m.end(), chance.choice(to[m[0]].split())
    for m in re.finditer(r"(?<![\w.'])\d[\d']*(\.\d*)?(e-?\d+)?(?![\w.'>])", code):
        yield "constant", m.start(), m.end(), constant(m, chance)
    for m in re.finditer(r"\bif \(", code):
        end = closing(code, m.end() - 1)
        if end and ";" not in code[m.end():end]:
            yield "condition", m.end() - 1, end + 1, "(!" + text[m.end() - 1:end + 1] + ")"
    # A call or an assignment, up to its semicolon; what only reserves memory may go.
    name = r"([\w.\[\]:>-]|\(\*|static_cast<[^>]*>\(\w+\))+"
    begin = r"(?:(?<=[;{}\n])|(?<=\) )) *(?!return|delete|break)"
    end = r"( [-+*/|&^]?=[ \n][^;{}]*|\([^;{}]*\))"
    for m in re.finditer(rf"{begin}({name}{end});", code):
        if ("=" in m[1] or m[1].endswith(")")) and ".reserve(" not in m[1]:
            yield "statement", m.start(1), m.end(1), ""


def choose(source, number, seed):
    """`number` mutants, from all operators alike: (operator, line, mutated line, mutated text, old line)."""
    text = (ROOT / source).read_text()
    chance = random.Random(f"{seed} {source}")
    by_operator = {}
    for operator, start, end, to in mutations(text, chance):
        by_operator.setdefault(operator, []).append((operator, start, end, to))
    for some in by_operator.values():
        chance.shuffle(some)
    chosen = []
    while len(chosen) < number and any(by_operator.values()):
        for some in by_operator.values():
            if some and len(chosen) < number:
                chosen.append(some.pop())
    for operator, start, end, to in sorted(chosen, key=lambda c: c[1]):
        first, last = text.rfind("\n", 0, start) + 1, text.find("\n", end)
        line = lambda s: " ".join(s.split())
        yield (operator, text.count("\n", 0, start) + 1, line(text[first:start] + to + text[end:last]),
               text[:start] + to + text[end:], line(text[first:last]))


class Build:
    """Reads how the build compiles and links."""
    def __init__(self, folder):
        self.folder = folder.resolve()
        self.of_source, self.links = {}, {}
        for entry in json.loads(self.ninja("compdb")):
            if entry["file"].endswith("_cxx.cxx"):  # a batch
                parts = re.findall(r'#include "(.*)"', Path(entry["file"]).read_text())
            else:
                parts = [entry["file"]]
            for part in parts:
                self.of_source.setdefault(os.path.relpath(part, ROOT), entry["command"])

    def ninja(self, *words):
        return output_of("ninja", "-C", self.folder, "-t", *words)

    def compile(self, source, overlay, obj):
        """Compiles it with the sources in overlay before the others; its own copy there, if there is one."""
        command = re.sub(r"^(\S*ccache )?(\S+) ", lambda m: f"{m[2]} -I{overlay} ", self.of_source[source])
        command = re.sub(r" -MD -MT .*", "", command)
        file = overlay / source if (overlay / source).exists() else ROOT / source
        # Vectorised sources for one instruction set only: a third of the time, the same bits.
        lanes = source.endswith("lanes.cpp") and platform.machine() == "x86_64"
        sets = "-march=x86-64-v3 -maes -mpclmul" if lanes else ""
        return run(f"{command} -DHWY_COMPILE_ONLY_STATIC {sets} -O1 -w -c {file} -o {obj}", 600, self.folder)[0]

    def link(self, program, objects, out):
        """Links a test program; `gatewalk` for scripts."""
        target = f"{program}_tests" if program in ("dynamics", "markov", "lattice", "cli") else "gatewalk"
        if target not in self.links:
            self.links[target] = self.ninja("commands", target).strip().splitlines()[-1].split("&&")[1]
        command = re.sub(r" -o \S+", f" -o {out} -Wl,-z,muldefs", self.links[target], count=1)
        command = re.sub(r" (\S+\.o) ", lambda m: f" {' '.join(map(str, objects))} {m[1]} ", command, count=1)
        status = run(command, 600, self.folder)[0]
        if status != 0:
            raise RuntimeError(f"does not link: {command}")


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def run(command, seconds, folder):
    """Status (None: took longer), output, processor seconds. `seconds` of the processor, and 20 times of the clock."""
    def limits():
        os.setsid()
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
    with tempfile.TemporaryFile("w+", errors="replace") as log:
        p = subprocess.Popen(command, shell=True, cwd=folder, stdout=log, stderr=log, preexec_fn=limits)
        late = threading.Timer(20 * seconds + 60, lambda: os.killpg(p.pid, signal.SIGKILL))
        late.start()
        _, status, usage = os.wait4(p.pid, 0)
        p.returncode = status
        late.cancel()
        log.seek(0)
        killed = os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL)
        return None if killed else status, log.read(), usage.ru_utime + usage.ru_stime


usual = {}  # processor seconds without a mutant, by program and filter; all others than a filter are alike


def test(program, filters, binary, folder):
    """None where all tests pass, else what fails. Of a script the filters mean nothing."""
    calls = [f"./{binary.name} --gtest_brief=1 --gtest_fail_fast --gtest_filter='{f}'" for f in filters]
    if not filters:
        calls = [f"{ROOT}/tests/program/{program}_test.sh ./{binary.name} {ROOT} {folder}/kept"]
    for call, name in zip(calls, filters or [program]):
        key = program, "others" if name.startswith("-") else name
        status, output, seconds = run(call, 10 * usual[key] + 10 if key in usual else 3000, folder)
        usual.setdefault(key, seconds)
        if status != 0:
            if status is None:
                return "time limit"
            failed = re.search(r"FAILED  \] ([\w./]+)", output)
            said = output.replace(f"{folder}/", "").replace(f"{ROOT}/", "").strip().splitlines()
            return failed[1] if failed else said[-1] if said else f"status {status}"
    return None


def kernel(source, options, build, pool, reasons, again, work):
    """Rows of the table of a source; where `again` is given, of mutants in it."""
    sources = INCLUDED.get(source, [source])

    def attempt(name, text):
        folder = work / name
        (folder / "overlay" / source).parent.mkdir(parents=True)
        (folder / "overlay" / source).write_text(text)
        objects = [folder / f"{i}.o" for i in range(len(sources))]
        if any(build.compile(s, folder / "overlay", o) != 0 for s, o in zip(sources, objects)):
            return "does not compile", "", None
        code = [o.read_bytes().replace(str(folder).encode(), b"") for o in objects]
        if name != "plain" and code == plain:
            return "same code", "", code
        for program, first in KERNELS[source].items():
            binary = folder / (f"{program}_tests" if first else "gatewalk")
            build.link(program, objects, binary)
            # All tests without a mutant once only, which takes as long as many mutants.
            filters = [first] if name == "plain" and (program, "others") in usual else [first, f"-{first}"]
            failed = test(program, filters if first else [], binary, folder)
            binary.unlink()
            if failed:
                return "killed", failed, code
        return "survived", "", code

    plain = None
    result, why, plain = attempt("plain", (ROOT / source).read_text())
    if result != "survived":
        sys.exit(f"{source}: {result} without a mutant ({why})")

    def one(number, mutant):
        operator, line, mutated, text, old = mutant
        result, why, _ = attempt(f"m{number:04d}", text)
        shutil.rmtree(work / f"m{number:04d}")
        if result == "survived" and (source, f"{old} => {mutated}") in reasons:
            result, why = "explained", reasons[source, f"{old} => {mutated}"]
        print(f"{source}:{line}: {operator}: {old}  =>  {mutated}: {result} {why}", flush=True)
        return [source, line, operator, f"{old} => {mutated}", result, why]

    mutants = [m for m in choose(source, options.per_file, options.seed) if (options.only or "") in m[2]
               and (again is None or (source, f"{m[4]} => {m[2]}") in again)]
    if again is not None and len({m[4] + m[2] for m in mutants}) < len([s for s, _ in again if s == source]):
        sys.exit(f"{source} has changed since its rows were made: run it without --survivors")
    rows = list(pool.map(one, range(len(mutants)), mutants))
    shutil.rmtree(work / "plain")
    return rows


def write(table, rows):
    with table.open("w", newline="") as file:
        head = ["source", "line", "operator", "change", "result", "by"]
        csv.writer(file, lineterminator="\n").writerows([head, *rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--per-file", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only")
    parser.add_argument("--survivors", action="store_true")
    parser.add_argument("sources", nargs="*", choices=[[], *KERNELS])
    options = parser.parse_args()
    build = Build(options.build)
    survivors, table = OUT / "survivors.tsv", OUT / "mutants.csv"
    reasons = {tuple(line.split("\t")[:2]): line.split("\t")[2] for line in survivors.read_text().splitlines()[1:]}
    rows = list(csv.reader(table.open()))[1:] if table.exists() else []
    with tempfile.TemporaryDirectory() as work, ThreadPoolExecutor(options.jobs) as pool:
        for source in options.sources or KERNELS:
            again = {(row[0], row[3]) for row in rows if row[4] in ("survived", "explained")} if options.survivors else None
            if again is not None and source not in {s for s, _ in again}:
                continue
            new = kernel(source, options, build, pool, reasons, again, Path(work))
            if options.only is not None:
                continue
            made = {(row[0], row[3]) for row in new}
            rows = [row for row in rows if row[0] in KERNELS and (row[0], row[3]) not in made
                    and (options.survivors or row[0] != source)] + new
            rows.sort(key=lambda row: (list(KERNELS).index(row[0]), int(row[1])))
            write(table, rows)
    if options.only is not None:
        return 0
    for row in rows:  # those of earlier runs too
        if row[4] in ("survived", "explained") and (row[0], row[3]) in reasons:
            row[4:] = "explained", reasons[row[0], row[3]]
    write(table, rows)
    results = "killed", "survived", "explained", "does not compile", "same code"
    number = {r: sum(row[4] == r for row in rows) for r in results}
    compiled = number["killed"] + number["survived"] + number["explained"]
    share = number["killed"] / compiled
    manifest = f". {ROOT}/results/manifest.sh; gatewalk={build.folder}/gatewalk; manifest 'tests/mutants.py {' '.join(sys.argv[1:])}'"
    summary = (f"{output_of('bash', '-c', manifest)}date: {time.strftime('%Y-%m-%d')}\n"
               f"mutants: {len(rows)} of {len({row[0] for row in rows})} sources; "
               f"{', '.join(f'{n} {r}' for r, n in number.items())}\nkilled of those compiled: {100 * share:.1f} %\n")
    (OUT / "mutants.txt").write_text(summary)
    print(summary)
    return int(share < 0.9 or number["survived"] > 0)


if __name__ == "__main__":
    sys.exit(main())
