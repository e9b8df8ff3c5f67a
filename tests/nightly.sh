#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that take too long for every change, each in its own build folder (build-odr, build-alone ...):
#   tests/nightly.sh [odr] [alone] [small] [debug] [clang] [address] [thread] [reproducible] [fuzz] [coverage]
# Without an argument, all of them.
# odr    links the whole program with -flto -Wodr: no name may have two definitions. Without optimisation,
#        which inlines functions before their types are compared. Two definitions within one batch of
#        sources are an error of the compiler; the linker compares the batches.
# alone  every source and every public header compiles without what others include before it: g++ without
#        batches reads and checks them, and writes no code, which takes half the time.
# small  without films and pages, as on a cluster: needs neither cairo nor libpng, and says so when asked for them.
# debug  g++ with the checks of the standard library, of Eigen and of TBB: unit tests. -Og, with which those
#        of the dynamics take three to four times as long as in a Release build.
# clang  clang++ 16, the first that reads lambdas which capture structured bindings; warnings are errors: unit tests and the
#        contract of the command line.
# address  all tests but those of Python and of pages in a browser, with the sanitizers of addresses and undefined behaviour (clang): no finding.
#        What is forgiven is in tests/sanitizers (Open MPI's leaks: tests/mpi_test.sh), with its reason. Lanes are not instrumented (dynamics/CMakeLists.txt):
#        that takes compilers hours. Their plain references are; and a program whose
#        lanes are, without optimisation, must have the same results over some command lines.
# thread the same with the sanitizer of threads, and with a TBB built with it too, from Debian's sources: what that
#        library synchronises cannot be seen otherwise.
# reproducible  the sources of the last commit, built in two folders of other names: the packages have the
#        same bytes.
# fuzz   every reader is handed input of any kind, SECONDS_EACH=60 seconds a target, by libFuzzer with clang's
#        sanitizers (tests/fuzz/run.sh): executions by target, no finding.
# coverage  which lines and branches of dynamics, markov and lattice the ordinary tests run (clang; a branch is a condition,
#        true or false): results/reliability/coverage.csv; the log lists what none runs.
#        Fails under 95 % of lines or 90 % of branches.
# No step runs tests with their full counts (tests/support/long.h), which can take hours. One at a time:
#   GATEWALK_LONG=1 build/tests/lattice_tests --gtest_filter=Fit.AFieldThatIsItsMirrorImageHasBothHills     12 seeds, not 4
#   GATEWALK_LONG=1 build/tests/dynamics_tests --gtest_filter=RandomScenes.StableAndEvent*     10 000 scenes, also the slow 15
# tests/mutants.py checks whether tests notice a mistake in a line that they run. The output of a step goes to
# nightly-STEP.log; the end of a failed step's log is shown.
set -euo pipefail
cd "$(dirname "$0")/.."
. ./.ci/prepare
. ./results/manifest.sh

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
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_CXX_FLAGS="$flags" -DBUILD_TESTING=OFF
  cmake --build build-odr --target gatewalk
}

alone() {
  cmake -S . -B build-alone -G Ninja -DCMAKE_CXX_COMPILER=g++ -DCMAKE_BUILD_TYPE=Debug -DGATEWALK_WERROR=ON \
    -DGATEWALK_BATCHES=OFF -DBUILD_TESTING=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
  # Headers stand there as sources that include nothing else.
  jq -j '.[] | select(.file | test("[.](cpp|cxx)$")) | "cd \(.directory) && \(.command) -fsyntax-only\u0000"' \
    build-alone/compile_commands.json >build-alone/commands
  local number
  number=$(tr -cd '\0' <build-alone/commands | wc -c)
  [ "$number" -gt 400 ] || { echo "only $number sources and headers"; return 1; }
  xargs -0 -n 1 -P "$(nproc)" sh -c <build-alone/commands
  echo "$number sources and headers compile alone"
}

small() {
  cmake -S . -B build-small -G Ninja -DCMAKE_BUILD_TYPE=Release -DGATEWALK_WERROR=ON -DGATEWALK_VIDEO=OFF -DGATEWALK_PAGES=OFF
  cmake --build build-small
  if ldd build-small/gatewalk | grep -E 'cairo|png'; then return 1; fi
  build-small/gatewalk predict scenes/field.toml --accuracy 0.1 | grep 'crossed'
  refused 'needs films' trace scenes/field.toml --video build-small/x.gif
  refused 'needs pages' trace scenes/field.toml --replay build-small/x.html
  cp scenes/field.toml build-small/map.toml
  printf '[terrain]\nmap_file = "map.png"\ngrey = { "." = 255 }\n' >>build-small/map.toml
  : >build-small/map.png
  refused 'without pictures' lattice build-small/map.toml
}
# refused TEXT COMMAND...: of the build without films and pages.
refused() {
  local text=$1 status
  shift
  set +e
  build-small/gatewalk "$@" >build-small/out.txt 2>&1
  status=$?
  set -e
  [ $status = 2 ] && grep "$text" build-small/out.txt
}

debug() {
  cmake -S . -B build-debug -G Ninja -DCMAKE_CXX_COMPILER=g++ -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG='-Og -D_GLIBCXX_ASSERTIONS' -DGATEWALK_WERROR=ON -DBUILD_TESTING=ON
  cmake --build build-debug
  ctest --test-dir build-debug --output-on-failure -j "$(nproc)" -E "$web|^program_"
}

clang() {
  cmake -S . -B build-clang -G Ninja -DCMAKE_CXX_COMPILER=clang++-16 -DCMAKE_BUILD_TYPE=Release -DGATEWALK_WERROR=ON -DBUILD_TESTING=ON
  cmake --build build-clang
  ctest --test-dir build-clang --output-on-failure -j "$(nproc)" -E "$web"
}

address() {
  sanitized address
  local source objects=()
  rm -f build-address/{lanes.o,stable_lanes.o,gatewalk_lanes}
  for source in lanes stable_lanes; do
    (cd build-address && eval "$(ninja -t compdb | jq -r ".[] | select(.file | endswith(\"disc/$source.cpp\")).command" |
      sed "s/ -O2 / -O0 /; s/ -fno-sanitize=all -O2\\( -m[^ ]*\\)* / /; s# -MD -MT .* -o [^ ]*# -o $source.o#")")
    nm "build-address/$source.o" | grep __asan_report >/dev/null  # it is instrumented
    objects+=("$source.o")
  done
  (cd build-address && eval "$(ninja -t commands gatewalk | tail -n 1 | cut -d '&' -f 3 |
    sed "s# -o gatewalk # -o gatewalk_lanes -Wl,-z,muldefs ${objects[*]} #")")
  tests/same_results.sh --lines '^0 (gate (field.toml --tr|soft_left.toml --set run.method=moreau|robot|own|undamped|overdamped)|lattice (own|map))' \
    build-address/gatewalk build-address/gatewalk_lanes
}
thread() {
  local tbb=$PWD/build-thread-tbb
  if [ ! -f "$tbb/lib/libtbb.so" ]; then
    mkdir -p "$tbb/apt/parts" "$tbb/lists/partial"
    local list
    for list in /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list; do
      [ ! -f "$list" ] || sed 's/^Types: deb$/Types: deb-src/; s/^deb /deb-src /' "$list" >"$tbb/apt/parts/debian.${list##*.}"
    done
    (cd "$tbb" && sources=(-o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$tbb/apt/parts" -o "Dir::State::lists=$tbb/lists") &&
      apt-get "${sources[@]}" update && apt-get "${sources[@]}" source onetbb)
    cmake -S "$tbb"/onetbb-* -B "$tbb/build" -G Ninja -DCMAKE_CXX_COMPILER=clang++-16 -DCMAKE_C_COMPILER=clang-16 -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_SANITIZE=thread -DTBB_STRICT=OFF -DTBB_TEST=OFF \
      -DTBBMALLOC_BUILD=OFF -DCMAKE_INSTALL_PREFIX="$tbb" -DCMAKE_INSTALL_LIBDIR=lib
    cmake --build "$tbb/build"
    cmake --install "$tbb/build"
  fi
  export LD_LIBRARY_PATH=$tbb/lib
  sanitized thread -DCMAKE_PREFIX_PATH="$tbb"
}
sanitized() {
  local kind=$1
  shift
  cmake -S . -B "build-$kind" -G Ninja -DCMAKE_CXX_COMPILER=clang++-16 -DCMAKE_C_COMPILER=clang-16 -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG='-O2 -g1' \
    -DGATEWALK_SANITIZE="$kind" -DBUILD_TESTING=ON "$@"
  cmake --build "build-$kind"  # at -O1 clang inlines nothing, which takes ten times as long
  # SANITIZED: shell tests leave out what bounds a program's memory, of which these need terabytes of addresses.
  export SANITIZED=1 UBSAN_OPTIONS=print_stacktrace=1 LSAN_OPTIONS="print_suppressions=0:suppressions=$PWD/tests/sanitizers/leaks.txt"
  export TSAN_OPTIONS="halt_on_error=1 suppressions=$PWD/tests/sanitizers/races.txt"
  ctest --test-dir "build-$kind" --output-on-failure -j "$(nproc)" -LE elsewhere -E "$web" --timeout 7200
}

reproducible() {
  local work commit folder
  work=$(mktemp -d)
  commit=$(git rev-parse HEAD)
  export SOURCE_DATE_EPOCH
  SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
  for folder in a a/longer/name; do
    mkdir -p "$work/$folder"
    git archive --prefix=source/ "$commit" | tar -x -C "$work/$folder"
    # Each compiled anew.
    CCACHE_DISABLE=1 cmake -S "$work/$folder/source" -B "$work/$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF \
      -DGATEWALK_PYTHON=ON -DPython_EXECUTABLE=/usr/bin/python3 -DGATEWALK_COMMIT="${commit:0:12}"
    CCACHE_DISABLE=1 cmake --build "$work/$folder/build"
    (cd "$work/$folder/build" && cpack -G DEB)
  done
  sha256sum "$work"/a/build/*.deb "$work"/a/longer/name/build/*.deb
  for folder in "$work"/a/build/*.deb; do cmp "$folder" "$work/a/longer/name/build/$(basename "$folder")"; done
  rm -rf "$work"
}

fuzz() { tests/fuzz/run.sh; }

coverage() {
  local module binary objects=() out=results/reliability all=build-coverage/all.profdata
  # Vectorised sources for one instruction set only: each is the same source.
  local lanes=-O2
  [ "$(uname -m)" != x86_64 ] || lanes='-O2 -march=x86-64-v3 -maes -mpclmul'
  cmake -S . -B build-coverage -G Ninja -DCMAKE_CXX_COMPILER=clang++-16 -DCMAKE_C_COMPILER=clang-16 -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG="$lanes -fprofile-instr-generate -fcoverage-mapping -DHWY_COMPILE_ONLY_STATIC" -DBUILD_TESTING=ON
  cmake --build build-coverage
  rm -rf build-coverage/profiles
  export LLVM_PROFILE_FILE=$PWD/build-coverage/profiles/%4m.profraw
  ctest --test-dir build-coverage --output-on-failure -j "$(nproc)" -LE elsewhere -E "$web|^(schemas|slurm|mpi|python)$" --timeout 3000
  llvm-profdata-16 merge -sparse build-coverage/profiles/*.profraw -o $all
  for binary in build-coverage/tests/*_tests; do objects+=(-object "$binary"); done
  echo "module,lines_percent,branches_percent" >$out/coverage.csv
  for module in dynamics markov lattice; do
    llvm-cov-16 export build-coverage/gatewalk "${objects[@]}" -instr-profile $all "$PWD/$module" >build-coverage/$module.json
    # A condition of a template is one, whatever it is made for.
    jq '[.data[0].files[] | .filename as $file | [.branches | group_by(.[:4])[] |
      {at: "\($file):\(.[0][0])", true: (map(.[4]) | add), false: (map(.[5]) | add)}]] | add' \
      build-coverage/$module.json >build-coverage/$module-branches.json
    jq -r '.data[0].files[] | .filename as $file | .segments[] | select(.[2] == 0 and .[3] and .[4]) | "\($file):\(.[0]): not run"' \
      build-coverage/$module.json | sort -u
    jq -r '.[] | select((.true == 0) != (.false == 0)) | "\(.at): never \(if .true == 0 then "true" else "false" end)"' \
      build-coverage/$module-branches.json | sort -u
    jq -r --arg name "$module" --slurpfile of build-coverage/$module-branches.json '[$name, .data[0].totals.lines.percent,
      ($of[0] | 100 * (map((.true, .false) | select(. > 0)) | length) / (2 * length))] | join(",")' \
      build-coverage/$module.json >>$out/coverage.csv
  done
  gatewalk=build-coverage/gatewalk
  manifest "tests/nightly.sh coverage" >$out/coverage.txt
  echo "date: $(date -I)" >>$out/coverage.txt
  cat $out/coverage.csv
  awk -F, 'NR > 1 && ($2 < 95 || $3 < 90) { print $1 ": too little is run"; few = 1 } END { exit few }' $out/coverage.csv
}

steps=(odr alone small debug clang address thread reproducible fuzz coverage)
[ $# -gt 0 ] || set -- "${steps[@]}"
for step in "$@"; do
  case " ${steps[*]} " in *" $step "*) ;; *) echo "no step '$step': ${steps[*]}" >&2; exit 2 ;; esac
done
case " $* " in *" clang "* | *" fuzz "* | *" address "* | *" thread "* | *" coverage "*) packages+=(clang-16 libclang-rt-16-dev) ;; esac
case " $* " in *" reproducible "*) packages+=(pybind11-dev python3-dev python3-numpy) ;; esac
case " $* " in *" alone "*) packages+=(jq libgtest-dev) ;; esac
case " $* " in *" coverage "*) packages+=(llvm-16) ;; esac
case " $* " in *" thread "*) packages+=(dpkg-dev) ;; esac
case " $* " in *" debug "* | *" clang "* | *" address "* | *" thread "* | *" coverage "*)  # what tests need
  packages+=(libgtest-dev jq netcdf-bin ffmpeg libchipmunk-dev libopenmpi-dev openmpi-bin slurmctld slurmd slurm-client munge) ;;
esac
if command -v apt-get >/dev/null; then install_missing; fi
failed=0
for step in "$@"; do
  echo "$step ... (nightly-$step.log)"
  set +e  # a step ends at its first error, the others run
  (set -e; "$step") >"nightly-$step.log" 2>&1
  status=$?
  set -e
  grep -E '^[0-9]+% tests passed|^[0-9]+ command lines with' "nightly-$step.log" || true
  [ $status = 0 ] || { tail -n 40 "nightly-$step.log"; echo "FAILED: $step"; failed=1; }
done
exit $failed
