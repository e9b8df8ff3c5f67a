#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# cli/cluster on a Slurm of four virtual nodes on this machine: parts of which one is cancelled and one lost with its
# node are run again and merged, and give the bits of one run.   slurm_test.sh GATEWALK ROOT; status 77 without Slurm.
set -u
gatewalk=$(realpath "$1") root=$(realpath "$2")
for program in /usr/sbin/slurmctld /usr/sbin/slurmd /usr/sbin/munged; do
  [ -x $program ] || { echo "skipped: $program is not installed (slurmctld slurmd slurm-client munge)"; exit 77; }
done
D=$(mktemp -d)
chmod 755 "$D"
cd "$D" || exit 1
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
down() {
  for pid in "$D"/run/*.pid; do [ -s "$pid" ] && kill "$(<"$pid")" 2>/dev/null; done
  sleep 1
  [ $failures = 0 ] || tail -n 20 "$D"/run1/*.log "$D"/log/slurmctld.log 2>/dev/null
  rm -rf "$D"
}
trap down EXIT
mkdir -p ctld log run spool/n1 spool/n2 spool/n3 spool/n4
head -c 1024 /dev/urandom >munge.key
chmod 400 munge.key
/usr/sbin/munged --force --key-file="$D/munge.key" --socket="$D/run/munge.sock" --pid-file="$D/run/munged.pid" \
  --log-file="$D/log/munged.log" --seed-file="$D/run/munge.seed" --num-threads=2 || exit 1
me=$(id -un) host=$(hostname -s) port=$((20000 + RANDOM % 10000))
cat >slurm.conf <<C
ClusterName=local
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$D/run/munge.sock,cred_expire=5
CredType=cred/munge
SlurmUser=$me
SlurmdUser=$me
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0
ReturnToService=2
KillWait=2
StateSaveLocation=$D/ctld
SlurmdSpoolDir=$D/spool/%n
SlurmctldPidFile=$D/run/slurmctld.pid
SlurmdPidFile=$D/run/slurmd.%n.pid
SlurmctldLogFile=$D/log/slurmctld.log
SlurmdLogFile=$D/log/slurmd.%n.log
SlurmdParameters=config_overrides
CommunicationParameters=NoInAddrAny
NodeName=n[1-4] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 4))] CPUs=1 RealMemory=500 State=UNKNOWN
PartitionName=all Nodes=n[1-4] Default=YES MaxTime=60 State=UP
C
# The program of the jobs: while the file "held" exists, parts 1 and 2 stop midway, so that they are lost there.
cat >held.sh <<H
#!/bin/sh
if [ -e $D/held ]; then
  case "\$*" in *"--shard 1/8"* | *"--shard 2/8"*) exec timeout --signal=STOP 0.5 $gatewalk "\$@" ;; esac
fi
exec $gatewalk "\$@"
H
chmod 755 held.sh
touch held
export SLURM_CONF=$D/slurm.conf GATEWALK=$D/held.sh
/usr/sbin/slurmctld -c || exit 1
for n in 1 2 3 4; do /usr/sbin/slurmd -N n$n || exit 1; done
for _ in $(seq 60); do [ "$(sinfo -h -o %T -N 2>/dev/null | grep -c idle)" = 4 ] && break; sleep 0.5; done
[ "$(sinfo -h -o %T -N | grep -c idle)" = 4 ] || { fail "the nodes do not come up"; exit 1; }

command=(lattice "$root/scenes/field.toml" --trials 24000 --seed 4 --json all.json)
"$gatewalk" "${command[@]}" --quiet && mv all.json one.json
left() { squeue -h -r -j "$1" 2>/dev/null | wc -l; }
waited() { for _ in $(seq 240); do "$@" && return; sleep 0.25; done; fail "waited too long: $*"; }
started() { pgrep -f -- "--shard 1/8 --part $D" && pgrep -f -- "--shard 2/8 --part $D"; } >/dev/null
ended() { [ "$(left "$array")" = 0 ]; }
merged() { [ "$(left "$merge")" = 0 ]; }

read -r array merge < <("$root/cli/cluster/array.sh" 8 run1 "${command[@]}")
waited started
scancel "${array}_1"                   # by a user
pkill -KILL -f -- "--shard 2/8 --part $D" # and one whose node is lost with all that runs on it
waited ended
waited merged
pkill -KILL -f -- "--shard [12]/8 --part $D" # a tracker by parents loses a stopped child; the cgroups of a cluster do not
rm held
[ ! -e all.json ] || fail "merged, and parts were missing"
"$gatewalk" merge run1/part*[0-9] -o x.json >said.txt 2>&1 && fail "merge of too few parts"
grep -q ' --shard 1/8, 2/8 and --resume' said.txt || fail "merge does not name parts 1 and 2: $(cat said.txt)"
read -r array merge < <("$root/cli/cluster/array.sh" --again run1)
waited merged
diff <(jq -S 'del(.made_by.parts)' one.json) <(jq -S 'del(.made_by.parts)' all.json) >/dev/null || fail "not the bits of one run"
[ $failures = 0 ] && echo "eight parts, two of them run again, are the bits of one run"
exit $failures
