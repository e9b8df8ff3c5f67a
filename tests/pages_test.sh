#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Pages as they stand (pages.py), each in an empty folder.
#   pages_test.sh GATEWALK ROOT PYTHON PAGE...      gatewalk importable by PYTHON
set -euo pipefail
gatewalk=$(realpath "$1") root=$(realpath "$2") python=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
PATH=$(dirname "$gatewalk"):$PATH
PYTHONPATH=$("$python" -c 'import os; print(os.path.abspath(os.environ.get("PYTHONPATH", ".")))')
export PATH PYTHONPATH MPLBACKEND=Agg MPLCONFIGDIR=$work/matplotlib PYTHONDONTWRITEBYTECODE=1

# It can fail: by another number, fewer lines, a failing command, an error in Python, output of nothing.
fence='```'
wrong() {
  printf '%s\n' "$@" >"$work/wrong.md"
  if (cd "$work" && "$python" "$root/tests/pages.py" wrong.md >/dev/null 2>&1); then
    echo "FAILED: taken for right:"
    cat "$work/wrong.md"
    exit 1
  fi
}
right() {
  printf '%s\n' "$@" >"$work/right.md"
  (cd "$work" && "$python" "$root/tests/pages.py" right.md >/dev/null) || { echo "FAILED: taken for wrong:"; cat "$work/right.md"; exit 1; }
}
right "${fence}sh" 'printf "%s\n" a "b 1.25 c" d e' "$fence" "${fence}text" a 'b [...] c' '[...]' e "$fence"
wrong "${fence}sh" 'printf "%s\n" a "b 1.25 c"' "$fence" "${fence}text" a 'b 1.26 c' "$fence"
wrong "${fence}sh" 'printf "%s\n" a b' "$fence" "${fence}text" a "$fence"
wrong "${fence}sh" 'gatewalk predict none.toml' "$fence"
wrong "${fence}python" 'print(1 / 0)' "$fence"
wrong "${fence}python" 'print(1)' "$fence" "${fence}text" 2 "$fence"
wrong "${fence}text" 2 "$fence"
wrong nothing
right "$fence" '$ cat made' '1 [...]' '$ grep 1 made' '1 [...]' "$fence"
wrong "$fence" '$ echo 1' 2 "$fence"
wrong "$fence" '$ false' "$fence"
right "$fence" '$ gatewalk gate none.toml' 'gatewalk: none.toml: [...]' "$fence"

for page in "${@:4}"; do
  began=$SECONDS
  rm -rf "$work/folder"
  mkdir "$work/folder"
  ln -s "$(dirname "$gatewalk")" "$work/folder/build"
  [ "$page" = cli/site/tutorial.md ] || ln -s "$root/scenes" "$work/folder/scenes"
  (cd "$work/folder" && "$python" "$root/tests/pages.py" "$root/$page")
  echo "$page: $((SECONDS - began)) s"
done
