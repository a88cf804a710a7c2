#!/usr/bin/env bash
# Runs the commands that the READMEs show in ```sh blocks, as a reader would: from the project's root, in order, with the
# programs on the PATH, but in a scratch copy. Stops at the first command that fails.
#
#   tests/programs/readme_commands.sh [BUILD]     BUILD: a build folder, build/release when not given
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "${1:-$root/build/release}" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

tar -C "$root" --exclude=./.git --exclude=./build --exclude='./build-*' --exclude=./demo-output -cf - . | tar -C "$scratch" -xf -
cd "$scratch"
mkdir build && ln -s "$build" build/release # where a reader has it
export PATH=$build/compiler:$build/runtime:$build/benchmarks:$PATH

blocks=0
for readme in README.md */README.md; do
  awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' "$readme" >"$scratch/.commands"
  [ -s "$scratch/.commands" ] || continue
  blocks=$((blocks + 1))
  echo "== $readme"
  bash -euxo pipefail "$scratch/.commands" </dev/null || {
    echo "readme_commands: the last command above, from $readme, ends with $?" >&2
    exit 1
  }
done
[ "$blocks" -gt 0 ] || {
  echo "readme_commands: no README shows an sh block" >&2
  exit 1
}
