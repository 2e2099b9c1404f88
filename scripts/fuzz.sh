#!/usr/bin/env bash
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Fuzzes the readers of foreign files (tests/fuzz): libFuzzer, AddressSanitizer, UndefinedBehaviorSanitizer.
#
#   scripts/fuzz.sh                        every reader, 1 000 000 executions each: hours
#   scripts/fuzz.sh --seconds 5            every reader, 5 s each
#   scripts/fuzz.sh --runs 20000 stl obj   these readers
#   scripts/fuzz.sh --modules formats      readers of these modules: formats, records
#
# Ends with a line per reader and a sum; exit code 1 if one crashed, hung (10 s), took more than 2 GB, or
# refused a file without naming it. What did it is kept in build/dev/fuzz/READER/ as crash-*, timeout-* or
# oom-*, and what was found worth keeping beside it is where the next run begins.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh
runs=1000000 seconds=0 modules="formats records" readers=()
while [ $# -gt 0 ]; do
  case "$1" in
    --runs) runs=$2; shift 2 ;;
    --seconds) seconds=$2 runs=-1; shift 2 ;;
    --modules) modules=$2; shift 2 ;;
    -*) sed -n '6,10p' "$0" >&2; exit 2 ;;
    *) readers+=("$1"); shift ;;
  esac
done
targets=()
for module in $modules; do targets+=("fuzz_$module"); done
[ ${#readers[@]} = 0 ] || targets=("${readers[@]/#/fuzz_}")
palmar_build dev --target "${targets[@]}"
[ ${#readers[@]} != 0 ] || mapfile -t readers < <(cd build/dev/fuzz && cat ${modules// /.txt }.txt)
folder=build/dev/fuzz
node tests/fuzz/seeds.mjs "$folder/seeds"
limits=(-timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 -max_len=65536 -print_final_stats=1 -verbosity=0)
failed=0
for reader in "${readers[@]}"; do
  mkdir -p "$folder/$reader" "$folder/seeds/$reader"
  log=$folder/$reader.log begin=$SECONDS outcome=passed
  ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1 \
    "build/dev/bin/fuzz_$reader" "${limits[@]}" -runs="$runs" -max_total_time="$seconds" \
    -artifact_prefix="$folder/$reader/" "$folder/$reader" "$folder/seeds/$reader" >"$log" 2>&1 || outcome=FAILED
  count=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  memory=$(sed -n 's/^stat::peak_rss_mb: *//p' "$log")
  line=$(printf '%-16s %9s executions %5s MB at most %5s s  %s' "$reader" "${count:-?}" "${memory:-?}" $((SECONDS - begin)) "$outcome")
  echo "$line"
  [ "$outcome" = passed ] || { failed=$((failed + 1)); tail -40 "$log"; }
done
echo "$(( ${#readers[@]} - failed )) passed, $failed failed"
[ "$failed" = 0 ]
