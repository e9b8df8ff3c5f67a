#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installed files: Debian packages pass lintian and have bytes that do not depend on the time; manual pages have no
# warnings; completion works in three shells; pkg-config serves a project.   packages_test.sh BUILD ROOT
set -euo pipefail
build=$(realpath "$1") root=$(realpath "$2")
for tool in lintian man zsh fish pkg-config; do command -v $tool >/dev/null || { echo "$tool is not installed"; exit 77; }; done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() { echo "FAILED: $*"; failures=1; }
cd "$work"
export SOURCE_DATE_EPOCH=1764072000
for time in 1 2; do
  (cd "$build" && cpack -G DEB -B "$work/$time" >"$work/log" 2>&1) || { cat log; exit 1; }
  sleep 1
done
for deb in 1/*.deb; do
  cmp -s "$deb" "2/${deb#1/}" || fail "$deb: other bytes the second time"
  lintian --fail-on error "$deb" >lint 2>&1 || fail "$deb: $(cat lint)"
done
ls -l 1/*.deb
for deb in 1/*.deb; do dpkg-deb -x "$deb" installed; done
share=installed/usr/share
for page in $share/man/man1/*.1.gz; do
  [ -z "$(man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null)" ] || fail "$page: warnings"
  lexgrog "$page" >/dev/null || fail "$page: no name"
done
[ "$(find $share/man -name '*.gz' | wc -l)" -gt 20 ] || fail "pages are missing"
bash -c '. '$share'/bash-completion/completions/gatewalk; COMP_WORDS=(gatewalk pre) COMP_CWORD=1; _gatewalk; echo "${COMPREPLY[@]}"
  COMP_WORDS=(gatewalk predict --accu) COMP_CWORD=2; _gatewalk; echo "${COMPREPLY[@]}"
  COMP_WORDS=(gatewalk chart f) COMP_CWORD=2; _gatewalk; echo "${COMPREPLY[@]}"
  COMP_WORDS=(gatewalk chart field --tr) COMP_CWORD=3; _gatewalk; echo "${COMPREPLY[@]}"' >bash.txt
[ "$(cat bash.txt)" = "predict
--accuracy
field
--trials" ] || fail "bash completes: $(cat bash.txt)"
zsh -n $share/zsh/vendor-completions/_gatewalk || fail "zsh"
fish -c "source $share/fish/vendor_completions.d/gatewalk.fish; complete -C 'gatewalk predict --accu'; complete -C 'gatewalk chart field --tr'" >fish.txt
[ "$(grep -c -e '^--accuracy' -e '^--trials' fish.txt)" = 2 ] || fail "fish completes: $(cat fish.txt)"
installed/usr/bin/gatewalk --version | grep -q gatewalk || fail "the program"
[ -s $share/gatewalk/scenes/robot.toml ] || fail "no scenes"
PYTHONPATH=installed/usr/lib/python3/dist-packages /usr/bin/python3 -c 'import gatewalk; print(gatewalk.__version__)' || fail "python"
# A project that uses pkg-config alone.
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cat >own.cpp <<'END'
#include <cstdio>
#include "lattice/lattice.h"
int main() { std::printf("%g\n", gatewalk::lattice::read_scene("field.toml", {}).gate.body.mass); }
END
cp "$root/scenes/field.toml" .
pc=$(find prefix -name gatewalk.pc)
export PKG_CONFIG_PATH=${pc%/*}
# shellcheck disable=SC2046
g++ own.cpp $(pkg-config --cflags gatewalk) -o own $(pkg-config --libs gatewalk) 2>log || fail "pkg-config: $(head -20 log)"
[ "$(./own)" = 1 ] || fail "the consumer"
[ $failures = 0 ] || exit 1
echo "all fine"
