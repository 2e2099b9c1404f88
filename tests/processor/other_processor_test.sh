#!/usr/bin/env bash
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# The same bytes on another processor: one shard of a study as this processor's C library computes it,
# one as a processor without the fused multiply-add would have it, merged; and an assessment by both.
#
#   other_processor_test.sh PALMAR
set -euo pipefail
palmar=$(realpath "${1:?path of palmar}")
work=$(mktemp -d /tmp/palmar-processor.XXXXXX)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "FAILED: $*" >&2; exit 1; }
older() { env GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX2_Usable "$@"; }

cat >study.toml <<'TOML'
[study]
name = "two processors"
[[population]]
preset = "ansur2_women"
hands = 2
[[product]]
name = "handle"
kind = "prism"
width_mm = 30
depth_mm = 40
fillet_mm = 5
length_mm = 120
[[product]]
name = "round"
kind = "cylinder"
diameter_mm = 35
length_mm = 120
TOML
"$palmar" study run study.toml --quiet --out whole.palmar >whole.txt
"$palmar" study run study.toml --quiet --shard 1/2 --out shards/shard-1-of-2.palmar >one.txt
older "$palmar" study run study.toml --quiet --shard 2/2 --out shards/shard-2-of-2.palmar >two.txt
"$palmar" study merge shards --quiet --out merged.palmar >merged.txt 2>&1 || fail "merge: $(cat merged.txt)"
cmp whole.palmar merged.palmar || fail "the shard of the other processor has other bytes"

for kind in cylinder prism; do
  "$palmar" product make $kind --quiet --out here.stl
  older "$palmar" product make $kind --quiet --out there.stl
  cmp here.stl there.stl || fail "product make $kind"
done
for name in here there; do
  run=(env); [ $name = here ] || run=(older)
  "${run[@]}" "$palmar" assess there.stl --unit mm --no-pictures --json --quiet >$name.json
done
cmp here.json there.json || fail "assess"
echo "the same bytes"
