#!/usr/bin/env bash
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# The Debian packages, installed, run and removed in a clean Debian 12 (scripts/package.sh --check).
set -euo pipefail
if [ "$(id -u)" != 0 ]; then echo "skipped: a clean Debian in a folder needs root"; exit 77; fi
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/package.sh" --check
