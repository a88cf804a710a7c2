#!/usr/bin/env bash
# An installed tree as build systems find it: pkg-config, cross builds, and what is said to those who use it wrongly.
#
#   tests/package/find_package_test.sh BUILD [CXX]     CXX: c++ when not given
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/support.sh"
cxx=${2:-c++}
prefix=$work/prefix
install_somewhere_else "$1" "$prefix"

# pkg-config, with and without --static: the library is an archive, which needs the same for both.
cat >"$work/load.cpp" <<'CPP'
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include <foresight/errors.h>
#include <foresight/foresight.h>

int main(int, char** argv) try {
  std::ifstream in(argv[1], std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const foresight::Recognizer recognizer(foresight::DatabaseBytes{bytes.data(), bytes.size()});
  std::cout << foresight::version() << " " << recognizer.object_names().front() << "\n";
} catch (const foresight::DatabaseError& error) {
  std::cout << error.what() << "\n";
  return error.exit_code();
}
CPP
if command -v pkg-config >/dev/null; then
  PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name foresight.pc)")
  export PKG_CONFIG_PATH
  version=$(pkg-config --modversion foresight)
  "$prefix/bin/foresightc" compile "$root/tests/consumer/wedge.off" --sensor "$root/tests/consumer/coarse.textproto" \
    --views 20 --spacing 20 -o "$work/wedge.fdb"
  for static in "" --static; do
    # shellcheck disable=SC2046,SC2086
    "$cxx" -std=c++17 -Wall -Wextra -Werror "$work/load.cpp" -o "$work/load" $(pkg-config $static --cflags --libs foresight) >"$work/log" 2>&1 ||
      fail "pkg-config $static: the program cannot be built"
    expect_same "pkg-config $static" "$version wedge" "$("$work/load" "$work/wedge.fdb")"
  done
  # From C: the libraries are the same, linked by the C++ compiler.
  printf '%s\n' '#include <foresight/foresight_c.h>' '#include <stdio.h>' 'int main(void) { puts(foresight_version()); return 0; }' >"$work/version.c"
  # shellcheck disable=SC2046
  { cc -std=c99 -Wall -Wextra -Wpedantic -Werror -c "$work/version.c" -o "$work/version.o" $(pkg-config --cflags foresight) &&
    "$cxx" "$work/version.o" -o "$work/version" $(pkg-config --libs foresight); } >"$work/log" 2>&1 || fail "C: the program cannot be built"
  expect_same "C" "$version" "$("$work/version")"
  printf 'OFF\n' >"$work/foreign.fdb"
  code=0
  said=$("$work/load" "$work/foreign.fdb") || code=$?
  expect_same "foreign database" 4 $code
  [[ $said == "(memory): "*"; "* ]] || fail "foreign database: \"$said\""
else
  echo "pkg-config is not installed: not tested"
fi

# A project for each wrong use in one build folder, the sensor and CAD file beside it.
mkdir "$work/project"
cp "$root"/tests/consumer/{wedge.off,coarse.textproto} "$work/project"
project() { # CMAKE LINES
  printf '%s\n' 'cmake_minimum_required(VERSION 3.20)' 'project(Wrong LANGUAGES CXX)' "$@" >"$work/project/CMakeLists.txt"
}
configure() { cmake -S "$work/project" -B "$work/build" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_PREFIX_PATH="$prefix" "$@" >"$work/log" 2>&1; }
refused() { # WHAT PATTERN ARGUMENTS
  if configure "${@:3}"; then fail "$1: configured all the same"; fi
  tr -s ' \n' ' ' <"$work/log" | grep -qE "$2" || fail "$1: nothing like \"$2\" is said"
}
find='find_package(Foresight REQUIRED)'
project "$find" 'foresight_add_database(NAME parts MODELS wedge.off a/wedge.stl)'
refused "two models of one name" "two MODELS of parts are named wedge"
project "$find" 'foresight_add_database(NAME parts)'
refused "no model" "give NAME and MODELS"
project "$find" 'foresight_add_database(NAME parts MODELS wedge.off SENSORS coarse.textproto SENSOR)'
refused "word without value" "without value: 'SENSOR'"
project "$find" 'foresight_add_database(NAME my-parts MODELS wedge.off EMBED)'
refused "no identifier" "must be a C identifier, not my-parts"
project 'find_package(Foresight 99 REQUIRED)'
refused "another version" "requested version .99"
project "$find" 'foresight_add_database(NAME parts MODELS wedge.off)'
refused "foresightc that does not run" "does not run on this machine" -DForesight_COMPILER="$work/wedge.fdb"
rm -rf "$work/build"

# A cross build: the tree's programs are for another machine and cannot run here.
host=$work/host
mkdir -p "$host"
mv "$prefix/bin/foresightc" "$host/foresightc-of-host"
printf '#!/bin/sh\nexit 126\n' >"$prefix/bin/foresightc"
chmod +x "$prefix/bin/foresightc"
printf '%s\n' 'set(CMAKE_SYSTEM_NAME Linux)' 'set(CMAKE_SYSTEM_PROCESSOR other)' >"$work/toolchain.cmake"
cross=(-DCMAKE_TOOLCHAIN_FILE="$work/toolchain.cmake")
project "$find" 'foresight_add_database(NAME parts MODELS wedge.off SENSOR coarse.textproto OPTIONS --views 20 --spacing 20)'
if PATH=/usr/bin:/bin command -v foresightc >/dev/null; then
  echo "foresightc is installed on this machine: a cross build that lacks it is not tested"
else
  PATH=/usr/bin:/bin refused "cross build without foresightc" "no foresightc for this machine.*-DForesight_COMPILER" "${cross[@]}"
fi
configure "${cross[@]}" -DForesight_COMPILER="$host/foresightc-of-host" || fail "cross build: not configured"
cmake --build "$work/build" >"$work/log" 2>&1 || fail "cross build: ends with an error"
"$host/foresightc-of-host" inspect "$work/build/parts.fdb" | grep -q wedge || fail "cross build: no database of the wedge"

# Without any foresightc the library is there all the same.
rm -r "$work/build" "$work/prefix/bin"
project "$find" 'add_executable(load load.cpp)' 'target_link_libraries(load PRIVATE Foresight::runtime)'
cp "$work/load.cpp" "$work/project"
configure || fail "library alone: not configured"
cmake --build "$work/build" >"$work/log" 2>&1 || fail "library alone: not built"
echo "find_package_test: all held"
