#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The packages in a root of Debian 12 that has nothing else: they install with what they say they need, and run.
# Two minutes, as root, with a network.   clean_root_test.sh BUILD ROOT
set -euo pipefail
build=$(realpath "$1")
[ "$(id -u)" = 0 ] || { echo "needs root"; exit 77; }
for tool in mmdebstrap dpkg-shlibdeps; do command -v $tool >/dev/null || { echo "$tool is not installed"; exit 77; }; done
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
failures=0
fail() { echo "FAILED: $*"; failures=1; }
(cd "$build" && cpack -G DEB -B "$work/debs" >"$work/log" 2>&1) || { cat "$work/log"; exit 1; }
# The sources of packages that this machine has for Debian itself.
sources=/etc/apt/sources.list.d/debian.sources
[ -f $sources ] || sources=/etc/apt/sources.list
mmdebstrap --variant=minbase --skip=cleanup/apt bookworm "$work/root" $sources >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
root=$work/root
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/srv LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
cp "$work"/debs/*.deb "$root/tmp/"
du -sh "$root" | cut -f1 | sed 's/^/before: /'

# The program alone.
inside sh -c 'apt-get install -y -q --no-install-recommends /tmp/gatewalk_*.deb' >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
du -sh "$root" | cut -f1 | sed 's/^/with the program: /'
inside gatewalk --version | grep -q '^gatewalk [0-9]' || fail "--version"
inside sh -c 'cd /srv && gatewalk sample walker -o mine.toml && gatewalk predict mine.toml --accuracy 0.1 --seed 1 --json p.json --quiet' || fail "predict"
inside sh -c 'cd /srv && gatewalk build mine.toml --accuracy 0.2 -o m.nc --quiet >/dev/null && gatewalk export m.nc -o m.umb --quiet >/dev/null && test -s m.umb' || fail "build, export"
cp "$root/srv/mine.toml" "$work/"
"$build/gatewalk" predict "$work/mine.toml" --accuracy 0.1 --seed 1 --json "$work/p.json" --quiet
same() { python3 -c 'import json, sys; a, b = (json.load(open(f))["final_gates"] for f in sys.argv[1:]); sys.exit(a != b)' "$@"; }
same "$work/p.json" "$root/srv/p.json" || fail "other bits than here"
set +e
inside sh -c 'cd /srv && gatewalk predict mine.toml --accuracy 0.2 --figure x.svg' >"$work/log" 2>&1
[ $? = 2 ] && grep -q 'gnuplot was not found' "$work/log" || fail "without gnuplot: $(cat "$work/log")"
set -e

# The Python module, and the libraries for who builds on them.
inside sh -c 'apt-get install -y -q --no-install-recommends /tmp/python3-gatewalk_*.deb' >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
inside python3 -c '
import json, gatewalk as gw
p = gw.predict("/srv/mine.toml", accuracy=0.1, seed=1)
assert (p.final_gates == json.load(open("/srv/p.json"))["final_gates"]).all()' || fail "python"
inside sh -c 'apt-get install -y -q --no-install-recommends /tmp/libgatewalk-dev_*.deb g++ cmake make' >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
mkdir "$root/srv/own"
cat >"$root/srv/own/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(own CXX)
find_package(gatewalk 2.0 REQUIRED)
add_executable(own own.cpp)
target_link_libraries(own gatewalk::lattice)
END
cat >"$root/srv/own/own.cpp" <<'END'
#include <cstdio>
#include "lattice/lattice.h"
#include "lattice/scene/scene.h"
int main() { std::printf("%g\n", gatewalk::lattice::read_scene("/srv/mine.toml", {}).gate.body.mass); }
END
inside sh -c 'cd /srv/own && cmake -B b . && cmake --build b' >"$work/log" 2>&1 || { tail -n 20 "$work/log"; fail "a project of its own"; }
[ "$(inside /srv/own/b/own)" = 0.09 ] || fail "the project's answer"
[ $failures = 0 ] || exit 1
ls -l "$work"/debs/*.deb | awk '{ print $5, $9 }' | sed "s|$work/debs/||"
echo "all fine"
