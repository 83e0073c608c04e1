#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# on_a_card.sh [--device host] FOLDER [JSON]: what needs a GPU, in at most six minutes. FOLDER is a
# build (build/release) or an unpacked bundle: it has bin/shoal. Prints a table, and writes JSON
# (schema shoal-on-a-card-1) to the file JSON.
#
#   1. Each command of the GPU, and updates of each algorithm and encoder, beside the host; rates
#      of updates (shoal-gpu-trial of the build; a bundle has none, and SHOAL_GPU_TRIAL names it).
#   2. The flagship, fetch-reach-fast: wall clock, success, account.
#   3. A killed learner; a run that is resumed on the CPU, then on the GPU.
#
# --device host: the same steps with small numbers and without a GPU, for tests of this script; FOLDER
# is then a build with bin/fake_gpu (target shoal_fake_gpu).
# Exit code: 0 if all rows passed, 1 if not, 2 for wrong arguments.
set -euo pipefail

usage() {
  echo "usage: on_a_card.sh [--device host] FOLDER [JSON]" >&2
  exit 2
}

device=cuda
if [[ ${1:-} == --device ]]; then
  [[ ${2:-} == host ]] || usage
  device=host
  shift 2
fi
(($# == 1 || $# == 2)) || usage
bin=$(readlink -f "$1")/bin
json=${2:-}
[[ -x $bin/shoal ]] || { echo "on_a_card.sh: no program $bin/shoal" >&2; exit 2; }
command -v python3 >/dev/null || { echo "on_a_card.sh: needs python3" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

readonly started=$SECONDS
readonly most_seconds=360
if [[ $device == host ]]; then
  # Keys of a run that a device of the host computes in seconds.
  small=(--set learner.batch=16 --set 'network.hidden=[16]' --set learner.precision=f32
    --set replay.min_size=200 --set actors=1 --set eval.final_episodes=2 --set eval.episodes=2
    --set eval.interval=100000 --set replay.samples_per_insert=4
    --set learner.checkpoint_period=20 --set stop.success=2)
  flagship=(--preset fetch-reach-state "${small[@]}" --set env_steps=1000)
  short=(--preset fetch-reach-state "${small[@]}")
  trial=(--device host --quick)
  export LD_LIBRARY_PATH=$bin/fake_gpu FAKE_GPU=works
else
  flagship=(--preset fetch-reach-fast)
  short=(--preset fetch-reach-fast --set eval.final_episodes=5 --set eval.interval=1000000)
  trial=()
fi
short_steps=12000
if [[ $device == cuda ]]; then short_steps=8000; fi

# Seconds that are left for a step that may take $1 seconds.
seconds_for() {
  local left=$((most_seconds - (SECONDS - started)))
  echo $((left < $1 ? (left > 1 ? left : 1) : $1))
}

# row NAME FIGURE UNIT LIMIT PASSED: LIMIT is a number or null, PASSED true or false.
row() {
  printf '%s\t%s\t%s\t%s\t%s\n' "$@" >>"$work/rows"
  printf '%-4s  %-58s %12s %s\n' "$([[ $5 == true ]] && echo ok || echo FAIL)" "$1" "$2" "$3"
}

# member FILE EXPRESSION: evaluates a Python expression of the JSON object `o`.
member() {
  python3 -c 'import json, sys; o = json.load(open(sys.argv[1])); print(eval(sys.argv[2]))' "$1" "$2"
}

# truth FILE EXPRESSION: the same as `true` or `false`.
truth() {
  if [[ $(member "$1" "$2") == True ]]; then echo true; else echo false; fi
}

# train NAME ARGUMENTS...: trains in $work/runs/NAME; the log is $work/NAME.log.
train() {
  local name=$1
  shift
  timeout "$(seconds_for 120)" "$bin/shoal" train --run-dir "$work/runs" --run-name "$name" \
    --set learner.device=cuda "$@" >"$work/$name.log" 2>&1
}

# Every made record is accounted for.
readonly balanced='(lambda a: a["made"] > 0 and a["made"] == a["stored"] + a["lost_with_process"]
  + a["lost_with_replay"] + a["rejected"] + a["after_gap"] + a["discarded"])(o["accounting"])'

try_commands_and_updates() {
  local status=0 program=${SHOAL_GPU_TRIAL:-$bin/shoal-gpu-trial} loader=() root=${bin%/bin}
  if [[ ! -x $program ]]; then
    row "commands, updates and rates (no program $program)" - - null false
    return
  fi
  if [[ -d $root/libexec ]]; then  # of a bundle, with its loader and libraries
    loader=("$root/lib/ld-linux-x86-64.so.2" --inhibit-cache --library-path "$root/lib")
  fi
  # The program starts itself again unless OMP_WAIT_POLICY is set, and with a loader it cannot.
  OMP_WAIT_POLICY=passive OMP_NUM_THREADS=1 timeout "$(seconds_for 240)" \
    "${loader[@]}" "$program" "${trial[@]}" >"$work/trial.json" || status=$?
  if [[ ! -s $work/trial.json ]]; then
    row "commands, updates and rates (exit code $status)" - - null false
    return
  fi
  python3 - "$work/trial.json" <<'TEXT' >>"$work/rows"
import json, sys
for r in json.load(open(sys.argv[1]))["rows"]:
    limit = "null" if r["limit"] is None else r["limit"]
    print(r["trial"], r["figure"], r["unit"], limit, str(r["passed"]).lower(), sep="\t")
TEXT
}

train_flagship() {
  local status=0 meta=$work/runs/flagship/meta.json
  train flagship "${flagship[@]}" || status=$?
  if ((status != 0)); then
    row "flagship (exit code $status: $(tail -n 1 "$work/flagship.log"))" - - null false
    return
  fi
  row "flagship, wall clock" "$(member "$meta" 'round(o["wall_seconds"], 1)')" s 20 \
    "$(if [[ $device == host ]]; then echo true; else truth "$meta" 'o["wall_seconds"] <= 20'; fi)"
  row "flagship, success of the final episodes" "$(member "$meta" 'o["final_success_rate"]')" rate 0.98 \
    "$(if [[ $device == host ]]; then echo true; else truth "$meta" 'o["final_success_rate"] >= 0.98'; fi)"
  row "flagship, on the GPU" "$(member "$meta" 'o["learner_device"]["device"]')" device null \
    "$(truth "$meta" 'o["learner_device"]["device"] == "cuda"')"
  row "flagship, its account balances" "$(truth "$meta" "$balanced")" - null "$(truth "$meta" "$balanced")"
}

# The process id of the learner of a run, from the run's own view.
learner_of() {
  "$bin/shoal" top --once --json --run "$work/runs/$1" 2>/dev/null |
    python3 -c 'import json, sys
for p in json.load(sys.stdin)["processes"]:
    if p["role"] == "learner" and p.get("updates", 0) > 0: print(p["pid"])' 2>/dev/null || true
}

kill_a_learner() {
  local status=0 pid='' meta=$work/runs/killed/meta.json job
  train killed "${short[@]}" --set env_steps=$short_steps &
  job=$!
  while kill -0 $job 2>/dev/null && [[ -z $pid ]]; do
    pid=$(learner_of killed)
    sleep 0.2
  done
  [[ -z $pid ]] || kill -9 "$pid"
  wait $job || status=$?
  if ((status != 0)) || [[ -z $pid ]]; then
    row "a killed learner (exit code $status: $(tail -n 1 "$work/killed.log"))" - - null false
    return
  fi
  row "a killed learner is restarted, the account balances" "$(member "$meta" 'o["restarts"]')" \
    restarts null "$(truth "$meta" "o['restarts'] >= 1 and $balanced")"
}

# resume DEVICE STEPS: continues the run `killed`.
resume() {
  timeout "$(seconds_for 60)" "$bin/shoal" train --resume "$work/runs/killed" \
    --set "learner.device=$1" --set "env_steps=$2" >"$work/resume-$1.log" 2>&1
}

change_the_device() {
  local meta=$work/runs/killed/meta.json to steps=$short_steps status
  for to in cpu cuda; do
    steps=$((steps + short_steps / 2)) status=0
    resume $to $steps || status=$?
    if ((status != 0)); then
      row "resumed on $to (exit code $status: $(tail -n 1 "$work/resume-$to.log"))" - - null false
      return
    fi
    row "resumed on $to" "$(member "$meta" 'o["env_steps"]')" "env steps" $steps \
      "$(truth "$meta" "o['learner_device']['device'] == '$to' and o['env_steps'] >= $steps and $balanced")"
  done
}

: >"$work/rows"
try_commands_and_updates
train_flagship
kill_a_learner
change_the_device

if [[ -n $json ]]; then
  python3 - "$work/rows" "$json" "$device" "$((SECONDS - started))" \
    "$work/runs/flagship/meta.json" <<'TEXT'
import json, os, sys
rows_file, out, device, seconds, meta_file = sys.argv[1:]
def number(text):
    try:
        return json.loads(text)
    except ValueError:
        return text
rows = []
for line in open(rows_file):
    trial, figure, unit, limit, passed = line.rstrip("\n").split("\t")
    rows.append({"trial": trial, "figure": number(figure), "unit": unit, "limit": number(limit),
                 "passed": passed == "true"})
meta = json.load(open(meta_file)) if os.path.exists(meta_file) else {}
json.dump({"schema": "shoal-on-a-card-1", "device": device, "seconds": int(seconds),
           "commit": meta.get("commit"), "machine": meta.get("machine"),
           "learner_device": meta.get("learner_device"), "rows": rows}, open(out, "w"), indent=2)
TEXT
fi
failed=$(awk -F '\t' '$5 != "true"' "$work/rows" | wc -l)
echo "$(($(wc -l <"$work/rows") - failed)) rows passed, $failed failed, in $((SECONDS - started)) s"
((failed == 0))
