#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A project of its own finds the installed libraries, and compiles and runs the examples of cli/site/guides/library.md
# without further settings. Each installed header occurs in an example. The page's examples for programs inside the
# source tree also find the headers that are not installed. tests/library runs a cell of its own through the whole
# library.
#   library_test.sh BUILD ROOT CXX
set -euo pipefail
build=$1 root=$(realpath "$2") compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --component dev --prefix "$work/prefix" >/dev/null
mkdir "$work/project"
cp "$root"/tests/library/* "$work/project"

page=$root/cli/site/guides/library.md
# The page's examples in its order: name, what holds behind it (CHECK). inside_*: needs headers that are not installed.
examples=(
  'prediction|answer.error.total_variation < 0.06'
  'source|prediction.reached'
  'scene|scene.gate.forces.random == 20.0'
  'trials|tally.trials == 1000 && each.passed.size() == 1000'
  'validation|chance < 0.02 && v.starts[0].dynamics.final_cells.sum() == 1000 && !forgets && (v.starts[0].exact_against.total_variation < 0.2 || wrong)'
  'room|wrong.empty() && low > 0.03 && high < 0.07 && counts.totals().runs == 10000'
  'own_cell|low < std::pow(0.9, 5) && std::pow(0.9, 5) < high'
  'chain|std::abs(exact[Ending::far_edge] - double(walked[Ending::far_edge]) / 1e5) < 0.01'
  'counts|std::abs(ten_rows[Ending::far_edge] - std::pow(0.9, 10)) < 1e-12'
  'inside_passages|f.chance[start] > 0.1 && f.chance[start] < 0.3 && f.draws[start] > 4.0'
  'inside_decisions|robust.value[start] < best.value[start] && found.optima.front().gain > found.before'
  'inside_plan|(first == 0 || first == 1) && low > 0.1 && again.trials == 1000'
  'inside_design|best.crossings.share() > best.before.share()'
  'inside_fit|0.0 < low && low < high && high < 1.0'
)
[ "$(grep -c '^```cpp' "$page")" = ${#examples[@]} ] || { echo "$page has other examples than ${examples[*]%%|*}"; exit 1; }
# An example's includes stay in front, its statements become main(), which returns 0 where CHECK holds.
program() {  # NUMBER CHECK
  awk -v wanted="$1" '/^```cpp/ { inside = ++number == wanted; next } /^```/ { inside = 0 } inside' "$page" >"$work/example"
  grep '^#include' "$work/example"
  echo '#include <cmath>'
  echo 'int main() {'
  grep -v '^#include' "$work/example"
  echo "  return ($2) ? 0 : 1;"
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
  if(name MATCHES "^inside_")
    target_include_directories(${name} PRIVATE ${INSIDE})
  endif()
endforeach()
END
for number in "${!examples[@]}"; do
  example=${examples[number]}
  program $((number + 1)) "${example#*|}" >"$work/project/${example%%|*}.cpp"
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
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release -DINSIDE="$root" >/dev/null
cmake --build "$work/project/build" --parallel >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
ln -s "$root/scenes" "$work/scenes"  # examples name scenes/field.toml
cd "$work"                           # and two write a file
for example in "${examples[@]}"; do
  name=${example%%|*}
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
