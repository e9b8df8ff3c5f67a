#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A process's locale changes no number. The program reads, writes and draws the same bytes in a process that has another
# locale for C and C++ (de_DE: 0,5 and 1.000; ps_AF: signs of two bytes), as a guest in a Qt window would, and if the
# environment has that locale. Programs that it starts do not get the locale.
#   locale_test.sh GATEWALK ROOT GATEWALK_ELSEWHERE
elsewhere=$(realpath "$3")
root=$(realpath "$2")
. "$root/tests/program/preamble.sh" "$1" "$2"
mkdir locales
for name in de_DE ps_AF; do
  localedef -i $name -f UTF-8 "locales/$name.UTF-8" || { echo "localedef cannot make $name (Debian: locales)"; exit 1; }
done
export LOCPATH=$work/locales LOCALE=de_DE.UTF-8

# The golden lines of results/reliability/bits.sh, and commands that write or draw in other ways.
eval "$(grep -E "^some\+?='" "$root/results/reliability/bits.sh")"
others='(0 (sweep (single|soft)|landscape own|trace (soft_left.toml --trials 4|map)|scene|export|show (tree|own)|predict tree'
others+='|chart methods soft)|1 gate|2 [^g]|2 gate [^n])'
"$root/tests/same_results.sh" --lines "^(0 ($some)|$others)" "$gatewalk" "$elsewhere" >said.txt 2>&1 || fail "in de_DE: $(cat said.txt)"
# Numbers read from JSON: policies, records of matrices, numbers of a sweep.
LOCALE=ps_AF.UTF-8 "$root/tests/same_results.sh" --lines '^0 (show matrix|sweep own|scene own|plan)' "$gatewalk" "$elsewhere" \
  >said.txt 2>&1 || fail "in ps_AF: $(cat said.txt)"
# A scene of 12.5 cm, which a locale once made 12 m.
printf 'body.radius_cm = 12.5\n' >body.toml
expect 0 'body.radius_m  *0.125 ' "$elsewhere" scene body.toml

# The locale comes from the environment. Pictures are compared too; their texts are UTF-8.
printf 'body.radius_m = 0.08\n' >"Käfer.toml"
for kind in svg pdf png; do
  env -u LC_ALL LC_CTYPE=C.UTF-8 "$gatewalk" gate Käfer.toml --trials 30 --figure here.$kind --quiet >here.txt || fail "no $kind"
  LC_ALL=$LOCALE LC_NUMERIC=$LOCALE "$gatewalk" gate Käfer.toml --trials 30 --figure there.$kind --quiet >there.txt || fail "no $kind in de_DE"
  "$elsewhere" gate Käfer.toml --trials 30 --figure guest.$kind --quiet >guest.txt || fail "no $kind of a guest"
  for other in there guest; do
    cmp -s here.txt $other.txt || fail "$other.txt: $(diff here.txt $other.txt | head -n 4)"
    # A PDF holds the time at which it was drawn.
    cmp -s <(grep -av CreationDate here.$kind) <(grep -av CreationDate $other.$kind) || fail "$other.$kind differs"
  done
done
grep -q 'Käfer' here.svg || fail "no Käfer in here.svg"
# A program beside the library sees its own locale.
printf '#!/bin/sh\necho "$LC_ALL" >"%s/found"\nexit 1\n' "$work" >gnuplot && chmod +x gnuplot
PATH=$work:$PATH LC_ALL=$LOCALE "$gatewalk" gate Käfer.toml --trials 3 --figure x.svg >out.txt 2>&1 && fail "drawn by no gnuplot"
[ "$(cat found)" = C ] || fail "gnuplot finds LC_ALL=$(cat found)"
LC_ALL=$LOCALE "$gatewalk" predict "$scenes/programs/pillars.toml" --cell-program "echo \$LC_ALL >$work/found.cell; exit 1" >out.txt 2>&1
[ "$(cat found.cell)" = C.UTF-8 ] || fail "a cell program finds LC_ALL=$(cat found.cell): $(cat out.txt)"
finish
