#!/usr/bin/env bash
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Makes build/packages/palmar-VERSION-x86_64-linux.tar.xz: Palmar for any x86-64 Linux, wherever it is unpacked.
# It brings all libraries, the C library and its loader among them, with their licences in share/doc; bin/ has
# starters that run the programs of libexec/ with these.
#
#   scripts/archive.sh            make it
#   scripts/archive.sh --check    and run it in a bare Debian 11 (August 2021), moved once (needs root)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh
check=0
case "${1:-}" in
  "") ;;
  --check) check=1 ;;
  *) echo "usage: scripts/archive.sh [--check]   (got: $1)" >&2; exit 2 ;;
esac
programs=(palmar palmar-hands palmar-redesign palmar-serve palmar-cad palmar-dicom palmar-photo)
palmar_setup "${palmar_cad_packages[@]}" "${palmar_photo_packages[@]}" xz-utils binutils
cmake --preset release >/dev/null
cmake --build --preset release --target "${programs[@]}" palmar_template palmar_build_text manual
version=$(build/release/bin/palmar --version | sed -nE '1s/^palmar ([^,]+),.*/\1/p')
name=palmar-$version-x86_64-linux
work=$(mktemp -d)
trap 'umount "$work/clean/proc" 2>/dev/null || true; rm -rf "$work"' EXIT
root=$work/$name
mkdir -p "$root"/{bin,lib,libexec} "$root/share/doc/palmar/licences"
for program in "${programs[@]}"; do
  strip -o "$root/libexec/$program" "build/release/bin/$program"
  cat >"$root/bin/$program" <<'SH'
#!/bin/sh
# Runs the program of the same name in ../libexec with the libraries of ../lib, and tells it where it is.
here=$(dirname "$(readlink -f "$0")")
program=$(basename "$(readlink -f "$0")")
PALMAR_PROGRAM=$here/$program
export PALMAR_PROGRAM
exec "$here/../lib/ld-linux-x86-64.so.2" --argv0 "$0" --library-path "$here/../lib" "$here/../libexec/$program" "$@"
SH
  chmod +x "$root/bin/$program"
done
libraries=$(for program in "${programs[@]}"; do ldd "build/release/bin/$program"; done |
            sed -nE 's/.* => (\/[^ ]+) .*/\1/p; s/^\s*(\/[^ ]+ld-linux[^ ]+) .*/\1/p' | sort -u)
cp -L $libraries "$root/lib/"
cp -a build/release/share/palmar "$root/share/"
mkdir "$root/lib/palmar"
cp -a build/release/lib/palmar/slicer "$root/lib/palmar/"
cp -a build/release/manual/man "$root/share/"
cp -a build/release/manual/completions examples CHANGELOG.md LICENSE docs/developing/third-party.md "$root/share/doc/palmar/"
# The licence of every library, by the Debian package that it is from.
for package in $(dpkg -S $(for one in $libraries; do echo "$one"; readlink -f "$one"; done) 2>/dev/null | cut -d: -f1 | sort -u); do
  [ ! -e "/usr/share/doc/$package/copyright" ] || cp -L "/usr/share/doc/$package/copyright" "$root/share/doc/palmar/licences/$package"
done
mkdir -p build/packages
XZ_OPT="-6 -T0" tar -C "$work" --owner=0 --group=0 --sort=name -cJf "$work/archive" "$name"
mv "$work/archive" "build/packages/$name.tar.xz"
echo "$(du -m "build/packages/$name.tar.xz" | cut -f1) MB packed, $(du -sm "$root" | cut -f1) MB unpacked, $(ls "$root/lib" | wc -l) libraries, $(ls "$root/share/doc/palmar/licences" | wc -l) licences: build/packages/$name.tar.xz"
[ "$check" = 1 ] || exit 0

command -v debootstrap >/dev/null || palmar_apt_install debootstrap
clean=$work/clean
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -v security | head -n 1)
echo "== a bare Debian 11"
debootstrap --variant=minbase bullseye "$clean" "$mirror" >"$work/log" 2>&1 || { tail "$work/log" >&2; exit 1; }
mount -t proc proc "$clean/proc"
tar -C "$clean/opt" -xf "build/packages/$name.tar.xz"
inside() { chroot "$clean" /usr/bin/env -i HOME=/root PATH=/usr/bin:/bin bash -euc "$1"; }
inside "ldd --version | head -n 1; /opt/$name/bin/palmar --version; /opt/$name/bin/palmar doctor"
inside "cd /root; palmar=/opt/$name/bin/palmar
  \$palmar product make prism --fillet-mm 3 --out handle.step
  \$palmar assess handle.step --out report >/dev/null; test -s report/report.html
  /opt/$name/lib/palmar/slicer/palmar-assess --xml | grep -q '<executable>'
  mv /opt/$name '/opt/some where else'; palmar='/opt/some where else/bin/palmar'
  \"\$palmar\" study run --product handle.step --population ansur2_women --hands 2 --out handle.palmar --quiet
  \"\$palmar\" study report handle.palmar --out study-report --quiet
  \"\$palmar\" redesign press handle.step --hands 2 --no-compare --no-pictures --out pressed --quiet; test -s pressed/pressed.step
  \"\$palmar\" phantom --help >/dev/null"
# The same bytes as on this machine.
cp "$clean/root/handle.step" "$work/"
build/release/bin/palmar study run --product "$work/handle.step" --population ansur2_women --hands 2 --out "$work/handle.palmar" --quiet >"$work/here.txt"
there=$(inside "rm -f /root/again.palmar; cd /root; '/opt/some where else/bin/palmar' study run --product handle.step --population ansur2_women --hands 2 --out again.palmar --quiet" | sed -nE 's/^results ([0-9a-f]+).*/\1/p')
here=$(sed -nE 's/^results ([0-9a-f]+).*/\1/p' "$work/here.txt")
[ -n "$here" ] && [ "$here" = "$there" ] || { echo "other results there ($there) than here ($here)" >&2; exit 1; }
echo "runs in Debian 11, moved, with the results of this machine"
