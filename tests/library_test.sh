#!/usr/bin/env bash
# A project of its own finds the installed libraries and compiles the README's example with nothing added.
#   library_test.sh BUILD ROOT CXX
set -euo pipefail
build=$1 root=$2 compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null

# The example's includes stay in front, its statements become main().
mkdir "$work/project"
{
  awk '/^```cpp/ { inside = 1; next } /^```/ { inside = 0 } inside' "$root/README.md" >"$work/example"
  grep '^#include' "$work/example"
  echo '#include <cmath>'
  echo 'int main() {'
  grep -v '^#include' "$work/example"
  echo '  return std::abs(exact.final_cells.sum() - 1.0) < 1e-9 && exact.final_cells.rows() == 9 ? 0 : 1;'
  echo '}'
} >"$work/project/main.cpp"
cat >"$work/project/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(elsewhere LANGUAGES CXX)
find_package(gatewalk REQUIRED)
add_executable(elsewhere main.cpp)
target_link_libraries(elsewhere PRIVATE gatewalk::lattice)
END
cmake -S "$work/project" -B "$work/project/build" -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
cmake --build "$work/project/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/project/build/elsewhere"
