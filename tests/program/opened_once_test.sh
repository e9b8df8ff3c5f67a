#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Every command opens a scene file once.   opened_once_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"
command -v python3 >/dev/null || { echo "needs python3"; exit 1; }

# times_opened FILE COMMAND...: how often the command opens the file, as inotify counts it.
cat >times_opened.py <<'END'
import ctypes, os, struct, subprocess, sys
IN_OPEN, IN_CLOSE = 0x20, 0x18  # closes separate opens, which inotify would join
libc = ctypes.CDLL(None, use_errno=True)
fd = libc.inotify_init1(os.O_NONBLOCK)
if libc.inotify_add_watch(fd, sys.argv[1].encode(), IN_OPEN | IN_CLOSE) < 0:
    sys.exit(f"{sys.argv[1]}: {os.strerror(ctypes.get_errno())}")
with open("said.txt", "w") as said:
    if subprocess.run(sys.argv[2:], stdin=subprocess.DEVNULL, stdout=said, stderr=said).returncode != 0:
        sys.exit(open("said.txt").read())
events = os.read(fd, 1 << 16)
print(sum(struct.unpack_from("iIII", events, at)[1] & IN_OPEN != 0 for at in range(0, len(events), 16)))
END
once() {
  opened=$(python3 times_opened.py "$file" "$gatewalk" "$@" --quiet) || { fail "cannot count: $* ($opened)"; return; }
  [ "$opened" = 1 ] || fail "opened $opened times: $*"
}

file=once.toml
{ cat "$scenes/field.toml"; printf '\n[bins]\nEN_vy_m_per_s = [0.0, 5.0, 10.0, 20.0, 40.0]\n'; } >$file
sed -i 's/^method.*/method = "moreau"/' $file
bins=(--trials 5 -o bins.nc --force)
once gate $file --trials 5 --json out.json --force
once lattice $file --trials 5 --json out.json --force
once scene $file --json out.json --force
once build $file "${bins[@]}"
once validate $file --trials 20 --null-draws 19 --json out.json --force
once predict $file --gate-runs 500 --accuracy 0.3 --json out.json --force
once predict $file --gate-runs 500 --accuracy 0.3 --checkpoint kept --max-time 1h --json out.json --force
once predict bins.nc $file --json out.json --force
once walk bins.nc $file --walks 10 --json out.json --force
once analyze $file --gate-runs 500 --accuracy 0.3 --runs 0 --json out.json --force
once rare $file --row 2 --gate-runs 1000 --json out.json --force
once plan $file --gate-runs 1000 --accuracy 0.4 --over start.vy_m_per_s=10:20 --json out.json --force
once power $file --gate-runs 500 --accuracy 0.3 --versus forces.random_N=40 --json out.json --force
once sweep $file --vary forces.random_N=10,20 --trials 5 --json out.json --force
once trace $file --trials 1 --csv out.csv --force

# Also a scene that names a map, which no output may be.
file=map.toml
printf '.s.\n...\n' >map.csv
printf 'run.method = "moreau"\nfield = { columns = 3, rows = 2 }\n[terrain]\nmap_file = "map.csv"\n[terrain.types.s.forces]\npropulsion_N = 6\n' >$file
once predict $file --gate-runs 500 --accuracy 0.3 --json out.json --force
once design $file --gate-runs 1000 --accuracy 0.4 --json out.json --force

finish
