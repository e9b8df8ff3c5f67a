#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# No number of ours is read or written with the process's locale, as strtod, scanf, printf and the standard library's
# streams would do. Checks which symbols the compiled code refers to, function by function (nm -u knows only files).
#   locale_symbols.sh BUILD ROOT COMPILER
set -euo pipefail
export LC_ALL=C
build=$(realpath "$1") root=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Streams with float, double and long double, by mangled names; C functions, also by their names under _FORTIFY_SOURCE
# and C99.
c='(strto(f|d|ld)(_l)?|atof|(__isoc[0-9]+_)?v?[fsw]*scanf|(__)?v?[adfsnw]*printf(_chk)?|strfmon)'
streams='_ZNSo9_M_insertI[fde]E.*|_ZNSolsE[fde]|_ZNSi10_M_extractI[fde]E.*|_ZNSirsER[fde]'
# Allowed in functions of libraries' headers, each by its name:
allowed='^_ZNK?('
allowed+='5boost4math8policies'           # words of its exceptions, in domains where none is thrown
allowed+='|8nlohmann.*5lexer.*scan_number'  # strtod: of parsed_json alone, below, in the locale of C
allowed+='|8nlohmann.*(dump_escaped|get_token_string)'  # snprintf: of bytes, in hexadecimal digits
allowed+=')'
# "FUNCTION<TAB>SYMBOL" for each that is not allowed. Functions of headers have a section of their own; `.text` is of a source.
found_in() {
  objdump -r "$@" | awk -v wanted="^($c|$streams)\$" -v allowed="$allowed" '
    / file format / { file = $1; sub(/:$/, "", file) }
    /^RELOCATION RECORDS FOR / { section = $4; gsub(/^\[|\]:$/, "", section); next }
    $3 != "" {
      symbol = $3
      sub(/[-+]0x[0-9a-f]+$/, "", symbol)
      sub(/@.*/, "", symbol)
      name = section
      sub(/^\.text(\.(unlikely|hot|startup))?(\.|$)/, "", name)
      if (symbol ~ wanted && name !~ allowed) print (name ? name : file) "\t" symbol
    }' | sort -u
}

# The check finds a forbidden call.
cat >"$work/trial.cpp" <<'END'
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
double read(const char* text) { return std::strtod(text, nullptr); }
double scan(const char* text) { double x = 0; std::sscanf(text, "%lf", &x); return x; }
std::string write(double x) { return std::to_string(x); }
void print(char* to, double x) { std::sprintf(to, "%g", x); }
void out(std::ostream& to, float x, long double y) { to << x << y; }
void in(std::istream& from, double& x) { from >> x; }
void whole(std::ostream& to, long n) { to << n << "text"; }
END
"$3" -std=c++20 -O1 -c "$work/trial.cpp" -o "$work/trial.o"
[ "$(found_in "$work/trial.o" | cut -f 2 | tr '\n' ' ')" = \
  "_ZNSi10_M_extractIdEERSiRT_ _ZNSo9_M_insertIdEERSoT_ _ZNSo9_M_insertIeEERSoT_ __isoc99_sscanf sprintf strtod vsnprintf " ] || {
  echo "locale_symbols.sh itself is broken:"; found_in "$work/trial.o"; exit 1; } >&2

mapfile -t objects < <(find "$build"/{dynamics,markov,lattice,cli} -name '*.o')
[ ${#objects[@]} -gt 15 ] || { echo "no objects under $build" >&2; exit 1; }
found=$(found_in "${objects[@]}" | c++filt)
[ -z "$found" ] || { printf 'read or written by the locale (function, by what):\n%s\nfmt writes numbers, std::from_chars reads them\n' "$found" >&2; exit 1; }

# Whole numbers in groups: streams for text are TextStream, which has the classic locale. JSON is read in one place.
cd "$root"
others=$(grep -rnE "std::o?stringstream\b" dynamics markov lattice cli --include="*.h" --include="*.cpp" | grep -v "^lattice/text/text_stream.h:" || true)
[ -z "$others" ] || { printf 'a stream with the locale of the process:\n%s\n' "$others" >&2; exit 1; }
others=$(grep -rnE '\b(Json|json)::parse\(' dynamics markov lattice cli --include='*.h' --include='*.cpp' | grep -v '^cli/fields/json.cpp:' || true)
[ -z "$others" ] || { printf 'JSON is read by parsed_json:\n%s\n' "$others" >&2; exit 1; }
