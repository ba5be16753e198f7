# Shared by the shell scripts, which source it. It enters the project's folder.
cd "$(dirname "${BASH_SOURCE[0]}")/.."
script="scripts/$(basename "$0")"

# Prints the comment at the head of the script.
usage() { sed -n '2,/^set -/{/^#/s/^# \{0,1\}//p}' "$script"; }

# fail MESSAGE [STATUS]
fail() {
  echo "$script: $1" >&2
  exit "${2:-1}"
}

refuse_argument() { fail "unknown argument '$1'; see $script --help" 2; }

# require_number OPTION VALUE: refuses a value that is not a whole number above 0.
require_number() {
  if ! [[ "$2" =~ ^[1-9][0-9]*$ ]]; then fail "$1 needs a whole number above 0" 2; fi
}

# Prints the heading of a step, in bold on a terminal.
step() { if [ -t 1 ]; then printf '\n\033[1m%s\033[0m\n' "$1"; else printf '\n%s\n' "$1"; fi; }

# build_tool TARGET: installs packages and builds one program of the tests. Its output is left to the program.
build_tool() {
  scripts/setup build tools >&2
  cmake --preset release -DBUOYANCY_BUILD_TESTS=ON >/dev/null
  cmake --build --preset release --parallel "$(scripts/build_jobs)" --target "$1" >/dev/null
}
