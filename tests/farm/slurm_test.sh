#!/usr/bin/env bash
# Many parts with Slurm, on one node that the test starts: job array and link, bad parts, cancelled and started again.
#
#   tests/farm/slurm_test.sh BUILD FORESIGHTC
#
# Ends with 77 (skipped) without Slurm.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/parts.sh"
source "$(dirname "${BASH_SOURCE[0]}")/slurm.sh"
FORESIGHTC=$(realpath "$2")
export FORESIGHTC
start_slurm

count=6
make_cads $count
compile_all all.fdb list
compile() { # CODE ARGUMENT...
  local code=0
  "$farm/compile_with_slurm" "${@:2}" -o parts.fdb -- "${settings[@]}" >log 2>&1 || code=$?
  expect_same "exit code of $*" "$1" "$code"
}
told() { sed -n 's/^compile: job \([0-9]*\), parts: \([0-9]*\)$/\'"$1/p" log; }

# Cancelled on the way: the link does not come.
compile 0 list --batch 1
wait_until "a part" '[ "$(done_parts parts.parts)" -ge 1 ]'
scancel "$(told 1)"
wait_until "no jobs" '[ -z "$(squeue -h)" ]'
left=$((count - $(done_parts parts.parts)))
[ "$left" -ge 1 ] || fail "the run was over before it was cancelled"
[ ! -e parts.fdb ] || fail "cancelled: there is a database"

# Started again, with a part gone bad: the others are done, and still no link.
cp "wedge 1.off" good.off
echo "no solid" >"wedge 1.off"
rm -f "parts.parts/wedge 1.fdb.done" "parts.parts/wedge 2.fdb.done"
left=$((count - $(done_parts parts.parts)))
compile 3 list --batch 2 --wait
expect_same "cancelled: parts to do" "$left" "$(told 2)"
expect_same "tasks" $(((left + 1) / 2)) "$(find parts.parts/log -name "$(told 1)_*.txt" | wc -l)"
expect_same "bad part" "compile_with_slurm: $work/wedge 1.off: is not compiled; see $work/parts.parts/log" "$(tail -n 1 log)"
grep -q "^foresightc: .*/wedge 1.off: .*; " "parts.parts/log/$(told 1)_0.txt" || fail "bad part: not the compiler's message in the log"
expect_same "parts beside a bad one" $((count - 1)) "$(done_parts parts.parts)"
[ ! -e parts.fdb ] || fail "bad part: there is a database"
expect_same "jobs left" "" "$(squeue -h)"

# Mended: that one only.
cp good.off "wedge 1.off"
compile 0 list --wait
expect_same "mended: parts to do" 1 "$(told 2)"
same_database "mended" all.fdb parts.fdb
echo "slurm_test: all held"
