#!/usr/bin/env bash
# Installs what is missing, builds, runs the tests. ./test.sh [ctest arguments], e.g. -R Impact
set -euo pipefail
cd "$(dirname "$0")"
. ./.ci/prepare
packages+=(chromium clang-format)  # shows the pages to their tests; checks the layout of the code
# Some machines bring an npm of their own, which Debian's package would conflict with.
command -v npm >/dev/null || packages+=(npm)
build_gatewalk -DBUILD_TESTING=ON
# What drives the browser, as package-lock.json fixes it, checksums included. Once per lock file.
web=tests/web
if ! cmp -s $web/package-lock.json $web/node_modules/.installed-lock; then
  npm ci --prefix $web --ignore-scripts --no-audit --no-fund --loglevel=error
  cp $web/package-lock.json $web/node_modules/.installed-lock
fi
ctest --test-dir build --output-on-failure -j "$(nproc)" "$@"
