# shellcheck shell=bash
# shellcheck disable=SC2016,SC2034,SC2154,SC2164
# CAD files for the tests of this folder, and what holds of their parts. Few views: how things work together is tested.

source "$(dirname "${BASH_SOURCE[0]}")/../package/support.sh"
farm=$root/scripts/farm
settings=(--views 20 --spacing 20 --sensor "coarse sensor.textproto")

make_cads() { # N: as many wedges of different widths, in $work, and a list of them
  local i
  for i in $(seq "$1"); do sed "s/^90 /$((80 + i)) /" "$root/tests/consumer/wedge.off" >"$work/wedge $i.off"; done
  cp "$root/tests/consumer/coarse.textproto" "$work/coarse sensor.textproto"
  cd "$work"
  seq -f "wedge %g.off" "$1" >list
}

compile_all() { # DATABASE LIST: by one process
  local cads
  mapfile -t cads <"$2"
  "$FORESIGHTC" compile "${cads[@]}" -o "$1" --progress none "${settings[@]}" 2>"$work/log" || fail "compile of all ends with an error"
}

# None before there is a folder.
done_parts() { find "$1" -name '*.done' 2>/dev/null | wc -l; }

wait_until() { # WHAT CONDITION: up to a minute
  local i
  for i in $(seq 600); do
    if eval "$2"; then return 0; fi
    sleep 0.1
  done
  fail "not within a minute: $1"
}

same_database() { # WHAT EXPECTED FOUND
  cmp -s "$2" "$3" || fail "$1: not the bytes of one compile of all"
}
