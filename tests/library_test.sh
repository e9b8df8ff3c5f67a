#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A project of its own finds the installed libraries, and compiles and runs the READMEs' examples with nothing added.
# Each installed header is in one of them; and a cell that is not ours (tests/library) goes all the way.
#   library_test.sh BUILD ROOT CXX
set -euo pipefail
build=$1 root=$(realpath "$2") compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --component dev --prefix "$work/prefix" >/dev/null
mkdir "$work/project"
cp "$root"/tests/library/* "$work/project"

# Name, README, which of its examples that begin with #include, what holds behind it (CHECK).
examples=(
  'prediction|README.md|1|answer.error.total_variation < 0.06'
  'room|dynamics/README.md|1|wrong.empty() && low > 0.03 && high < 0.07 && counts.totals().runs == 10000'
  'chain|markov/README.md|1|std::abs(exact[Ending::far_edge] - double(walked[Ending::far_edge]) / 1e5) < 0.01'
  'counts|markov/README.md|2|std::abs(ten_rows[Ending::far_edge] - std::pow(0.9, 10)) < 1e-12'
  'source|lattice/README.md|1|prediction.reached'
  'trials|lattice/README.md|2|tally.trials == 1000 && each.passed.size() == 1000'
  'validation|lattice/README.md|3|chance < 0.02 && v.starts[0].dynamics.final_cells.sum() == 1000 && !forgets && (v.starts[0].exact_against.total_variation < 0.2 || wrong)'
  'own_cell|lattice/README.md|4|low < std::pow(0.9, 5) && std::pow(0.9, 5) < high'
  'scene|lattice/README.md|5|scene.gate.forces.random == 20.0'
)
# An example's includes stay in front, its statements become main(), which returns 0 where CHECK holds.
program() {  # README NUMBER CHECK
  awk -v wanted="$2" '/^```cpp/ { first = 1; next } /^```/ { inside = 0 }
    first { first = 0; if (/^#include/) inside = ++number == wanted } inside' "$1" >"$work/example"
  grep '^#include' "$work/example"
  echo '#include <cmath>'
  echo 'int main() {'
  grep -v '^#include' "$work/example"
  echo "  return $3 ? 0 : 1;"
  echo '}'
}
cat >"$work/project/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(elsewhere LANGUAGES CXX)
find_package(gatewalk REQUIRED)
file(GLOB programs *.cpp)
foreach(program ${programs})
  cmake_path(GET program STEM name)
  add_executable(${name} ${program})
  target_link_libraries(${name} PRIVATE gatewalk::lattice)
endforeach()
END
for example in "${examples[@]}"; do
  IFS='|' read -r name readme number check <<<"$example"
  program "$root/$readme" "$number" "$check" >"$work/project/$name.cpp"
done
(cd "$work/prefix/include/gatewalk" && find . -name '*.h' | sed 's|^\./||') | while read -r header; do
  grep -qxF "#include \"$header\"" "$work"/project/*.cpp || { echo "$header is installed, and in no example"; exit 1; }
done
! grep -rE '#include <(tbb|toml|fmt|nlohmann|netcdf|Random123|hwy)' "$work/prefix/include" || exit 1

# pkg-config says where they are, not where they were configured to be.
if command -v pkg-config >/dev/null; then
  pc=$(find "$work/prefix" -name gatewalk.pc)
  export PKG_CONFIG_PATH=${pc%/*}
  [ -f "$(pkg-config --variable=includedir gatewalk)/lattice/lattice.h" ] || { cat "$pc"; exit 1; }
  [ -f "$(pkg-config --variable=libdir gatewalk)/libgatewalk_lattice.a" ] || { cat "$pc"; exit 1; }
fi

cmake -S "$work/project" -B "$work/project/build" -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/project/build" --parallel >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cd "$root"  # examples name scenes/field.toml
for example in "${examples[@]}"; do
  name=${example%%|*}
  case $name in counts) cd "$work" ;; *) cd "$root" ;; esac  # it writes a file
  "$work/project/build/$name" >"$work/$name.out" || { echo "$name: $example"; cat "$work/$name.out"; exit 1; }
done
cd "$root"
"$build/gatewalk" predict scenes/field.toml --accuracy 0.05 --quiet --csv - |
  awk -F, 'sub("endings[.]", "", $1) { printf "%s %.4f [%.4f, %.4f]\n", $1, $4, $5, $6 } $1 == "error_95" { bar = $4 }
    END { printf "total variation of the final gates, 95 %%: %.4f\n", bar }' | diff - "$work/source.out"
# How far the points of a Lorentz gas get, by a chain and by trials; and what is no cell.
"$work/project/build/lorentz" 0.2
if "$work/project/build/lorentz" 0.31 2>"$work/refused"; then exit 1; fi
grep -q 'there is no diffusion coefficient' "$work/refused"
