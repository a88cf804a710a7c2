#!/usr/bin/env bash
# Many parts with GNU parallel: killed and started again, bad parts, changed files, other hosts.
#
#   tests/farm/parallel_test.sh BUILD FORESIGHTC
#
# Ends with 77 (skipped) without GNU parallel.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/parts.sh"
FORESIGHTC=$(realpath "$2")
parallel --version 2>/dev/null | grep -q "^GNU parallel" || skip "GNU parallel is not installed (Debian: parallel)"

# As installed: the scripts find their foresightc.
cmake --install "$1" --prefix "$work/prefix" --component compiler >"$work/log" 2>&1 || fail "cmake --install ends with an error"
farm=$work/prefix/share/foresight/farm

count=8
make_cads $count
compile_all all.fdb list
compile() { # CODE ARGUMENT...: with 2 processes
  local code=0
  "$farm/compile_with_parallel" "${@:2}" -o parts.fdb -j 2 -- "${settings[@]}" >log 2>&1 || code=$?
  expect_same "exit code of $*" "$1" "$code"
}
compiled() { expect_same "$1: parts compiled" "$2" "$(($(wc -l <parts.parts/joblog.txt) - 1))"; } # the first line is a heading

# Killed on the way, with all it started: a process group of its own.
setsid "$farm/compile_with_parallel" list -o parts.fdb -j 2 -- "${settings[@]}" >log 2>&1 &
driver=$!
wait_until "some parts" '[ "$(done_parts parts.parts)" -ge 2 ]'
kill -KILL -- -$driver
wait $driver 2>/dev/null || :
left=$((count - $(done_parts parts.parts)))
[ "$left" -ge 1 ] || fail "the run was over before the kill"
[ ! -e parts.fdb ] || fail "there is a database of some parts"
compile 0 list
# A compiler that the kill did not reach, for GNU parallel gives each job a process group, may have ended its part since.
again=$(($(wc -l <parts.parts/joblog.txt) - 1))
[ "$again" -le "$left" ] || fail "after the kill: $again parts compiled where $left were left"
same_database "after the kill" all.fdb parts.fdb

stat -c %y parts.fdb >before
compile 0 list
compiled "nothing to do" 0
expect_same "nothing to do: time of the database" "$(cat before)" "$(stat -c %y parts.fdb)"

# A bad part and a missing one: the others are compiled, the database stays.
cp parts.fdb kept.fdb
cp "wedge 2.off" good.off
echo "no solid" >"wedge 2.off"
sed 's/^90 /70 /' "$root/tests/consumer/wedge.off" >new.off
{ cat list && echo new.off && echo lost.off; } >longer
compile 3 longer
compiled "bad part" 3
grep -q "^foresightc: .*/wedge 2.off: .*; " log || fail "bad part: not the compiler's message"
expect_same "bad parts" "link_parts: $work/wedge 2.off: link_parts: $work/lost.off:" \
  "$(grep -o '^link_parts: /.*\.off:' log | paste -sd ' ')"
[ -f parts.parts/new.fdb.done ] || fail "bad part: the others are not compiled"
cmp -s kept.fdb parts.fdb || fail "bad part: the database is another"
compile 3 longer --link-anyway
grep -v -e "wedge 2" -e lost longer >fewer
compile_all fewer.fdb fewer
same_database "what could be compiled" fewer.fdb parts.fdb

# A part cut short, as by a copy that broke off; the CAD file mended; a part less: all as if nothing had been.
cp good.off "wedge 2.off"
truncate -s 100 "parts.parts/wedge 3.fdb"
compile 0 - <list
compiled "mended" 2
same_database "mended" all.fdb parts.fdb

# The sensor decides about all; two will do. On another host: "ssh", which hands the command to a shell
# over there, and as sshd does tells it which.
sed -i 's/largest_incidence_deg: 75/largest_incidence_deg: 70/' "coarse sensor.textproto"
head -n 2 list >two
printf '#!/bin/sh\necho "$1" >>"%s"\nshift\n[ "$1" != -- ] || shift\ncd /\nexport SHELL=/bin/sh\nexec sh -c "$*"\n' "$work/contacted" >ssh
chmod +x ssh
echo "2/$work/ssh elsewhere" >hosts
compile 0 two --hosts hosts
compiled "another sensor" 2
grep -q elsewhere contacted || fail "the other host was not asked"
compile_all two.fdb two
same_database "another sensor, another host" two.fdb parts.fdb

# Wrong use.
mkdir sub
cp "wedge 1.off" sub
echo "sub/wedge 1.off" >>two
compile 2 two
grep -q "more than one CAD file is named wedge 1;" log || fail "two parts of one name: not said"
compile 2 none
compile 2 /dev/null
compile 2 list --jobs 3
FORESIGHTC=nothing compile 2 list
echo "parallel_test: all held"
