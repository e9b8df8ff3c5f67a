#!/usr/bin/env bash
# What takes too long for every change, each in a build folder of its own (build-odr, build-debug, build-clang):
#   tests/nightly.sh [odr] [debug] [clang]      all three without an argument; half an hour each on two cores
# odr    links the whole program with -flto -Wodr: no name may have two definitions. Without optimisation,
#        which inlines functions before their types are compared.
# debug  g++ without optimisation and batches: every file and every public header compiles alone; unit tests.
# clang  clang++, warnings are errors: unit tests and the command line's contract.
# What a step prints is in nightly-STEP.log; of one that fails the end is shown.
set -euo pipefail
cd "$(dirname "$0")/.."
. ./.ci/prepare

alone=(-DGATEWALK_BATCHES=OFF)
web='^(web_|figures$|library$)'  # tests that do not depend on the compiler, or build themselves

odr() {
  local flags='-flto=auto -Wodr -Werror=odr -Wlto-type-mismatch -Werror=lto-type-mismatch' small
  # The compiler sees it: among two files that differ in a struct.
  small=$(mktemp -d)
  for type in int double; do
    echo "struct Twice { $type a; }; int ${type}_of(const Twice& t) { return static_cast<int>(t.a); }" >"$small/$type.cpp"
  done
  echo 'int main() {}' >"$small/main.cpp"
  # shellcheck disable=SC2086
  if g++ $flags "$small"/*.cpp -o "$small/program" 2>"$small/log" || ! grep -q 'Werror=odr' "$small/log"; then
    echo "g++ does not report a type that is defined twice"
    return 1
  fi
  rm -r "$small"
  cmake -S . -B build-odr -G Ninja -DCMAKE_CXX_COMPILER=g++ -DCMAKE_AR="$(command -v gcc-ar)" -DCMAKE_RANLIB="$(command -v gcc-ranlib)" \
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_CXX_FLAGS="$flags" -DGATEWALK_BATCHES=OFF -DBUILD_TESTING=OFF
  cmake --build build-odr --target gatewalk
}

debug() {
  cmake -S . -B build-debug -G Ninja -DCMAKE_CXX_COMPILER=g++ -DCMAKE_BUILD_TYPE=Debug -DGATEWALK_WERROR=ON -DBUILD_TESTING=ON "${alone[@]}"
  cmake --build build-debug
  cmake --build build-debug --target all_verify_interface_header_sets
  ctest --test-dir build-debug --output-on-failure -j "$(nproc)" -E "$web|^program_" --timeout 7200
}

clang() {
  cmake -S . -B build-clang -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release -DGATEWALK_WERROR=ON -DBUILD_TESTING=ON
  cmake --build build-clang
  ctest --test-dir build-clang --output-on-failure -j "$(nproc)" -E "$web"
}

[ $# -gt 0 ] || set -- odr debug clang
for step in "$@"; do
  case $step in odr | debug | clang) ;; *) echo "no step '$step': odr, debug, clang" >&2; exit 2 ;; esac
done
case " $* " in *" clang "*) packages+=(clang) ;; esac
if command -v apt-get >/dev/null; then install_missing; fi
failed=0
for step in "$@"; do
  echo "$step ... (nightly-$step.log)"
  set +e  # a step ends at its first error, the others run
  (set -e; "$step") >"nightly-$step.log" 2>&1
  status=$?
  set -e
  [ $status = 0 ] || { tail -n 40 "nightly-$step.log"; echo "FAILED: $step"; failed=1; }
done
exit $failed
