#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the commands of pages (pages.py), each page in an empty folder.   pages_test.sh GATEWALK ROOT PYTHON [--renew]
# PAGE... PYTHON must find the module gatewalk. --renew writes the present output into the pages. Without a page: checks
# that pages.py finds wrong pages.
set -euo pipefail
gatewalk=$(realpath "$1") root=$(realpath "$2") python=$3
shift 3
renew=()
if [ "${1-}" = --renew ]; then
  renew=(--renew)
  shift
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
PATH=$(dirname "$gatewalk"):$PATH
PYTHONPATH=$("$python" -c 'import os; print(os.path.abspath(os.environ.get("PYTHONPATH", ".")))')
export PATH PYTHONPATH MPLBACKEND=Agg MPLCONFIGDIR=$work/matplotlib PYTHONDONTWRITEBYTECODE=1

if [ $# = 0 ]; then
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
  right "${fence}sh" 'printf "%s\n" "a 1" "b 2"' "$fence" "${fence}text" 'a 1 [...]' 'b [...]' "$fence"
  wrong "${fence}sh" 'echo "a 1"' "$fence" "${fence}text" 'a [...] 1 2' "$fence"
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

  # --renew keeps what matches, takes numbers and words from what is printed, and reports lines without a counterpart.
  renewed() {  # STATUS, then the page that must result
    local status=0
    (cd "$work" && "$python" "$root/tests/pages.py" right.md --renew >/dev/null 2>&1) || status=$?
    [ "$status" = "$1" ] && printf '%s\n' "${@:2}" | cmp -s - "$work/right.md" || { echo "FAILED: renewed:"; cat "$work/right.md"; exit 1; }
  }
  shows() { printf '%s\n' "$@" >"$work/right.md"; }
  command='$ printf "%s\n" first "crossed 1.5 % [1, 2] of all" "left side 2" "trapped 3" "gates 4, 5"'
  shows "$fence" "$command" '[...]' 'crossed 0.9 % [0, 2] [...]' '[...]' 'trapped 3' '[...]' "$fence"
  renewed 0 "$fence" "$command" '[...]' 'crossed 1.5 % [1, 2] [...]' '[...]' 'trapped 3' '[...]' "$fence"
  shows "$fence" "$command" 'crossed 1' '[...]' 'nowhere 3' 'gates 1' "$fence" text
  renewed 1 "$fence" "$command" '[...]' 'crossed 1.5 % [1, 2] of all' '[...]' 'gates 4, 5' "$fence" text
  shows "${fence}sh" 'printf "%s\n" 1 2' "$fence" "${fence}text" 1 "$fence"
  renewed 0 "${fence}sh" 'printf "%s\n" 1 2' "$fence" "${fence}text" 1 2 "$fence"
  echo "all fine"
fi

failed=0
for page in "$@"; do
  began=$SECONDS
  rm -rf "$work/folder"
  mkdir "$work/folder"
  ln -s "$(dirname "$gatewalk")" "$work/folder/build"
  [ "$page" = cli/site/tutorial.md ] || ln -s "$root/scenes" "$work/folder/scenes"
  (cd "$work/folder" && "$python" "$root/tests/pages.py" "$root/$page" "${renew[@]}") || {
    [ ${#renew[@]} -gt 0 ] || exit 1
    failed=1  # the other pages are renewed all the same
  }
  echo "$page: $((SECONDS - began)) s"
done
exit $failed
