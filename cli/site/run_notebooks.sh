#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Executes the notebooks and writes them as pages: OUT/NAME.md with its pictures in OUT/NAME_files. A number that is not
# what the notebook says it is (an assertion) ends it with the cell and the error.
#   cli/site/run_notebooks.sh OUT [NAME...]      gatewalk importable (PYTHONPATH=build/python); PYTHON: which Python
# 77: what it needs is not installed.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
python=${PYTHON:-/usr/bin/python3}
mkdir -p "${1:?usage: run_notebooks.sh OUT [NAME...]}"
out=$(cd "$1" && pwd)
shift
missing=$("$python" -c 'import importlib.util as u
print(*(p for p in ("nbconvert", "ipykernel", "scipy", "pandas", "matplotlib") if u.find_spec(p) is None))')
if [ -n "$missing" ]; then
  echo "skipped: not installed for $python: $missing"
  exit 77
fi
[ $# -gt 0 ] || set -- $(cd "$here/notebooks" && ls ./*.ipynb | sed 's|^./||; s|\.ipynb$||')
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The kernel runs in the notebooks' folder.
PYTHONPATH=$("$python" -c 'import os
print(os.pathsep.join(map(os.path.abspath, filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep)))))')
export PYTHONPATH PYDEVD_DISABLE_FILE_VALIDATION=1
# A kernel of this Python, whatever kernels there are; nothing is written to the user's home.
export JUPYTER_DATA_DIR=$work/data JUPYTER_CONFIG_DIR=$work/config JUPYTER_RUNTIME_DIR=$work/runtime IPYTHONDIR=$work/ipython
export MPLCONFIGDIR=${MPLCONFIGDIR:-$work/matplotlib} PYTHONDONTWRITEBYTECODE=1
mkdir -p "$JUPYTER_DATA_DIR/kernels/python3"
printf '{"argv": ["%s", "-m", "ipykernel_launcher", "-f", "{connection_file}"], "display_name": "Python 3", "language": "python"}\n' \
  "$python" >"$JUPYTER_DATA_DIR/kernels/python3/kernel.json"
for name; do
  [ -f "$here/notebooks/$name.ipynb" ] || { echo "no notebook $name in $here/notebooks" >&2; exit 2; }
  began=$SECONDS
  "$python" -m nbconvert --to markdown --execute --ExecutePreprocessor.kernel_name=python3 --log-level WARN \
    --output-dir "$out" "$here/notebooks/$name.ipynb"
  echo "$name: $((SECONDS - began)) s"
done
