# shellcheck shell=bash
# What the tests of this folder share: a work folder that goes away, and words to say what went wrong.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C

fail() {
  echo "FAILED: $1" >&2
  [ ! -s "$work/log" ] || sed 's/^/  | /' "$work/log" >&2
  exit 1
}

skip() {
  echo "SKIPPED: $1"
  exit 77
}

expect_same() { # WHAT EXPECTED FOUND
  [ "$2" = "$3" ] || fail "$1: \"$3\" instead of \"$2\""
}

# Installs BUILD into a prefix, and moves it to FOLDER: nothing in it may know where it was.
install_somewhere_else() {
  cmake --install "$1" --prefix "$work/first-prefix" >"$work/log" 2>&1 || fail "cmake --install ends with an error"
  mv "$work/first-prefix" "$2"
  if grep -rlF "$work/first-prefix" "$2" || grep -rlIF "$root/" "$2"; then fail "the files above know where they were built or installed"; fi
}
