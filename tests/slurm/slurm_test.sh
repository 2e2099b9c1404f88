#!/usr/bin/env bash
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# A study as a job array of a real Slurm: `study submit`, one task killed with SIGKILL on the way
# and put into the queue again, `study status`, `study merge`; the merged store must have the bytes
# of one run on one process. Exit code 77: no Slurm can be started here (the reason is told).
#
#   slurm_test.sh PALMAR
set -euo pipefail
palmar=$(realpath "${1:?path of palmar}")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d /tmp/palmar-slurm.XXXXXX)
chmod 755 "$work"
fail() { echo "FAILED: $*" >&2; tail -n 20 "$work"/slurm/log/*.log "$work"/shards/*.log >&2 2>/dev/null || true; exit 1; }
cleanup() { "$here/start_slurm.sh" stop "$work/slurm" || true; rm -rf "$work"; }
trap cleanup EXIT

settings=$("$here/start_slurm.sh" start "$work/slurm") || exit $?
eval "$settings"
cd "$work"
cat >study.toml <<'TOML'
[study]
name = "array"
[[population]]
preset = "ansur2_men"
hands = 9
[[product]]
name = "thin"
kind = "cylinder"
diameter_mm = 30
length_mm = 120
[[product]]
name = "thick"
kind = "cylinder"
diameter_mm = 45
length_mm = 120
[settings]
indices = false
TOML
"$palmar" study run study.toml --quiet --out whole.palmar >whole.txt
"$palmar" study submit study.toml --shards 3 --out shards --quiet >submit.txt || fail "study submit"
job=$(sed -n 's/^job \([0-9]*\):.*/\1/p' submit.txt)
[ -n "$job" ] || fail "no number of the job in: $(cat submit.txt)"
grep -q '^#SBATCH --mem=' shards/submit.sh || fail "no memory asked for"

# Kill the palmar of one shard once it has finished some of its grasps.
killed=0
for _ in $(seq 1200); do
  for note in shards/*-progress; do
    grep -q '"done": [1-9]' "$note" 2>/dev/null || continue
    pid=$(sed -n 's/.*"process": *\([0-9]*\).*/\1/p' "$note")
    [ "$(readlink "/proc/$pid/exe")" = "$palmar" ] || continue
    if kill -9 "$pid" 2>/dev/null; then killed=1 victim=$note; break 2; fi
  done
  sleep 0.05
done
[ "$killed" = 1 ] || fail "no task was caught running"
echo "killed process $pid of ${victim%-progress}"
"$palmar" study status shards | tee status.txt
[ "$(grep -c '^stopped' status.txt)" = 1 ] || fail "more than one shard was stopped"

# Slurm holds back a job that was put into the queue again for two minutes, so that what is left of
# it on the node is gone; five seconds are enough here.
queued_at=
for _ in $(seq 900); do
  waiting=$(squeue -h -t PD -o '%i %r' | awk '/BeginTime/ { print $1 }')
  if [ -n "$waiting" ] && [ -z "$queued_at" ]; then queued_at=$SECONDS; fi
  if [ -n "$waiting" ] && [ $((SECONDS - queued_at)) -ge 5 ]; then
    for one in $waiting; do scontrol update "JobId=$one" StartTime=now || true; done
  fi
  [ -n "$(squeue -h -j "$job" 2>/dev/null)" ] || break
  sleep 0.2
done
[ -z "$(squeue -h -j "$job" 2>/dev/null)" ] || fail "the array does not end: $(squeue)"
"$palmar" study status shards | tee status.txt
[ "$(grep -c '^finished' status.txt)" = 3 ] || fail "not every shard is finished"
[ "$(grep -l 'Killed' shards/*.log | wc -l)" = 1 ] || fail "not one task was killed"
"$palmar" study merge shards --out merged.palmar --quiet || fail "study merge"
cmp whole.palmar merged.palmar || fail "merged shards differ from one run"
echo "passed: 3 shards, one of them killed and queued again, joined to the bytes of one run"
