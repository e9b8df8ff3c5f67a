#!/usr/bin/env bash
# Installs what is missing, builds, runs the tests. ./test.sh [ctest arguments], e.g. -R Impact
set -euo pipefail
cd "$(dirname "$0")"
. ./.ci/prepare
packages+=(chromium clang-format)  # shows the pages to their tests; checks the layout of the code
build_gatewalk -DBUILD_TESTING=ON
ctest --test-dir build --output-on-failure -j "$(nproc)" "$@"
