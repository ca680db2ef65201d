# SPDX-License-Identifier: LGPL-2.1-or-later
# shellcheck shell=bash
# Shared by run.sh and test.sh, which source it: install what is missing, build, find a Python.

packages=(cmake ninja-build g++ git ccache libdeal.ii-dev libmumps-dev libcli11-dev libgtest-dev
  libopenblas0-serial mpi-default-bin python3-numpy python3-h5py python3-matplotlib python3-pandas)

fail() {
  echo "error: $*" >&2
  exit 1
}

# install_missing PACKAGE...: those of them that are missing.
install_missing() {
  local package missing=()
  for package in "$@"; do
    [[ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" == installed ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0

  echo "Installing ${missing[*]}"
  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null || fail "no sudo here; as root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  local output
  output=$(mktemp)
  if ! { "${as_root[@]}" apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"; } \
    >"$output" 2>&1; then
    tail -n 30 "$output" >&2
    rm -f "$output"
    fail "apt-get could not install ${missing[*]}"
  fi
  rm -f "$output"
}

install_packages() {
  command -v dpkg-query >/dev/null || {
    echo "note: not a Debian system; needed are deal.II 9.4 with MPI, p4est, Trilinos and HDF5, MUMPS, CLI11," \
      "GoogleTest, CMake, Ninja and, for the pictures, Python with numpy, h5py, matplotlib and pandas" >&2
    return 0
  }
  install_missing "${packages[@]}"
  # deal.II hands on the linker that it was built with, which its package does not depend on: mold on Debian 13.
  local linker
  linker=$(sed -nE 's/^set\(DEAL_II_LINKER_FLAGS ".*-fuse-ld=([a-z]+).*/\1/Ip' \
    /usr/share/cmake/deal.II/deal.IIConfig.cmake 2>/dev/null || true)
  [[ -z "$linker" ]] || command -v "ld.$linker" >/dev/null || install_missing "${linker/#gold/binutils-gold}"
}

# build TOP [TARGET...]: the release build in TOP/build/release; quiet unless it fails.
build() {
  local top=$1 directory=$1/build/release
  shift
  mkdir -p "$directory"
  local log=$directory/build.log jobs
  # deal.II's headers take up to 2 GB of memory per compiler.
  jobs=$(awk '/MemAvailable/ {print int($2 / 2000000)}' /proc/meminfo 2>/dev/null || echo 1)
  jobs=$((jobs > $(nproc) ? $(nproc) : jobs))
  jobs=$((jobs < 1 ? 1 : jobs))
  echo "Building in $directory (takes minutes the first time)"
  local options=(-DCMAKE_BUILD_TYPE=Release -DGEMMULE_NATIVE_ARCHITECTURE=ON)
  # Half the time when everything is compiled; a directory that is there stays as it was configured.
  [[ -f "$directory/CMakeCache.txt" ]] || options+=(-DCMAKE_UNITY_BUILD=ON)
  if ! { cmake -S "$top" -B "$directory" -G Ninja "${options[@]}" &&
    ninja -C "$directory" -j "$jobs" "$@"; } >"$log" 2>&1; then
    grep -nE -A5 'error|Error|FAILED' "$log" | head -n 60 >&2 || true
    fail "the build failed; everything it said is in $log"
  fi
}

# Prints a Python 3 that has the packages of postprocess/; the first python3 may be another one.
find_python() {
  local candidate
  for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import numpy, h5py, matplotlib, pandas' >/dev/null 2>&1; then
      echo "$candidate"
      return 0
    fi
  done
  return 1
}
