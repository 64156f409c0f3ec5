# Sourced by scripts/demo and scripts/test, which have set -euo pipefail and stand in the root of the project.

name=$(basename "$0")

say() { printf '%s: %s\n' "$name" "$*"; }

# build PRESET TARGETS [CMAKE_OPTION…]: configures and builds; silent but for a progress line on a terminal and for errors.
build() {
  local preset=$1 targets=$2 started=$SECONDS quiet=--quiet
  local log=build/$preset-configure.log
  shift 2
  mkdir -p build
  if ! cmake --preset "$preset" "$@" >"$log" 2>&1; then
    cat "$log" >&2
    say "CMake could not configure build/$preset" >&2
    return 1
  fi
  [[ -t 1 ]] && quiet=
  # shellcheck disable=SC2086  # several targets, and no argument at all for the progress line
  cmake --build --preset "$preset" --parallel "$(nproc)" --target $targets -- $quiet
  if ((SECONDS > started + 5)); then say "built build/$preset in $((SECONDS - started)) s"; fi
}
