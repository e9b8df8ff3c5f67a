#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The same bits? The program by other compilers, optimisation, instruction sets, processors, threads and ranks beside
# the release build, over the command lines of tests/same_results.sh that LINES finds.
#   [BUILD=build] [LINES=...] results/reliability/bits.sh [VARIANT...]      without names all, an hour on two cores
# Writes bits.csv: variant, lines that are the same, lines that differ, commit, date; bits.txt, of the last command.
# golden.csv has a hash for each line, written if it is not there, else compared: to be removed where results change on
# purpose.
# Rows of variants that are not named stay.
# gcc-O0 ... clang-O3: compilers (the release build is gcc -O3).   threads-1, -2, -32.   ranks-2, -4: MPI (gatewalk_mpi of a build with tests).
# avx2, sse2: compiled without AVX-512, without AVX2 too; libm: glibc's sin, exp, log without fused multiply-add.
# arm64, s390x: cross-compiled, with Debian's libraries for them, in qemu; s390x has the other order of bytes, and reads
# the matrices that it made itself.
set -euo pipefail
shopt -s inherit_errexit  # what makes a variant may not go on after an error
root=$(realpath "$(dirname "$0")/../..")
build=$(realpath "${BUILD:-$root/build}")
gatewalk=$build/gatewalk
out=$root/results/reliability
work=$root/build-bits
some='gate (field.toml --trials|single|soft|stiff|robot|own|over)|sweep own|build (field.toml --trials|own|mixed)'
some+='|walk (own|mixed)|predict (matrix.nc --json|own|mixed.nc --set terrain|robot|field.toml --accuracy|map)'
some+='|lattice (field.toml --trials|own|map|mixed)|analyze tree.nc --runs|rare mixed|validate own'
some+='|power field.toml --accuracy 0.1 --trials|plan|design|fit|analyze field.toml .*--over'
lines=${LINES:-"^0 ($some)"}
. "$root/results/manifest.sh"
. "$root/.ci/prepare"
mkdir -p "$work"
mpirun="mpirun --allow-run-as-root --oversubscribe -n"
hwcaps=glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA,-FMA4
all=(gcc-O0 gcc-O1 gcc-O2 clang-O2 clang-O3 threads-1 threads-2 threads-32 ranks-2 ranks-4 avx2 sse2 libm)
all+=(arm64 s390x)
[ $# -gt 0 ] || set -- "${all[@]}"
packages+=(jq netcdf-bin hdf5-tools openmpi-bin libopenmpi-dev qemu-user clang-16 g++-aarch64-linux-gnu g++-s390x-linux-gnu)
install_missing

program() { # FOLDER [CMAKE-OPTION...]
  rm -f "$work/$1/gatewalk"
  if ! { cmake -S "$root" -B "$work/$1" -G Ninja -DBUILD_TESTING=OFF "${@:2}" && cmake --build "$work/$1" --target gatewalk; } \
    >"$work/$1.log" 2>&1; then
    tail "$work/$1.log" >&2
    return 1
  fi
}
compiled() { program "$1" -DCMAKE_CXX_COMPILER="$2" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="$3 -DNDEBUG"; }
release() { # FOLDER SETS
  program "$1" -DCMAKE_BUILD_TYPE=Release -DGATEWALK_WITHOUT_HWY="$2"
  echo "$work/$1/gatewalk"
}
wrapped() { # NAME WORDS: a program that runs them before the arguments; {} is the program
  printf '#!/bin/sh\nexec %s\n' "$2" >"$work/$1.sh"
  chmod +x "$work/$1.sh"
}
# Debian's libraries for another architecture, unpacked into a folder.
libraries() { # ARCHITECTURE
  local folder=$work/$1-root options
  [ ! -e "$folder/done" ] || return 0
  mkdir -p "$folder"/apt/{parts,lists/partial,cache/archives/partial}
  : >"$folder/apt/status"
  local list
  for list in /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list; do
    [ ! -f "$list" ] || cp "$list" "$folder/apt/parts/debian.${list##*.}"
  done
  options=(-o "APT::Architecture=$1" -o "APT::Architectures=$1" -o APT::Sandbox::User=root
    -o "Dir::State::lists=$folder/apt/lists" -o "Dir::State::status=$folder/apt/status"
    -o "Dir::Cache=$folder/apt/cache" -o Dir::Etc::sourcelist=/dev/null
    -o "Dir::Etc::sourceparts=$folder/apt/parts")
  apt-get "${options[@]}" update >"$work/$1-apt.log"
  apt-get "${options[@]}" install --download-only -y --no-install-recommends libeigen3-dev libsuitesparse-dev \
    libboost-program-options-dev libnetcdf-dev libfmt-dev libtbb-dev libhwy-dev librandom123-dev libtomlplusplus-dev \
    nlohmann-json3-dev zlib1g-dev libarchive-dev >>"$work/$1-apt.log"
  local deb
  for deb in "$folder"/apt/cache/archives/*.deb; do dpkg-deb -x "$deb" "$folder"; done
  local link
  find "$folder/usr" "$folder/lib" -type l -lname '/*' | while read -r link; do ln -sfn "$folder$(readlink "$link")" "$link"; done
  # There libraries have absolute paths.
  sed -i "s#;\(/usr/lib/\)#;$folder\1#g" "$folder"/usr/lib/*/cmake/netCDF/netCDFTargets.cmake
  touch "$folder/done"
}
# math.h of the C++ library, which the folder's own would hide.
crossed() { # ARCHITECTURE PROCESSOR
  libraries "$1"
  program "$1" -DCMAKE_BUILD_TYPE=Release -DGATEWALK_VIDEO=OFF -DGATEWALK_PAGES=OFF -DCMAKE_SYSTEM_NAME=Linux \
    -DCMAKE_SYSTEM_PROCESSOR="$2" -DCMAKE_CXX_COMPILER="$2-linux-gnu-g++" -DCMAKE_ASM_COMPILER="$2-linux-gnu-gcc" \
    -DCMAKE_CXX_FLAGS="-include /usr/$2-linux-gnu/include/c++/$("$2-linux-gnu-g++" -dumpversion)/math.h" \
    -DCMAKE_SYSROOT="$work/$1-root" -DCMAKE_LIBRARY_ARCHITECTURE="$2-linux-gnu" \
    -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER \
    -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY \
    -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY
  wrapped "$1" "qemu-$2 -L '$work/$1-root' '$work/$1/gatewalk' \"\$@\""
}
case " $* " in *" ranks-"*) [ -x "$build/tests/gatewalk_mpi" ] || { echo "ranks need a build with tests and MPI" >&2; exit 2; } ;; esac
made() { # VARIANT: makes it, and says where the program is
  local option=-${1##*-}
  rm -f "$work/$1.sh"
  case $1 in
    gcc-*)
      compiled "$1" g++ "$option"
      echo "$work/$1/gatewalk" ;;
    clang-*)
      compiled "$1" clang++-16 "$option"
      echo "$work/$1/gatewalk" ;;
    threads-*) wrapped "$1" "'$gatewalk' \"\$@\" --threads ${1#threads-}" ;;
    ranks-*) wrapped "$1" "$mpirun ${1#ranks-} '$build/tests/gatewalk_mpi' \"\$@\"" ;;
    avx2) release avx2 HWY_AVX3 ;;
    sse2) release sse2 'HWY_AVX3|HWY_AVX2' ;;
    libm) wrapped "$1" "env GLIBC_TUNABLES=$hwcaps '$gatewalk' \"\$@\"" ;;
    arm64) crossed arm64 aarch64 ;;
    s390x) crossed s390x s390x ;;
    *) echo "no variant '$1': ${all[*]}" >&2; return 2 ;;
  esac
  [ ! -e "$work/$1.sh" ] || echo "$work/$1.sh"
}
table=$out/bits.csv
[ -e "$table" ] || echo "variant,same,differ,program,date" >"$table"
failed=0
for variant in "$@"; do
  other=$(made "$variant" | tail -n 1)
  [ -n "$other" ] || exit 1
  options=(--lines "$lines")
  [ "$variant" != s390x ] || options+=(--other-byte-order)
  "$root/tests/same_results.sh" "${options[@]}" "$gatewalk" "$other" >"$work/$variant.result" || failed=1
  grep -q 'command lines with the same' "$work/$variant.result" || { echo "$variant: nothing was compared"; exit 1; }
  row=$variant,$(sed -n 's/^\([0-9]*\) command lines with the same results, \([0-9]*\) with others$/\1,\2/p' \
    "$work/$variant.result"),$("$gatewalk" --version | sed 's/.*(\(.*\))/\1/'),$(date -I)
  { grep -v "^$variant," "$table"; echo "$row"; } >"$table.new"
  mv "$table.new" "$table"
  echo "$row"
  grep '^DIFFERS' "$work/$variant.result" | cut -c1-300 || true
done
if [ -z "${LINES-}" ]; then
  "$root/tests/same_results.sh" --lines "$lines" --hashes "$work/golden.csv" "$gatewalk" "$gatewalk"
  [ -e "$out/golden.csv" ] || cp "$work/golden.csv" "$out"
  diff "$out/golden.csv" "$work/golden.csv" || { echo "other hashes than those of golden.csv"; failed=1; }
fi
manifest "${LINES:+LINES='$LINES' }results/reliability/bits.sh $*" >"$out/bits.txt"
{
  echo "date: $(date -I)"
  for program in g++ clang++-16 qemu-x86_64; do "$program" --version | head -n 1; done
} >>"$out/bits.txt"
exit $failed
