#!/usr/bin/env bash
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# What goes wrong while a study runs: killed at any moment (alone, in shards, while merging), the terminal
# closed, a full disk, a folder that can't be written, a clock that jumps. Whatever it was, the study goes on
# afterwards and ends with the bytes of one that nothing happened to.
#
#   faults_test.sh PALMAR [ROUNDS]     1 round (in ./check) takes about half a minute; before a release 40
#   FAULTS_SEED=N                      other moments
set -euo pipefail
palmar=$(realpath "${1:?path of palmar}")
rounds=${2:-1}
RANDOM=${FAULTS_SEED:-2014}
work=$(mktemp -d /tmp/palmar-faults.XXXXXX)
cleanup() { umount "$work/small" 2>/dev/null || true; chmod -R u+w "$work"; rm -rf "$work"; }
trap cleanup EXIT
cd "$work"
fail() { echo "FAILED: $*" >&2; exit 1; }
passed=0
done_with() { passed=$((passed + 1)); echo "$* ($SECONDS s)"; }

cat >study.toml <<'TOML'
[study]
name = "faults"
[[population]]
preset = "ansur2_women"
hands = 3
[[product]]
name = "round"
kind = "cylinder"
diameter_mm = 35
length_mm = 120
TOML
begin=$(date +%s%N)
"$palmar" study run study.toml --quiet --out whole.palmar >whole.txt
duration=$(( ($(date +%s%N) - begin) / 1000000 ))  # ms of an unbroken run
echo "unbroken: $duration ms"
# A moment of an unbroken run, in seconds.
moment() { printf '%d.%03d' $((RANDOM % duration / 1000)) $((RANDOM % 1000)); }
# Runs palmar and sends a signal after some seconds; whatever it comes to.
struck() {
  local signal=$1 after=$2
  shift 2
  (timeout --signal="$signal" "$after" "$palmar" "$@" --quiet >struck.txt 2>&1 || true) 2>/dev/null
}
resumed() {
  [ -e "$1" ] || "$palmar" study run study.toml --quiet --out "$1" >/dev/null
  "$palmar" study resume "$1" --quiet >resumed.txt 2>&1 || fail "$2: resume: $(cat resumed.txt)"
  cmp whole.palmar "$1" || fail "$2: other bytes than the unbroken run's"
}

for ((round = 1; round <= rounds; ++round)); do
  rm -f killed.palmar*
  struck KILL "$(moment)" study run study.toml --out killed.palmar
  for strike in 1 2; do
    [ ! -e killed.palmar ] || struck KILL "$(moment)" study resume killed.palmar
  done
  resumed killed.palmar "killed, round $round"
done
done_with "killed $((3 * rounds)) times: went on, same bytes"

for ((round = 1; round <= (rounds + 1) / 2; ++round)); do
  rm -rf shards merged.palmar*
  for k in 1 2 3; do
    store=shards/shard-$k-of-3.palmar
    struck KILL "$(moment)" study run study.toml --shard $k/3 --out $store
    "$palmar" study run study.toml --quiet --shard $k/3 --out $store >resumed.txt 2>&1 || fail "shard $k: $(cat resumed.txt)"
  done
  struck KILL 0.0$((RANDOM % 10)) study merge shards --out merged.palmar
  rm -f merged.palmar.part* 2>/dev/null || true
  [ -e merged.palmar ] || "$palmar" study merge shards --quiet --out merged.palmar >merged.txt 2>&1 || fail "merge: $(cat merged.txt)"
  cmp whole.palmar merged.palmar || fail "merged shards: other bytes"
done
done_with "shards and merging killed: same bytes"

for signal in HUP TERM INT; do
  rm -f ended.palmar*
  "$palmar" study run study.toml --quiet --out ended.palmar >ended.txt 2>&1 &
  sleep $((duration / 2000)).$((duration / 2 % 1000 / 100))
  outcome=0
  kill -$signal $! 2>/dev/null || true
  wait $! || outcome=$?
  # It may have been done already, or ignored by who started this (nohup; a background job ignores INT).
  [ $outcome = 0 ] || [ $outcome = 130 ] || fail "SIG$signal: exit code $outcome: $(cat ended.txt)"
  [ $outcome = 0 ] || grep -q "grasps are kept" ended.txt || fail "SIG$signal: $(cat ended.txt)"
  resumed ended.palmar "SIG$signal"
done
done_with "SIGHUP, SIGTERM, SIGINT: ended in order, same bytes"

# A full disk: of root in a small file system of its own, of others by the largest size of a file.
mkdir -p small
outcome=0
if mount -t tmpfs -o size=96k none small 2>/dev/null; then
  "$palmar" study run study.toml --quiet --out small/full.palmar >full.txt 2>&1 || outcome=$?
else
  (ulimit -f 64; trap '' XFSZ; "$palmar" study run study.toml --quiet --out small/full.palmar >full.txt 2>&1) || outcome=$?
fi
[ $outcome = 1 ] || fail "full disk: exit code $outcome: $(cat full.txt)"
grep -q "full.palmar" full.txt || fail "full disk: the message names no file: $(cat full.txt)"
mount -o remount,size=64m small 2>/dev/null || true
resumed small/full.palmar "full disk"
umount small 2>/dev/null || true
done_with "full disk: told, and the study went on when there was room"

# A folder that can't be written: root may, but for a file system that is mounted so.
mkdir -p locked
outcome=0
if mount -t tmpfs -o ro none locked 2>/dev/null; then
  "$palmar" study run study.toml --quiet --out locked/a.palmar >locked.txt 2>&1 || outcome=$?
  umount locked
elif chmod a-w locked && ! touch locked/x 2>/dev/null; then
  "$palmar" study run study.toml --quiet --out locked/a.palmar >locked.txt 2>&1 || outcome=$?
else
  outcome=1; echo "locked/a.palmar" >locked.txt
fi
[ $outcome = 1 ] || fail "read-only folder: exit code $outcome: $(cat locked.txt)"
grep -q "locked/a.palmar" locked.txt || fail "read-only folder: the message names no file: $(cat locked.txt)"
done_with "read-only folder: told"

if command -v faketime >/dev/null; then
  rm -f clock.palmar*
  (timeout --signal=KILL $((duration / 2000)).5 faketime -f '+2y' "$palmar" study run study.toml --quiet --out clock.palmar >/dev/null 2>&1 || true) 2>/dev/null
  [ ! -e clock.palmar ] || faketime -f '-3y' "$palmar" study status clock.palmar >/dev/null || fail "clock: status"
  [ ! -e clock.palmar ] || faketime -f '-3y x20' "$palmar" study resume clock.palmar --quiet >clock.txt 2>&1 || fail "clock: $(cat clock.txt)"
  resumed clock.palmar "clock that jumps"
  done_with "a clock that jumps by years: same bytes"
else
  echo "faketime isn't installed: no clock jumped"
fi
echo "$passed passed, 0 failed"
