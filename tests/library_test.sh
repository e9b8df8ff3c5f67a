#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A project of its own finds the installed libraries and compiles the READMEs' examples with nothing added, and
# cells that are not ours (tests/library).
#   library_test.sh BUILD ROOT CXX
set -euo pipefail
build=$1 root=$(realpath "$2") compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
mkdir "$work/project"
# Every header finds those that it includes.
cd "$work/prefix/include/gatewalk"
grep -ro --include='*.h' '^#include "[^"]*"' . | while IFS='"' read -r header name _; do
  [ -f "$name" ] || { echo "${header%%:*} includes $name, which is not installed"; exit 1; }
done
cd - >/dev/null
# pkg-config says where they are, not where they were configured to be.
if command -v pkg-config >/dev/null; then
  pc=$(find "$work/prefix" -name gatewalk.pc)
  export PKG_CONFIG_PATH=${pc%/*}
  [ -f "$(pkg-config --variable=includedir gatewalk)/lattice/field/problem.h" ] || { cat "$pc"; exit 1; }
  [ -f "$(pkg-config --variable=libdir gatewalk)/libgatewalk_lattice.a" ] || { cat "$pc"; exit 1; }
fi

# An example's includes stay in front, its statements become main(), which returns 0 where CHECK holds.
program() {  # README NUMBER CHECK
  awk -v wanted="$2" '/^```cpp/ { inside = ++number == wanted; next } /^```/ { inside = 0 } inside' "$1" >"$work/example"
  grep '^#include' "$work/example"
  echo '#include <cmath>'
  echo 'int main() {'
  grep -v '^#include' "$work/example"
  echo "  return $3 ? 0 : 1;"
  echo '}'
}
program "$root/README.md" 1 'std::abs(exact.final_cells.sum() - 1.0) < 1e-9 && exact.final_cells.rows() == 9' \
  >"$work/project/example.cpp"
program "$root/lattice/README.md" 1 'prediction.reached' >"$work/project/prediction.cpp"
program "$root/lattice/README.md" 2 'v.starts[0].dynamics.final_cells.sum() == 1000 && v.starts[0].joint_test.p > 0.0 && v.starts[0].joint_test.p <= 1.0 && (v.starts[0].exact_against.total_variation < 0.2 || wrong)' \
  >"$work/project/study.cpp"
cp "$root"/tests/library/* "$root"/results/lorentz/diffusion.* "$work/project"
cat >"$work/project/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(elsewhere LANGUAGES CXX)
find_package(gatewalk REQUIRED)
foreach(name example prediction study lorentz)
  add_executable(${name} ${name}.cpp)
  target_link_libraries(${name} PRIVATE gatewalk::lattice)
endforeach()
target_sources(lorentz PRIVATE diffusion.cpp)
END
cmake -S "$work/project" -B "$work/project/build" -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/project/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cd "$root"  # the example names scenes/field.toml
"$work/project/build/example"
"$work/project/build/prediction" | tee "$work/prediction"
"$build/gatewalk" predict scenes/field.toml --accuracy 0.05 --quiet --csv - |
  awk -F, 'sub("endings[.]", "", $1) { printf "%s %.4f [%.4f, %.4f]\n", $1, $4, $5, $6 } $1 == "error_95" { bar = $4 }
    END { printf "total variation of the final gates, 95 %%: %.4f\n", bar }' | diff - "$work/prediction"
"$work/project/build/study"
# D of the Lorentz gas by direct simulation (results/lorentz) lies in the chain's error bar.
"$work/project/build/lorentz" 0.2 | tee "$work/d"
awk -F '[][ ,]+' -v direct=0.1698 '{ exit !($2 <= direct && direct <= $3) }' "$work/d"
if "$work/project/build/lorentz" 0.31 2>"$work/refused"; then exit 1; fi
grep -q 'there is no diffusion coefficient' "$work/refused"
