# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# clang-tidy for ./check, which sources this file. Works on the commands of the preset `tidy`: every
# source by itself, without precompiled headers.

# palmar_tidy: every source. Prints what it finds, and how much. Ends with 1 if a name breaks the rules
# (what .clang-tidy takes for an error).
palmar_tidy() {
  local files list log; list=$(mktemp) log=$(mktemp)
  git ls-files 'src/*.cpp' 'apps/*.cpp' >"$list"
  files=$(wc -l <"$list")
  cmake --preset tidy >"$log" 2>&1 || { cat "$log" >&2; return 1; }
  xargs -a "$list" -P "$(nproc)" -I{} bash -c '
    text=$(clang-tidy -p build/tidy --quiet "$1" 2>/dev/null)
    [ -z "$text" ] || printf "%s\n" "$text" >>"$2.found"' _ {} "$log"
  echo "clang-tidy: $files sources looked at" >&2
  if [ -f "$log.found" ]; then
    cat "$log.found" >&2
    echo "clang-tidy: $(grep -cE '(warning|error): ' "$log.found") findings, above" >&2
  fi
  local outcome=0
  if grep -qsF -- ',-warnings-as-errors]' "$log.found"; then
    echo "clang-tidy: names that break the rules (\"warnings-as-errors\") have to be put right" >&2
    outcome=1
  fi
  rm -f "$list" "$log" "$log".*
  return "$outcome"
}
