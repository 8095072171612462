# Sourced by python/demo.sh and tests/run.sh: makes the checkout ready to use on a bare Debian or Ubuntu machine.
#
#   source setup.sh demo     a compiler, CMake, Eigen and the Python package with its plots
#   source setup.sh tests    the same, the C++ test libraries, ccache, the Python test tools and, on Debian, a browser
#   source setup.sh sanitize as tests, and clang 14 with its sanitizers
#
# A caller may list more programs, packages of their names, in `programs`.
#
# Installs with apt what is missing and nothing else, keeps everything of its own in build/, and leaves in the
# environment: root (the checkout), python and bin (of the virtual environment), CXX (the C++ compiler) and jobs.

set -euo pipefail

purpose=$1
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
jobs=$(nproc)

say() { printf 'wakeline: %s\n' "$*" >&2; }
fail() { say "$*"; exit 1; }

# --- what the machine must have -------------------------------------------------------------------------------------

# Ubuntu has its browser as a snap alone; there the tests of the screen are skipped.
is_debian() { grep -qs '^ID=debian$' /etc/os-release; }
has_cmake() { cmake --version >/dev/null 2>&1; }
has_make() { make --version >/dev/null 2>&1; }  # what CMake builds with unless another is named
has_header() { [[ -e /usr/include/$1 || -e /usr/local/include/$1 ]]; }
has_sanitizers() { clang++-14 -fsanitize=address,undefined -x c++ -o /dev/null - <<<'int main() {}' >/dev/null 2>&1; }

# A C++20 compiler: $CXX when set, else g++ 12 or newer.
find_compiler() {
  local candidate version
  if [[ -n ${CXX:-} ]]; then
    command -v "${CXX%% *}" >/dev/null || fail "the compiler CXX=$CXX does not exist"
    return 0
  fi
  for candidate in g++ g++-12 g++-13 g++-14 g++-15; do
    version=$("$candidate" -dumpversion 2>/dev/null) || continue
    if ((${version%%.*} >= 12)); then
      export CXX=$candidate
      return 0
    fi
  done
  return 1
}

# A Python 3.10 or newer that can make virtual environments and has its headers.
find_python() {
  local candidate
  while IFS= read -r candidate; do
    if "$candidate" - >/dev/null 2>&1 <<'PYTHON'; then
import ensurepip, pathlib, sys, sysconfig, venv
assert sys.version_info >= (3, 10)
assert pathlib.Path(sysconfig.get_paths()["include"], "Python.h").exists()
PYTHON
      system_python=$candidate
      return 0
    fi
  done < <(type -ap python3 python3.14 python3.13 python3.12 python3.11 python3.10)
  return 1
}

missing_packages() {
  has_cmake || echo cmake
  has_make || echo make
  find_compiler || echo g++-12-or-newer
  find_python || echo python3 python3-dev python3-venv
  has_header eigen3/Eigen/Core || echo libeigen3-dev
  if [[ $purpose != demo ]]; then
    command -v ccache >/dev/null || echo ccache
    has_header gtest/gtest.h || echo libgtest-dev
    has_header benchmark/benchmark.h || echo libbenchmark-dev
    has_header nlohmann/json.hpp || echo nlohmann-json3-dev
    if is_debian; then
      command -v chromium >/dev/null || echo chromium
      command -v chromedriver >/dev/null || echo chromium-driver
    fi
    command -v tshark >/dev/null || echo tshark
    command -v gpsbabel >/dev/null || echo gpsbabel
    # Its package brings a desktop, of 400 MB: tests skip where it is missing.
    [[ -z ${CI:-} ]] || command -v gpsdecode >/dev/null || echo gpsd-clients
    command -v ogrinfo >/dev/null || echo gdal-bin
  fi
  for program in "${programs[@]}"; do command -v "$program" >/dev/null || echo "$program"; done
  if [[ $purpose == sanitize ]]; then has_sanitizers || echo clang-14 libclang-rt-14-dev; fi
}

# The distribution's own g++ when it is new enough; Ubuntu 22.04 has g++-12 beside an older one.
compiler_package() {
  local version
  version=$(apt-cache policy g++ | awk '/Candidate:/ {sub(/^[0-9]+:/, "", $2); print int($2)}')
  if ((${version:-0} >= 12)); then echo g++; else echo g++-12; fi
}

install_packages() {
  local packages=("$@") as_root=()
  command -v apt-get >/dev/null ||
    fail "missing: $*; there is no apt-get here to install them: please do it by hand and run this again"
  if ((EUID != 0)); then
    command -v sudo >/dev/null || fail "missing: $*; installing them needs root or sudo"
    as_root=(sudo)
  fi
  say "installing with apt-get: $*"
  "${as_root[@]}" apt-get update -qq || fail "apt-get update failed"
  packages=("${packages[@]/g++-12-or-newer/$(compiler_package)}")
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${packages[@]}" >/dev/null ||
    fail "apt-get could not install: ${packages[*]}"
}

read -ra missing < <(missing_packages | xargs) || true
if ((${#missing[@]} > 0)); then
  install_packages "${missing[@]}"
  hash -r
  read -ra missing < <(missing_packages | xargs) || true
  ((${#missing[@]} == 0)) || fail "still missing after the installation: ${missing[*]} (wanted: g++ 12 and Python 3.10, or newer)"
fi
find_compiler
find_python

# --- the virtual environment and the package in it ------------------------------------------------------------------

mkdir -p "$root/build"
exec 9>"$root/build/setup.lock"
flock 9

bin=$root/build/venv/bin
python=$bin/python
if ! "$python" -m pip --version >/dev/null 2>&1; then
  say "making the virtual environment build/venv with $("$system_python" --version)"
  rm -rf "$root/build/venv"
  "$system_python" -m venv "$root/build/venv"
fi

# A package for tests has all that the demo needs. Both are for this machine's processor alone.
if [[ $purpose == demo ]]; then extra=plot; else extra=dev; fi
fingerprint=$(
  cd "$root"
  {
    find CMakeLists.txt pyproject.toml README.md bindings cpp/benchmarks cpp/cmake cpp/include python/wakeline \
      -type f ! -name '*.pyc' -print0 | LC_ALL=C sort -z | xargs -0 sha256sum
    "$python" --version
    "$CXX" --version
    grep -m 1 '^flags' /proc/cpuinfo || true
  } | sha256sum
)
stamp_of() { echo "$root/build/venv/wakeline-$1.stamp"; }
is_installed() { [[ -e $(stamp_of "$1") && $(<"$(stamp_of "$1")") == "$fingerprint" ]]; }

# Reports the progress of a build from its output.
show_progress() {
  local line of='' said=''
  while IFS= read -r line; do
    if [[ $line =~ ^\ *\[\ *([1-9][0-9]*)(/[0-9]+|%)\] ]]; then
      of="${BASH_REMATCH[1]}${BASH_REMATCH[2]/\// of }"
      if [[ -t 2 ]]; then printf '\rwakeline: compiled %s ' "$of" >&2; fi
      said=yes
    fi
  done
  if [[ -t 2 && -n $said ]]; then printf '\n' >&2; fi
}

if ! is_installed dev && ! is_installed "$extra"; then
  say "building and installing the Python package (extra: $extra), which may take ten minutes or more"
  rm -f "$(stamp_of dev)" "$(stamp_of plot)"
  # Without build isolation and with a build folder that stays, so that the next build compiles only what changed.
  "$python" -m pip install -q --disable-pip-version-check \
    "scikit-build-core>=0.10" "pybind11>=3.0" "pybind11-stubgen>=2.5" "numpy>=1.22"
  if ninja --version >/dev/null 2>&1; then generator=Ninja; else generator="Unix Makefiles"; fi
  log=$root/build/wheel.log
  SKBUILD_BUILD_DIR="$root/build/wheel/$generator" SKBUILD_CMAKE_DEFINE="WAKELINE_LANES=native" \
    CMAKE_GENERATOR=$generator CMAKE_BUILD_PARALLEL_LEVEL=$jobs \
    "$python" -m pip install -v --disable-pip-version-check --no-build-isolation "$root[$extra]" 2>&1 |
    tee "$log" | show_progress || { tail -n 40 "$log" >&2; fail "the package could not be built; all of it is in $log"; }
  printf '%s' "$fingerprint" >"$(stamp_of "$extra")"
fi
exec 9>&-
