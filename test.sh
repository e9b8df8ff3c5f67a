#!/usr/bin/env bash
# Installs what is missing, builds, runs the tests. ./test.sh [ctest arguments], e.g. -R Impact
set -euo pipefail
cd "$(dirname "$0")"
. ./.ci/prepare
# Results and films as others read them, a browser that shows the pages, the layout of the code.
packages+=(libgtest-dev jq netcdf-bin ffmpeg chromium clang-format)
# Cells that other programs simulate: in Chipmunk, in Python.
packages+=(libchipmunk-dev)
# A cluster on this machine, for parts of runs; processes that share one.
packages+=(slurmctld slurmd slurm-client munge libopenmpi-dev openmpi-bin)
# The Python module, and what it makes tables and pictures with.
packages+=(pybind11-dev python3-dev python3-numpy python3-scipy python3-pandas python3-xarray python3-matplotlib python3-venv
  python3-pip python3-wheel mypy)
# Some machines bring an npm of their own, which Debian's package would conflict with.
command -v npm >/dev/null || packages+=(npm)
build_gatewalk -DBUILD_TESTING=ON -DGATEWALK_PYTHON=ON -DPython_EXECUTABLE=/usr/bin/python3
# What drives the browser, as package-lock.json fixes it, checksums included. Once per lock file.
web=tests/web
if ! cmp -s $web/package-lock.json $web/node_modules/.installed-lock; then
  npm ci --prefix $web --ignore-scripts --no-audit --no-fund --loglevel=error
  cp $web/package-lock.json $web/node_modules/.installed-lock
fi
# One more than there are processors: some tests wait, for a page or a signal.
ctest --test-dir build --output-on-failure -j $(($(nproc) + 1)) "$@"
