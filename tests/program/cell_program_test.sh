#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Cell programs whose answers depend on more than the passage are refused; for correct ones the check costs few
# passages.
#   cell_program_test.sh GATEWALK ROOT
. "$(dirname "$0")/preamble.sh"

cat >cell.toml <<'END'
field = { columns = 1, rows = 3, max_gates = 20 }
start = { face = "S", s_m = 0.0 }
cell = { width_m = 1.0, length_m = 1.0, faces = [{ name = "S", move = [0, 1] }], coordinates = [{ name = "s", unit = "m" }] }
END
# A body goes on with probability 0.6, otherwise it is trapped. Where and when it goes on is always the same, so only
# this probability can differ. With "process" the times show which process answered; with "seldom" every other process
# answers one passage of four in another way.
cat >program.py <<'END'
import os, random, sys
how, number = sys.argv[1], 0
while how == "seldom":  # the number of this process
    try:
        os.mkdir(f"{sys.argv[2]}/{number}")
        break
    except FileExistsError:
        number += 1
print('{"gatewalk": 1, "coordinates": [{"name": "s", "unit": "m", "scale": 0.1}], "costs": [{"key": "time_s", "unit": "s"}],'
      ' "faces": [{"name": "S", "move": [0, 1]}]}', flush=True)
count, batch = 0, []
def draw(seed, id):
    global count
    count += 1
    if how == "state": return count % 2
    if how == "seldom" and int(seed) % 4 == 0: return number % 2
    key = {"right": seed, "clock": None, "process": f"{os.getpid()} {seed}", "order": count, "id": f"{id} {seed}"}.get(how, seed)
    if how == "batch": key = batch[0]
    return random.Random(key).random()
def answer():
    for id, seed in lines:
        time = 1 + random.Random(os.getpid()).random() if how == "process" else 1
        print(id, f"left S 0 {time} -" if draw(seed, id) < 0.6 else f"trapped {time}")
    sys.stdout.flush()
lines = []
for word in map(str.split, sys.stdin):
    if word:
        lines.append((word[0], word[3]))
    else:
        batch = [seed for _, seed in lines]
        answer()
        lines = []
END
run() { "$gatewalk" lattice cell.toml --cell-program "python3 $work/program.py $1 $work/started" "${@:2}" --quiet; }
for threads in 1 3; do
  for how in clock process order id batch; do
    expect 1 'answers the same passage in two ways: a body that entered by S (s = 0) .* sent once more, with the same noise and seed' \
      run $how --trials 1000 --threads $threads
    [ $how = process ] || { grep -q 'left by S (s = 0), time_s = 1' out.txt && grep -q 'was trapped, time_s = 1' out.txt; } ||
      fail "$how: one answer: $(cat out.txt)"
    grep -q 'Seed the generator with the seed of each passage' out.txt || fail "$how: no way out: $(cat out.txt)"
  done
done
# The check also works if a passage has the same answer in three of four processes. With one thread runs are the same.
for seed in 1 2 3 4; do
  rm -rf started && mkdir started
  expect 1 'answers the same passage in two ways' run seldom --trials 1000 --threads 1 --seed $seed
done
# With few passages, also one at a time: the first four are repeated.
expect 1 'answers the same passage in two ways' run state --trials 4 --threads 1
expect 1 'answers the same passage in two ways' run state --trials 100000 --threads 2
for command in predict analyze validate; do
  expect 1 'answers the same passage in two ways' "$gatewalk" $command cell.toml --cell-program "python3 $work/program.py clock" --quiet
done

# A correct program has the same result on any number of threads; 0.6^3 cross.
for trials in 1 20 100 3000; do
  run right --trials $trials --threads 1 --json one.json --force >/dev/null || fail "a right program, $trials trials"
  run right --trials $trials --threads 3 --json three.json --force >/dev/null || fail "a right program on three threads"
  cmp -s <(jq -S 'del(.made_by, .seconds)' one.json) <(jq -S 'del(.made_by, .seconds)' three.json) || fail "$trials trials: threads differ"
done
holds '(.endings.crossed / 3000 - 0.216 | fabs) < 0.03' one.json  # four standard deviations

finish
