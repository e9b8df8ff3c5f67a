#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds, runs the tests. ./test.sh [ctest arguments], e.g. -R Impact
# ./test.sh elsewhere: the tests in other programs and places (Python's wheel, R, Octave, the site of the
# documentation, packages in a clean root), which need many packages and some minutes.
set -euo pipefail
cd "$(dirname "$0")"
. ./.ci/prepare
# Results and films as others read them, a browser that shows the pages, the layout of the code, locales.
packages+=(libgtest-dev jq netcdf-bin ffmpeg chromium clang-format locales)
# Cells that other programs simulate: in Chipmunk, in Python.
packages+=(libchipmunk-dev)
# A cluster on this machine, for parts of runs; processes that share one.
packages+=(slurmctld slurmd slurm-client munge libopenmpi-dev openmpi-bin)
# The Python module, and what it makes tables and pictures with.
packages+=(pybind11-dev python3-dev python3-numpy python3-scipy python3-pandas python3-xarray python3-netcdf4
  python3-matplotlib python3-venv python3-pip python3-wheel mypy python3-jsonschema)
which=(-LE elsewhere)
if [ "${1-}" = elsewhere ]; then
  shift
  which=(-L elsewhere)
  packages+=(python3-sphinx furo python3-myst-parser python3-breathe python3-yaml doxygen)
  packages+=(jupyter-nbconvert python3-ipykernel python3-nbformat)
  packages+=(python3-h5py r-base-core r-cran-ncdf4 r-cran-markovchain octave octave-netcdf)
  packages+=(mmdebstrap dpkg-dev lintian man-db zsh fish pkg-config reuse)
fi
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
ctest --test-dir build --output-on-failure -j $(($(nproc) + 1)) "${which[@]}" "$@"
