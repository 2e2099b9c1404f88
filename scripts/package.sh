#!/usr/bin/env bash
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Makes Debian packages: build/packages/palmar_VERSION_ARCH.deb and palmar-dev_VERSION_ARCH.deb.
#
#   scripts/package.sh            make them
#   scripts/package.sh --check    and install them in a clean Debian 12 in a folder of its own, run them
#                                 there, remove them, and look for what was left (needs root)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh
check=0
case "${1:-}" in
  "") ;;
  --check) check=1 ;;
  *) echo "usage: scripts/package.sh [--check]   (got: $1)" >&2; exit 2 ;;
esac
palmar_setup "${palmar_cad_packages[@]}" "${palmar_photo_packages[@]}" dpkg-dev
cmake --preset release >/dev/null
cmake --build --preset release --target palmar palmar-hands palmar-redesign palmar-serve palmar-cad palmar-dicom palmar-photo \
  palmar_template manual
rm -rf build/packages
cpack --config build/release/CPackConfig.cmake -B build/packages
rm -rf build/packages/_CPack_Packages
ls -l build/packages/*.deb
[ "$check" = 1 ] || exit 0

command -v debootstrap >/dev/null || palmar_apt_install debootstrap
clean=$(mktemp -d)
trap 'umount "$clean/proc" 2>/dev/null || true; rm -rf "$clean"' EXIT
# The mirror of this machine's own Debian.
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -v security | head -n 1)
echo "== a clean Debian 12 in $clean"
debootstrap --variant=minbase bookworm "$clean" "$mirror" >"$clean.log" 2>&1 || { tail "$clean.log" >&2; exit 1; }
rm -f "$clean.log"
mount -t proc proc "$clean/proc"
cp -a /etc/apt/. "$clean/etc/apt/"
[ -e /etc/resolv.conf ] && cp -L /etc/resolv.conf "$clean/etc/resolv.conf"
cp build/packages/*.deb "$clean/tmp/"
inside() { chroot "$clean" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive bash -euc "$1"; }
inside 'apt-get update -qq'
inside 'find / -xdev -path /proc -prune -o -path /var -prune -o -path /tmp -prune -o -print | sort' >"$clean/tmp/before"
echo "== installed in"
time inside 'apt-get install -y -qq --no-install-recommends /tmp/palmar_*.deb >/tmp/install.log 2>&1 || { cat /tmp/install.log; exit 1; }'
inside 'palmar --version; du -sh --total /usr | tail -n 1'
echo "== the first ten minutes: a product, a report, a study, a hand from nothing"
time inside 'cd /root; palmar doctor || true
  palmar product make prism --fillet-mm 3 --out handle.step
  palmar assess handle.step --out report
  test -s report/report.html || ls report
  palmar study run --product handle.step --population ansur2_women --hands 4 --out handle.palmar --quiet
  palmar study report handle.palmar --out study-report --quiet
  test -s /usr/share/man/man1/palmar-assess.1.gz -o -s /usr/share/man/man1/palmar-assess.1'
inside 'source /usr/share/bash-completion/completions/palmar
  COMP_WORDS=(palmar redesign sh) COMP_CWORD=2; _palmar; test "${COMPREPLY[*]}" = shape'
inside '/usr/lib/palmar/slicer/palmar-assess --xml | grep -q "<executable>"
  /usr/lib/palmar/slicer/palmar-hand-from-mri --xml | grep -q "<executable>"'
echo "== removed"
inside 'apt-get purge -y -qq palmar >/dev/null; apt-get autoremove --purge -y -qq >/dev/null
  rm -rf /root/report /root/study-report /root/handle.step /root/handle.palmar'
inside 'find / -xdev -path /proc -prune -o -path /var -prune -o -path /tmp -prune -o -print | sort' >"$clean/tmp/after"
left=$(comm -13 "$clean/tmp/before" "$clean/tmp/after" | grep -i palmar || true)
if [ -n "$left" ]; then echo "left behind:"; echo "$left"; exit 1; fi
echo "nothing of palmar is left"
