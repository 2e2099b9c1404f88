# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# clang-tidy for ./check, which sources this file. Works on the commands of the preset `tidy`: every
# source by itself, without precompiled headers.

# palmar_tidy all | palmar_tidy changed SECONDS: every source, or those that changed since the last
# release (the newest tag; without one, the commit named in .ci/tidy-base), the most recently changed
# first, for as long as the seconds last. Prints what it finds, and how much. Ends with 1 if a name breaks the
# rules (what .clang-tidy takes for an error).
palmar_tidy() {
  local base files list log; list=$(mktemp) log=$(mktemp)
  if [ "$1" = all ]; then
    git ls-files 'src/*.cpp' 'apps/*.cpp' >"$list"
  else
    base=$(git describe --tags --abbrev=0 2>/dev/null || cat .ci/tidy-base)
    # A clone without that commit's history can't say what changed.
    git cat-file -e "$base^{commit}" 2>/dev/null ||
      { echo "clang-tidy: skipped, this clone doesn't hold $base" >&2; rm -f "$list" "$log"; return 0; }
    git log --diff-filter=AMR --name-only --format= "$base"..HEAD -- 'src/*.cpp' 'apps/*.cpp' | awk '!seen[$0]++' |
      while read -r file; do [ -f "$file" ] && echo "$file"; done >"$list" || true
  fi
  files=$(wc -l <"$list")
  cmake --preset tidy >"$log" 2>&1 || { cat "$log" >&2; return 1; }
  local end=$(( $(date +%s) + ${2:-1000000} ))
  # One line per file that is done, so that what time allowed can be told.
  xargs -a "$list" -P "$(nproc)" -I{} bash -c '
    (( $(date +%s) < $1 )) || exit 0
    text=$(clang-tidy -p build/tidy --quiet "$2" 2>/dev/null)
    [ -z "$text" ] || printf "%s\n" "$text" >>"$3.found"
    echo "$2" >>"$3.done"' _ "$end" {} "$log"
  local finished=0
  [ ! -f "$log.done" ] || finished=$(wc -l <"$log.done")
  echo "clang-tidy: $finished of $files sources looked at" >&2
  (( finished == files )) || echo "  (the others didn't fit into the time; ./check --full looks at all)" >&2
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
