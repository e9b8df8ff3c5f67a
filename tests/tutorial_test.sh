#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The tutorial as it stands: its sh and python blocks run one after the other in an empty folder, and print the lines of the
# text block that follows ("[...]": anything, on a line of its own any lines).
#   tutorial_test.sh GATEWALK ROOT [PYTHON]      gatewalk importable by PYTHON
set -euo pipefail
gatewalk=$(realpath "$1") root=$(realpath "$2") python=${3:-/usr/bin/python3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
PATH=$(dirname "$gatewalk"):$PATH
PYTHONPATH=$("$python" -c 'import os; print(os.path.abspath(os.environ["PYTHONPATH"]))')
export PATH PYTHONPATH MPLBACKEND=Agg MPLCONFIGDIR=$work/matplotlib PYTHONDONTWRITEBYTECODE=1

cat >"$work/run.py" <<'END'
import contextlib, io, re, subprocess, sys, traceback

page = open(sys.argv[1], encoding="utf-8").read()
blocks = re.findall(r"^```(\w+)\n(.*?)^```$", page, re.S | re.M)
names, seen, ran = {}, None, 0


def fail(text, *rest):
    sys.exit("\n".join([f"{sys.argv[1]}: {text}", *rest]))


def as_pattern(shown):
    lines = [r"(?:.*\n)*?" if line.strip() == "[...]" else
             ".*".join(re.escape(part.rstrip() if k == last else part) for k, part in enumerate(line.split("[...]"))) + r"[ \t]*\n"
             for line in shown.splitlines() for last in [line.count("[...]")]]
    return "".join(lines)


for kind, text in blocks:
    if kind == "text":
        if seen is None:
            fail("output without a command before it:", text)
        if not re.fullmatch(as_pattern(text), seen):
            fail("the page shows", text, "but what is printed is", seen)
        seen = None
    elif kind == "sh":
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], capture_output=True, text=True)
        # head, which has seen enough, ends what writes to it
        if done.returncode not in (0, 141):
            fail(f"exit status {done.returncode}:", text, done.stderr)
        seen, ran = done.stdout, ran + 1
    elif kind == "python":
        out = io.StringIO()
        try:
            with contextlib.redirect_stdout(out):
                exec(compile(text, "python block", "exec"), names)
        except Exception:
            fail("a python block fails:", text, traceback.format_exc())
        seen, ran = out.getvalue(), ran + 1
    else:
        fail(f"a block of {kind}: only sh, python and text are run")
if not ran:
    fail("no blocks")
print(f"{ran} blocks")
END

# It can fail: by another number, fewer lines, a failing command, an error in Python, output of nothing.
fence='```'
wrong() {
  printf '%s\n' "$@" >"$work/wrong.md"
  if (cd "$work" && "$python" run.py wrong.md >/dev/null 2>&1); then
    echo "FAILED: taken for right:"
    cat "$work/wrong.md"
    exit 1
  fi
}
right() {
  printf '%s\n' "$@" >"$work/right.md"
  (cd "$work" && "$python" run.py right.md >/dev/null) || { echo "FAILED: taken for wrong:"; cat "$work/right.md"; exit 1; }
}
right "${fence}sh" 'printf "%s\n" a "b 1.25 c" d e' "$fence" "${fence}text" a 'b [...] c' '[...]' e "$fence"
wrong "${fence}sh" 'printf "%s\n" a "b 1.25 c"' "$fence" "${fence}text" a 'b 1.26 c' "$fence"
wrong "${fence}sh" 'printf "%s\n" a b' "$fence" "${fence}text" a "$fence"
wrong "${fence}sh" 'gatewalk predict none.toml' "$fence"
wrong "${fence}python" 'print(1 / 0)' "$fence"
wrong "${fence}python" 'print(1)' "$fence" "${fence}text" 2 "$fence"
wrong "${fence}text" 2 "$fence"
wrong nothing

mkdir "$work/folder"
began=$SECONDS
(cd "$work/folder" && "$python" ../run.py "$root/cli/site/tutorial.md")
echo "tutorial: $((SECONDS - began)) s"
