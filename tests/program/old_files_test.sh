#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Matrix files of earlier versions are read, and give the answers that are kept beside them, without new runs. (Made anew
# for 2.0.0, which takes endings from smaller leaves.)
#   old_files_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"
files=$(dirname "$scenes")/tests/files
shopt -s nullglob
for packed in "$files"/version_*/*.nc.gz; do
  gunzip -c "$packed" >old.nc
  few=(--accuracy 0.9)
  [[ $packed != */bins.nc.gz ]] || few=()
  "$gatewalk" predict old.nc "${few[@]}" --json new.json --quiet 2>/dev/null || fail "$packed: not read"
  jq -cS '{endings, final_gates} + (.starts // [] | if length > 0 then {starts: map({endings, final_gates})} else {} end)' new.json |
    cmp -s - "${packed%.nc.gz}.json" || fail "$packed: another answer than it gave"
done
[ -n "${packed-}" ] || fail "there are no files"
# A file of a later version is refused, not guessed at.
"$gatewalk" build "$scenes/field.toml" --trials 1 -o new.nc --quiet >/dev/null
[ "$(ncdump -h new.nc | grep -c 'format_version = 2')" = 1 ] || fail "another version than 2"
finish
