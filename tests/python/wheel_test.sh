#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# `pip install .` without a network, into an environment of its own.   wheel_test.sh BUILD ROOT PYTHON
set -euo pipefail
build=$(realpath "$1") root=$(realpath "$2") python=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$python" -m venv --system-site-packages "$work/venv" 2>/dev/null || { echo "python3-venv is not installed"; exit 77; }
# Sources as they are, without what was built in them.
mkdir "$work/source"
(cd "$root" && git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$work/source")
cd "$work/source"
GATEWALK_BUILD=$build "$work/venv/bin/python" -m pip wheel --quiet --no-build-isolation --no-index --no-deps -w "$work" . 2>"$work/err" ||
  { cat "$work/err"; exit 1; }
ls -l "$work"/*.whl
"$work/venv/bin/python" -m pip install --quiet --no-index --no-deps "$work"/*.whl
cd "$work"
"$work/venv/bin/python" -c "
import gatewalk, sys
assert gatewalk.__file__.startswith(sys.prefix), gatewalk.__file__
print(gatewalk.__version__, gatewalk.predict('[forces]\npropulsion_N = 8.0\n', accuracy=0.2))"
