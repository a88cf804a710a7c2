#!/usr/bin/env bash
# Other people's builds: the project in tests/consumer, configured, built and run against an installed tree.
#
#   tests/package/consumer_test.sh BUILD GENERATOR     GENERATOR: Ninja or "Unix Makefiles"
#
# Ends with 77 (skipped) when the generator's tool is absent.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/support.sh"
build=$1 generator=$2
case $generator in
  Ninja) tool="ninja" ;;
  *) tool="make" ;;
esac
command -v $tool >/dev/null || skip "$tool is not installed"

install_somewhere_else "$build" "$work/prefix"
cp -r "$root/tests/consumer" "$work/project"
cd "$work/project"
printf 'not a solid\n' >"$work/broken.stl"

# Builds, and holds what was done against the words given: block and wedge compiled, link, and what depends on the database: json, program.
built() {
  local said="" word
  cmake --build "$work/build" >"$work/log" 2>&1 || fail "$1: the build ends with an error"
  for word in block wedge; do
    grep -q "Compiling $word for parts" "$work/log" && said+="$word "
  done
  grep -q "Linking database parts" "$work/log" && said+="link "
  grep -q "parts.json made" "$work/log" && said+="json "
  grep -q "Linking CXX executable workcell" "$work/log" && said+="program "
  expect_same "$1" "$2" "${said% }"
}
database() { sha256sum <"$work/build/parts.fdb"; }
now() { sleep 0.02 && touch "$@"; } # file times tick in steps of some milliseconds

cmake -S . -B "$work/build" -G "$generator" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/log" 2>&1 ||
  fail "the project cannot be configured"
built "first build" "block wedge link json program"
expect_same "the program's objects" "block wedge 1 region, 0 objects" "$("$work/build/workcell" | paste -sd " ")"
expect_same "the file's objects" "block wedge 1 region, 0 objects" "$("$work/build/workcell" "$work/build/parts.fdb" | paste -sd " ")"
cmake -E rename "$work/build/parts.fdb" "$work/kept.fdb"
"$work/build/workcell" >/dev/null || fail "the program does not run without the file, which it has in itself"
cmake -E rename "$work/kept.fdb" "$work/build/parts.fdb"

built "second build" ""

now block.stl
built "touched CAD file" "block"

first=$(database)
sed -i 's/vertex \([0-9]*\) \([0-9]*\) 40/vertex \1 \2 44/' block.stl
built "changed CAD file" "block link json program"
[ "$(database)" != "$first" ] || fail "changed CAD file: the database is the same"

now coarse.textproto
built "touched sensor" "block wedge"
sed -i 's/largest_incidence_deg: 75/largest_incidence_deg: 70/' coarse.textproto
built "changed sensor" "block wedge link json program"

now "$work/prefix/bin/foresightc"
built "another foresightc" "block wedge link"

second=$(database)
cp block.stl "$work/good.stl"
cp "$work/broken.stl" block.stl
if cmake --build "$work/build" >"$work/log" 2>&1; then fail "broken CAD file: the build goes well"; fi
grep -q "^foresightc: .*/block.stl: .*; " "$work/log" || fail "broken CAD file: no message of the compiler"
[ "$(database)" = "$second" ] || fail "broken CAD file: the database is another"
cp "$work/good.stl" block.stl
built "mended CAD file" "block"
[ "$(database)" = "$second" ] || fail "mended CAD file: the database is another"

sed -i 's/--spacing 20/--spacing 22/' CMakeLists.txt
built "other options" "block wedge link json program"

rm "$work/build/parts.parts/wedge.fdb" "$work/build/parts.fdb"
built "deleted files" "wedge link json program"

sed -i 's/block.stl wedge.off/block.stl/' CMakeLists.txt
built "one model less" "link json program"
expect_same "objects of one model less" "block 1 region, 0 objects" "$("$work/build/workcell" | paste -sd " ")"
built "last build" ""

echo "consumer_test: $generator: all held"
