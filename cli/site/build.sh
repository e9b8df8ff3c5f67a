#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the documentation site.   cli/site/build.sh PROGRAM PYTHONPATH OUT
# PROGRAM is the built gatewalk, PYTHONPATH where `import gatewalk` finds the module of the same build. The site lands
# in OUT/html, what it is made of beside it. Exit status 77: something that it needs is not installed, which is named.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
program=$(realpath "$1") modules=$(realpath "$2")
mkdir -p "$3"
out=$(realpath "$3")
python=/usr/bin/python3
for tool in doxygen gnuplot; do command -v $tool >/dev/null || { echo "$tool is not installed"; exit 77; }; done
for module in sphinx furo myst_parser breathe yaml numpy scipy pandas xarray matplotlib; do
  $python -c "import $module" 2>/dev/null || { echo "Python's $module is not installed"; exit 77; }
done
export PYTHONPATH=$modules PYTHONDONTWRITEBYTECODE=1 GATEWALK_ROOT=$root GATEWALK_XML=$out/work/headers/xml
notebooks=()
if [ -e "$here/run_notebooks.sh" ]; then
  rm -rf "$out/notebooks"
  "$here/run_notebooks.sh" "$out/notebooks"
  notebooks=("$out/notebooks")
fi
$python "$here/prepare.py" "$root" "$program" "$out/source" "${notebooks[@]}"
rm -rf "$out/html"
$python -m sphinx -W --keep-going -q -j auto -b html -c "$here" -d "$out/doctrees" "$out/source" "$out/html"
echo "$out/html/index.html"
