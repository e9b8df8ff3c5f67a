#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs part SLURM_ARRAY_TASK_ID of the command in FOLDER; resumes a part that was stopped.   part.sh FOLDER
set -uo pipefail
folder=$1 i=$SLURM_ARRAY_TASK_ID
mapfile -d '' -t command <"$folder/command"
"$GATEWALK" "${command[@]}" --shard "$i/$(<"$folder/parts")" --part "$folder/part$i" --resume --quiet \
  --threads "${SLURM_CPUS_PER_TASK:-1}" &
trap 'kill -USR1 $!' USR1
wait $!
status=$?
[ $status -le 128 ] || { wait $!; status=$?; }  # the signal ended only the first wait
# Status 75: the time was up before the part was done.
if [ $status = 75 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 10 ]; then scontrol requeue "${SLURM_ARRAY_JOB_ID}_$i"; fi
exit $status
