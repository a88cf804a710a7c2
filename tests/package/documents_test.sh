#!/usr/bin/env bash
# Man pages and completions tell of every option the programs have, and of none they lack.
#
#   tests/package/documents_test.sh BUILD
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/support.sh"
build=$1
packaging=$root/cmake/packaging

"$packaging/regenerate" "$build" "$work/made" >"$work/log" 2>&1 || fail "regenerate ends with an error"
for file in man/foresight.1 man/foresightc.1 completions/foresight completions/foresightc; do
  cmp -s "$packaging/$file" "$work/made/$file" ||
    fail "cmake/packaging/$file is not what --help says today; run cmake/packaging/regenerate and commit it"
done

completed() { # LINE: what is offered for its last word
  local program=${1%% *}
  # shellcheck disable=SC2206
  COMP_WORDS=(${1//=/ = })
  [[ $1 != *" " ]] || COMP_WORDS+=("")
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  COMPREPLY=()
  "_$program"
  echo "${COMPREPLY[*]-}"
}
options_of() { # PROGRAM [COMMAND]: read in another way than regenerate does
  "$@" --help | grep -oE '^  (-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+'
}

for name in foresightc foresight; do
  program=$(find "$build/compiler" "$build/runtime" -maxdepth 1 -name $name -type f)
  # shellcheck source=/dev/null
  source "$packaging/completions/$name"
  [ "$(complete -p $name)" = "complete -o default -F _$name $name" ] || fail "$name: no completion"
  commands=$("$program" --help | sed '1,/^Subcommands:/d' | awk '{ print $1 }')
  [ "$(wc -w <<<"$commands")" -ge 3 ] || fail "$name: its commands are not found: $commands"
  for command in $commands; do
    [[ " $(completed "$name ") " == *" $command "* ]] || fail "$name: $command is not offered"
    awk -v section=".SS $command" '$0 == section { on = 1; next } /^\.S[SH]/ { on = 0 } on' \
      "$packaging/man/$name.1" | sed 's/\\-/-/g' >"$work/section"
    options=$(options_of "$program" "$command")
    [ "$(wc -w <<<"$options")" -ge 2 ] || fail "$name $command: its options are not found: $options"
    for option in $options; do
      grep -qE -- "^\\\\fB(-[a-z], )?$option\\\\fR" "$work/section" || fail "$name $command: the man page lacks $option"
      [[ " $(completed "$name $command --") " == *" $option "* ]] || fail "$name $command: $option is not offered"
    done
    expect_same "$name $command: options in the man page" "$(wc -w <<<"$options")" "$(grep -cE '^\\fB(-[a-z], )?--' "$work/section")"
    expect_same "$name $command: options offered" "$(wc -w <<<"$options")" "$(completed "$name $command --" | wc -w)"
  done
  if command -v groff >/dev/null; then
    said=$(groff -man -ww -z "$packaging/man/$name.1" 2>&1)
    expect_same "$name.1: what groff says" "" "$said"
  fi
done

expect_same "commands" "compile" "$(completed "foresightc com")"
expect_same "values" "mm m" "$(completed "foresight recognize a.fdb --scan-unit ")"
expect_same "values begun" "cm" "$(completed "foresightc compile --unit c")"
expect_same "values after =" "cm" "$(completed "foresightc compile a.off --unit=c")"
expect_same "all values after =" "mm cm m in" "$(completed "foresightc compile a.off --unit=")"
expect_same "files are left to the shell" "" "$(completed "foresight recognize ")"
expect_same "option begun" "--deadline-ms" "$(completed "foresight recognize a.fdb b.pcd --dead")"
echo "documents_test: all held"
