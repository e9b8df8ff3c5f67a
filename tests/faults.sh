#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests every command while the system fails: call number k of read, write, fsync, fdatasync, rename, ftruncate, link,
# close, opening or creating a file, starting a process or a thread fails, once or from then on, for the first MOST
# calls; getting memory fails likewise. Left out are chart limits, chart chain and reproduce, which take minutes and
# write as chart methods does. Also tests /dev/full, a full disk, a quota, a folder that cannot be written, little
# memory, few files, no locale, no HOME, closed outputs. A command must never fail silently or leave a damaged file.
#   [CALLS=...] [COMMANDS='show|walk'] faults.sh GATEWALK ROOT [MOST]    only these calls and commands; MOST: 12
# Programs ask for memory 10^5 times, so for memory k begins at 1000, and each k is a fifth larger than the one before.
here=$(realpath "$(dirname "$0")")
most=${3:-12}
. "$here/program/preamble.sh" "$1" "$2"
. "$here/killed.sh"
for tool in cc jq ffprobe addr2line ncdump; do command -v "$tool" >/dev/null || { echo "faults.sh needs $tool" >&2; exit 2; }; done
cc -shared -fPIC -O1 -o faults.so "$here/faults.c" -ldl || exit 1
runs=0 kept_old= seconds=120
declare -A failed in_library
# Without memory a library may lay out a file in another way: its content is compared, not its checksum.
content() { { ncdump "$1" || echo "no dump of $1"; } | sed 's/^netcdf .*//; /^\t*:checksum = /d'; }
# The times in charts differ from run to run.
untimed() { grep -v '"machine"' "$1" | sed -E 's/[0-9.]+(e[-+]?[0-9]+)?/N/g; s/ +/ /g'; }
same() {
  case $1 in
    */out/chart.* | */out/fidelity.*) cmp -s <(untimed "$1") <(untimed "$2") ;;
    *.nc) cmp -s "$1" "$2" || { [ "${call-}" = malloc ] && cmp -s <(content "$1") <(content "$2"); } ;;
    *.json) cmp -s <(plain "$1" | grep -v '"machine"') <(plain "$2" | grep -v '"machine"') ;;  # known from a file
    *) cmp -s "$1" "$2" ;;
  esac || fail "$2 is not $1, of a run without a fault (${call-} ${k-}${ever:+ and after it})"
}
# whole_film ONE OTHER: both films have the same width, height and length, up to the last byte (the trailer of a GIF).
frames_of() { ffprobe -v error -count_frames -show_entries stream=width,height,nb_read_frames -of csv "$1"; }
whole_film() {
  [ "$(tail -c 1 "$2")" = ";" ] && [ "$(frames_of "$1")" = "$(frames_of "$2")" ] || fail "$2 is no whole film (${call-} ${k-})"
}
# each_old FILE..., each_whole FILE...: all are as before the run; or those that changed are as after a complete run.
each_old() { for f in "$@"; do cmp -s "$f" <(echo old) || return 1; done; }
each_whole() { for f in "$@"; do each_old "$f" || same "one/$f" "$f"; done; }
has_checkpoint() { [[ $* != "build recorded"* ]] && "$gatewalk" "$1" --help | grep -q -e ' --checkpoint'; }  # no runs are made of recorded ones

# survives OUTPUTS COMMAND...: an old output is unchanged, or the new one is whole; a status of 0 means that all are
# new. If `begun` names a checkpoint, each run resumes a copy of it; with kept_old=1 old files are renamed.
begun=
survives() {
  local outputs call k ever error status left keep=()
  read -r -a outputs <<<"$1"
  shift
  [[ $1 =~ ^(${COMMANDS:-.*})$ ]] || return 0
  ! has_checkpoint "$@" || keep=(--checkpoint pieces ${begun:+--resume})
  rm -rf "${outputs[@]}" one && mkdir one
  "$gatewalk" "$@" --quiet >/dev/null 2>err.txt || fail "$* ($(cat err.txt))"
  for f in "${outputs[@]}"; do mkdir -p "$(dirname "one/$f")" && mv "$f" "one/$f"; done
  # once K: runs the command while call K fails; sets status.
  once() {
    for f in "${outputs[@]}"; do echo old >"$f"; done
    rm -rf seen pieces
    [ -z "$begun" ] || cp "$begun" pieces
    rm -f crash ./*.~*~
    runs=$((runs + 1))
    timeout -s KILL "$seconds" env LD_PRELOAD=./faults.so FAULT_CALL=$call FAULT_AT="$1" ${ever:+FAULT_EVER=1} FAULT_ERRNO="$error" FAULT_SEEN=seen FAULT_CRASH=crash \
      "$gatewalk" "${command[@]}" --quiet $([ -n "$kept_old" ] || echo --force) "${keep[@]}" >/dev/null 2>err.txt
    status=$?
    [ ! -e seen ] || failed[$call]=$((${failed[$call]-0} + 1))
    # Without memory fontconfig tries again for ever.
    [ $status != 137 ] || [ "$call ${outputs[*]}" = "malloc trace.gif" ] || fail "$call $1 failed, and no end: ${command[*]}"
    [ -z "$kept_old" ] || for f in "${outputs[@]}"; do each_old "$f" || each_old "$f.~1~" || fail "$call $1 failed, and $f is lost: ${command[*]}"; done
  }
  # A library crashed or ended the program. The command then fails without damage to files; crashes are counted by
  # library. While there is memory, only HDF5 crashes, which cannot close a file, or a library that has just started.
  in_a_library() {
    local where
    [ $status -gt 2 ] || return 1
    where=$(cat crash 2>/dev/null || echo "status $status")
    [ $status != 137 ] || where="libfontconfig.so, which did not end,"
    # nlohmann's JSON needs memory in destructors, and operator[] of a null value leaves what they cannot destroy.
    [[ $where != "gatewalk "* ]] || ! addr2line -Cfe "$gatewalk" ${where#gatewalk } | grep -qE 'nlohmann.*(::destroy|::~)' ||
      where="libjson.so, destructors,"
    [ "$call" = malloc ] && [[ $where = lib*.so* ]] || [[ $where = @(libhdf5|libnetcdf|"libraries.so as they begin")* ]] || return 1
    where="$where where $call failed"
    in_library[$where]=$((${in_library[$where]-0} + 1))
  }
  resumed() {  # the kept pieces can be resumed
    [ -e pieces ] || return 0
    "$gatewalk" "${command[@]}" --quiet --force --checkpoint pieces --resume >/dev/null 2>err.txt ||
      fail "not resumed after $call $k: ${command[*]} ($(cat err.txt))"
    for f in "${outputs[@]}"; do same "one/$f" "$f"; done
  }
  local command=("$@")
  for call in ${CALLS:-read write fsync fdatasync rename ftruncate link close open create spawn thread}; do
    for ever in "" 1; do
      case $call:$ever in open:* | create:*) error=24 ;; spawn:*) error=11 ;; *:) error=28 ;; *) error=5 ;; esac  # EMFILE EAGAIN ENOSPC EIO
      for k in $(seq "$most"); do
        once "$k"
        if [ $status = 0 ]; then
          for f in "${outputs[@]}"; do same "one/$f" "$f"; done
          # A library may do without some file or process. A result that is not on the disk does not count as written.
          case $call in write | fsync | rename) [ ! -e seen ] || fail "$call $k failed ($error), and status 0: $*" ;; esac
        elif in_a_library; then
          each_whole "${outputs[@]}"
        else
          each_whole "${outputs[@]}"
          grep -q '^gatewalk: ' err.txt || fail "$call $k failed without a word: $* ($(cat err.txt))"
          [ $status = 1 ] || { [[ $call = @(read|open|close|link|create|spawn) ]] && [ $status = 2 ]; } || fail "$call $k failed: status $status: $* ($(cat err.txt))"
        fi
        left=$(find . -name '.gatewalk-*')
        [ -z "$left" ] || { fail "$call $k failed, and temporary files stay: $* ($left)"; find . -name '.gatewalk-*' -delete; }
        resumed
        [ -e seen ] || break  # the command makes no more such calls
      done
    done
  done
  call=malloc error=12
  for ever in "" 1; do
    [ -z "${CALLS-}" ] || break
    for ((k = 1000; k < 1000000; k += k / 5)); do
      once $k
      [ -e seen ] || break
      case $status in
        # Without memory for its configuration fontconfig takes another font, usually without a message.
        0) for f in "${outputs[@]}"; do
          case $f in
            *.gif) whole_film "one/$f" "$f" ;;
            *.svg | *.html) grep -q '^Fontconfig error' err.txt || same "one/$f" "$f" ;;
            *) same "one/$f" "$f" ;;
          esac
        done ;;
        1 | 2) grep -q '^gatewalk: ' err.txt || fail "without memory $k: no words: $*" ;;
        *) in_a_library || fail "without memory $k: status $status, in $(cat crash): $*" ;;
      esac
      [ $status = 0 ] || each_whole "${outputs[@]}"
      resumed
    done
  done 2>/dev/null  # the shell's own messages about crashes
  rm -rf "${outputs[@]}" pieces
  find . -name ".gatewalk-*" -delete
  echo "$runs runs: $1"
}
survives gate.json gate "${field[@]}" --trials 2000 --json gate.json
survives sweep.csv sweep "$scenes/single_gate.toml" --vary forces.propulsion_N=6,7 --trials 500 --csv sweep.csv
survives bins.nc build "${field[@]}" --bins paper --trials 10 -o bins.nc
survives tree.nc build "${field[@]}" --accuracy 0.1 -o tree.nc
survives lattice.json lattice "${field[@]}" --trials 500 --json lattice.json
survives 'predict.json predict.svg' predict "${field[@]}" --accuracy 0.1 --json predict.json --figure predict.svg
survives analyze.json analyze "${field[@]}" --set run.method=moreau --accuracy 0.2 --runs 100 --json analyze.json
survives rare.json rare "${field[@]}" --set run.method=moreau --row 4 --gate-runs 4000 --json rare.json
pushes=("${field[@]}" --set run.method=moreau --set field.rows=2 --set actions.a.forces.propulsion_N=6
  --set actions.b.forces.propulsion_N=9)
survives 'plan.json policy.json gate.json' plan "${pushes[@]}" --accuracy 0.2 --json plan.json --policy policy.json --gate-policy gate.json
"$gatewalk" plan "${pushes[@]}" --accuracy 0.2 --policy chosen.json --quiet >/dev/null || fail "no policy"
survives lattice.json lattice "${pushes[@]}" --policy chosen.json --trials 300 --json lattice.json
survives 'followed.csv followed.json' trace "${pushes[@]}" --field --policy chosen.json --trials 4 --csv followed.csv --json followed.json
survives 'design.json new.toml' design "$scenes/mixed.toml" --set run.method=moreau --set field.rows=2 --accuracy 0.2 --json design.json -o new.toml
printf 'ending,count\ncrossed,9\ntrapped,20\nleft side,1\n' >counts.csv
survives 'fit.json best.toml draws.csv fit.nc' fit "${field[@]}" counts.csv --set run.method=moreau --set field.rows=2 --free forces.propulsion_N=5:9 --trials 12288 --json fit.json -o best.toml --draws draws.csv --inference-data fit.nc
survives validate.json validate "${field[@]}" --bins paper --matrix-trials 3 --trials 60 --null-draws 99 --json validate.json
survives power.json power "${field[@]}" --accuracy 0.1 --trials 60 --json power.json
survives scene.json scene "$scenes/mixed.toml" --json scene.json
survives new.toml scene "$scenes/mixed.toml" --new -o new.toml
survives 'trace.json trace.csv trace.nc trace.html' trace "${field[@]}" --trials 4 --csv trace.csv --netcdf trace.nc --replay trace.html --json trace.json
seconds=20
survives trace.gif trace "$scenes/soft_left.toml" --set run.time_limit_s=0.3 --video trace.gif
seconds=120
survives 'out/landscape.csv out/landscape.json' landscape "$scenes/soft_left.toml" -o out
"$gatewalk" build "${field[@]}" --bins paper --trials 10 -o m.nc --quiet >/dev/null || fail "no matrix"
survives 'show.json show.csv' show m.nc --json show.json --csv show.csv
survives 'walk.json walk.nc' walk m.nc --walks 2000 --json walk.json --netcdf walk.nc
survives 'm.tra m.sta m.lab' export m.nc -o m.tra
"$gatewalk" export m.nc --gate --counts -o m.mtx --quiet || fail "nothing to import"
survives imported.nc import m.mtx --states m.states.csv --start 0 -o imported.nc
for i in 1 2; do "$gatewalk" lattice "${field[@]}" --trials 200 --shard $i/2 --part part$i --quiet || fail "no part"; done
survives merged.json merge part1 part2 -o merged.json
survives sample.toml sample robot -o sample.toml
"$gatewalk" sample cell -o cell.toml && "$gatewalk" sample tracks -o tracks.csv || fail "no tracks"
survives 'runs.csv runs.json' passages tracks.csv --cell cell.toml --fps 10 --metres-per-unit 0.001 --fastest 0.4 \
  --lattice 9,9 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y -o runs.csv --json runs.json
"$gatewalk" sample runs -o recorded.csv || fail "no recorded runs"
survives recorded.nc build recorded.csv --cell cell.toml -o recorded.nc
survives 'out/fidelity.csv out/fidelity.json' chart field "${field[@]}" --trials 5 -o out
survives 'out/chart.csv out/chart.json' chart methods "$scenes/soft_left.toml" --trials 20 --repeats 1 --methods stable,moreau -o out
# Runs that resume a checkpoint.
# halfway COMMAND...: runs the command's first piece of work, kept in `begun`.
halfway() {
  rm -f begun
  "$gatewalk" "$@" --checkpoint begun --max-time 0.001s --quiet 2>err.txt
  [ $? = 75 ] && [ -s begun ] || fail "nothing was kept: $* ($(cat err.txt))"
  begun=begun
}
halfway lattice "${field[@]}" --trials 1000 --json lattice.json
survives lattice.json lattice "${field[@]}" --trials 1000 --json lattice.json
halfway build "${field[@]}" --accuracy 0.1 -o tree.nc
survives tree.nc build "${field[@]}" --accuracy 0.1 -o tree.nc
begun=
# Old files are renamed.
kept_old=1
survives lattice.json lattice "${field[@]}" --trials 200 --json lattice.json
kept_old=
# Full and forbidden places.
one=(lattice "${field[@]}" --trials 100 --quiet)
expect 1 'cannot be written: No space left' "$gatewalk" "${one[@]}" --json /dev/full
"$gatewalk" "${one[@]}" --json - >/dev/full 2>err.txt
[ $? = 1 ] && grep -q 'No space left' err.txt || fail "standard output is full: $(cat err.txt)"
mkdir small
if ! mount -t tmpfs -o size=256k none small 2>/dev/null; then
  fail "not tried: a full disk, as nothing can be mounted here"
else
  "$gatewalk" "${one[@]}" --json one.json
  cp one.json small/old.json
  head -c 300000 /dev/zero >small/fill 2>/dev/null
  expect 1 'No space left' "$gatewalk" "${one[@]}" --json small/old.json --force
  cmp -s one.json small/old.json || fail "a full disk: the old file is damaged"
  expect 1 'No space left' "$gatewalk" "${one[@]}" --json new.json --checkpoint small/pieces
  [ ! -e new.json ] || fail "a full disk under the checkpoint: a result without a word"
  umount small
fi
# Root may write everywhere except into a folder that is mounted read-only.
mkdir forbidden && chmod 500 forbidden
if [ ! -w forbidden ]; then
  expect 2 'Permission denied' "$gatewalk" "${one[@]}" --json forbidden/x.json
elif mount -t tmpfs -o ro none forbidden 2>/dev/null; then
  expect 2 'Read-only file system' "$gatewalk" "${one[@]}" --json forbidden/x.json
  umount forbidden
else
  fail "not tried: a folder that cannot be written"
fi
# A machine with few resources gives the same result, or a message.
"$gatewalk" "${one[@]}" --json one.json --force || fail "${one[*]}"
poor() { # WORDS...: before the program
  local words status
  rm -f new.json
  words=$("$@" "$gatewalk" "${one[@]}" --json new.json 2>&1 >/dev/null)
  status=$?
  case $status in
    0) same one.json new.json ;;
    1 | 2) grep -q '^gatewalk: ' <<<"$words" && [ ! -e new.json ] || fail "$*: $words" ;;
    *) fail "$*: status $status: $words" ;;
  esac
}
limited() { (trap '' XFSZ && ulimit "$1" "$2" && shift 2 && exec "$@"); }
closed() { (exec "$@" <&- >&-); }
poor env -i
poor env LC_ALL=xx_YY.UTF-8 LANG=nothing
poor env -u HOME TMPDIR=/nowhere
poor closed
for files in 4 6 8 12 20; do poor limited -n $files; done
for size in 0 1 4; do poor limited -f $size; done  # blocks of 1 KB: what a quota does
for stack in 64 256 1024; do poor limited -s $stack; done 2>/dev/null
# With little memory a message says which option would help; the old file stays.
echo old >big.nc
(ulimit -v 400000; "$gatewalk" build "${field[@]}" --accuracy 0.001 --starts all -o big.nc --force --quiet --threads 1 >/dev/null 2>err.txt; [ $? = 1 ]) || fail "out of memory: another status"
grep -q 'out of memory' err.txt || fail "out of memory without a word: $(cat err.txt)"
[ "$(cat big.nc)" = old ] || fail "out of memory: the old file is gone"
for call in ${CALLS:-read write fsync fdatasync rename ftruncate link close open create spawn thread malloc}; do
  [ -n "${COMMANDS-}" ] || [ "${failed[$call]-0}" -gt 0 ] || fail "no $call failed in any run"
  echo "$call: failed in ${failed[$call]-0} runs"
done
[ $runs -gt 0 ] || fail "no command is $COMMANDS"
for where in "${!in_library[@]}"; do echo "ended in $where: ${in_library[$where]} runs"; done
echo "$runs runs"
finish
