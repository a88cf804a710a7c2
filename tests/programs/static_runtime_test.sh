#!/usr/bin/env bash
# The runtime without shared libraries: loads none, is small, and prints what the other one prints.
#
#   tests/programs/static_runtime_test.sh FORESIGHTC FORESIGHT [STATIC]
#
# Ends with 77 (skipped) when there is no STATIC, which is built where the static libraries are.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/../package/support.sh"
[ -n "${3-}" ] || skip "no static foresight is built here: sanitizers, or static libraries are missing (Debian: libprotobuf-dev libpng-dev zlib1g-dev liblz4-dev liblzf-dev)"
compiler=$(realpath "$1") shared=$(realpath "$2")
strip -o "$work/foresight" "$3"
cd "$work"

! readelf -lW foresight | grep -E "INTERP|DYNAMIC" || fail "the static program loads libraries"
readelf -lW "$shared" | grep -q INTERP || fail "the shared program loads none, so it says nothing"
size=$(stat -c %s foresight)
echo "stripped: $size bytes"
[ "$size" -le $((4 * 1024 * 1024)) ] || fail "the static program has $size bytes, more than 4 MiB"

cads=("$root/tests/consumer/block.stl" "$root/tests/consumer/wedge.off")
"$compiler" compile "${cads[@]}" -o parts.fdb --views 20 --spacing 20 --progress none
for format in pcd png; do
  "$compiler" simulate "${cads[@]}" -o $format --format $format --scenes 2 --objects 1 --seed 3 --progress none
done
# liblzf: the first scan in packed form, all of it literals.
# shellcheck disable=SC2016
perl -0777 -ne '/^(.*?)DATA binary\n(.*)$/s or die; my ($head, @points) = ($1, unpack("(a12)*", $2));
  my $columns = join "", map { my $at = 4 * $_; map { substr $_, $at, 4 } @points } 0 .. 2;
  my $packed = join "", map { chr(length($_) - 1) . $_ } unpack("(a32)*", $columns);
  print $head, "DATA binary_compressed\n", pack("VV", length $packed, length $columns), $packed' pcd/scan_0000.pcd >pcd/scan_0002.pcd

for format in pcd png; do
  camera=()
  [ $format = pcd ] || camera=(--camera png/camera.json)
  for kind in shared static; do
    program=$shared
    [ $kind = shared ] || program=./foresight
    "$program" recognize parts.fdb $format/scan_*.$format "${camera[@]}" --format json --progress none >said || fail "$kind: $format: nothing recognized"
    sed 's/,"milliseconds".*//' said >$format.$kind
  done
  cmp $format.shared $format.static || fail "$format: the static program prints something else"
done
expect_same "packed scan" "$(sed -n '1s/scan_0000/scan_0002/p' pcd.shared)" "$(sed -n 3p pcd.static)"
echo "static_runtime_test: all held"
