#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs a gatewalk command in parts, as a job array of Slurm, followed by a job that merges the parts:
#   cli/cluster/array.sh PARTS FOLDER COMMAND ...      e.g. array.sh 100 run1 lattice scene.toml --trials 1e8 --json all.json
# FOLDER gets the parts and their output. A part that is stopped (time limit, pre-emption) resumes by itself, up to
# ten times. If parts were lost (cancelled, a node that failed), this command runs them again, and then merges:
#   cli/cluster/array.sh --again FOLDER
# It runs the parts that merge reports as missing or not finished.
# sbatch reads SBATCH_* variables (partition, account, time); GATEWALK names the program.
set -euo pipefail
here=$(realpath "$(dirname "$0")")
export GATEWALK=${GATEWALK:-gatewalk}
only=
if [ "${1:-}" = --again ]; then
  folder=$(realpath "$2")
  said=$("$GATEWALK" merge "$folder"/part*[0-9] -o /dev/null 2>&1) && { echo "no part is missing" >&2; exit; }
  only=$(grep -o "[0-9]*/$(<"$folder/parts")" <<<"$said" | sed 's,/.*,,' | paste -sd,)
  [ -n "$only" ] || { echo "$said" >&2; exit 1; }
else
  [ $# -ge 3 ] || { sed -n '2,8s/^# \?//p' "$0" >&2; exit 2; }
  parts=$1
  mkdir -p "$2"
  folder=$(realpath "$2")
  shift 2
  printf '%s\n' "$parts" >"$folder/parts"
  printf '%s\0' "$@" >"$folder/command"
fi
parts=$(<"$folder/parts")
# Slurm sends SIGUSR1 two minutes before the time limit; gatewalk then stops and keeps its finished pieces.
array=$(sbatch --parsable --job-name=gatewalk --array="${only:-1-$parts}" --requeue --signal=B:USR1@120 \
  --output="$folder/part%a.log" --open-mode=append --export=ALL "$here/part.sh" "$folder")
merge=$(sbatch --parsable --job-name=gatewalk-merge --dependency="afterok:$array" --kill-on-invalid-dep=yes \
  --output="$folder/merge.log" --export=ALL "$here/merge.sh" "$folder")
echo "$array $merge"
