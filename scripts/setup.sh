# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Installs what a fresh Debian 12 machine lacks; says nothing when nothing is to do. Sourced by
# ./demo, ./check and .ci/run from the root of the checkout.

# What the program palmar needs.
palmar_packages=(
  build-essential clang cmake ninja-build pkg-config git
  libeigen3-dev libtbb-dev libembree-dev libpng-dev libjpeg-dev zlib1g-dev
  nlohmann-json3-dev libcli11-dev libfmt-dev libtomlplusplus-dev libboost-dev libsqlite3-dev
  libnlopt-cxx-dev libexif-dev duktape-dev musl-dev
)
# What palmar-photo and palmar-dicom need: boards in photographs, compressed images.
palmar_photo_packages=(libopencv-contrib-dev libgdcm-dev)
# What palmar-cad needs: CAD files.
palmar_cad_packages=(libocct-data-exchange-dev)
# What the Python package needs.
palmar_python_packages=(pybind11-dev python3-dev python3-numpy)
# What photographs, tests, benchmarks and checks need.
palmar_check_packages=(
  "${palmar_photo_packages[@]}"
  libgtest-dev libgmock-dev libbenchmark-dev
  clang-format libclang-rt-dev libxml2-utils
  "${palmar_python_packages[@]}"
)

palmar_as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif command -v sudo >/dev/null 2>&1; then sudo "$@"
  else echo "Palmar's set-up needs root or sudo to run: $*" >&2; return 1
  fi
}

palmar_apt_install() {
  local log; log=$(mktemp)
  echo "Installing: $*" >&2
  if ! { palmar_as_root apt-get update -qq &&
         palmar_as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@"; } >"$log" 2>&1; then
    cat "$log" >&2; rm -f "$log"
    echo "Palmar's set-up could not install the packages above; it was tried on Debian 12." >&2
    return 1
  fi
  rm -f "$log"
}

# palmar_setup [PACKAGE...]: what palmar needs, and these.
palmar_setup() {
  local missing=() package
  for package in "${palmar_packages[@]}" "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
  done
  command -v node >/dev/null 2>&1 || missing+=(nodejs)
  command -v npm >/dev/null 2>&1 || missing+=(npm)
  if [ ${#missing[@]} -gt 0 ]; then palmar_apt_install "${missing[@]}" || return 1; fi

  # The pinned build-time assets: the template hand's skin and the parts of the report's viewer.
  if ! cmp -s package-lock.json node_modules/.palmar-lock; then
    echo "Fetching the pinned npm packages" >&2
    local log; log=$(mktemp)
    if ! npm ci --no-audit --no-fund >"$log" 2>&1; then
      cat "$log" >&2; rm -f "$log"
      return 1
    fi
    rm -f "$log"
    cp package-lock.json node_modules/.palmar-lock
  fi
}

# palmar_build PRESET [OPTION...]: configures (when needed) and builds; says how far it is when that takes
# long, and the end of the log when it fails.
palmar_build() {
  local preset=$1 log; log=$(mktemp)
  shift
  if ! { cmake --preset "$preset" >"$log" 2>&1 &&
         cmake --build --preset "$preset" "$@" 2>&1 | tee -a "$log" | awk -F'[][/]' '
           /^\[[0-9]+\/[0-9]+\]/ && $3 > 20 && int(10 * $2 / $3) > tenths {
             tenths = int(10 * $2 / $3); printf "  %3d %% of %d steps\n", 10 * tenths, $3; fflush() }' >&2; }; then
    tail -n 60 "$log" >&2; rm -f "$log"
    echo "The $preset build failed; the end of its log is above." >&2
    return 1
  fi
  rm -f "$log"
}
