#!/usr/bin/env bash
# The Debian packages: same bytes twice, nothing for lintian to call an error, and programs that run where dpkg has put them.
#
#   tests/package/debian_test.sh BUILD
#
# Ends with 77 (skipped) when dpkg-dev or lintian is absent; what needs no lintian is tested all the same.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/support.sh"
for tool in dpkg-deb dpkg-shlibdeps; do
  command -v $tool >/dev/null || skip "$tool (dpkg, dpkg-dev) is not installed"
done

pack() { # FOLDER UMASK TIMEZONE
  (umask "$2" && TZ=$3 cpack --config "$build/CPackConfig.cmake" -B "$work/$1") >"$work/log" 2>&1 || fail "cpack ends with an error"
}
build=$1
unset SOURCE_DATE_EPOCH
pack one 022 UTC
sleep 1
pack two 077 Asia/Tokyo
packages=("$work"/one/*.deb)
expect_same "packages" "foresight-compiler foresight-runtime libforesight-dev" "$(basename -a "${packages[@]}" | sed 's/_.*//' | paste -sd ' ')"
for package in "${packages[@]}"; do
  cmp "$package" "$work/two/${package##*/}" || fail "${package##*/}: other bytes the second time"
  if dpkg-deb -c "$package" | grep -v ' root/root '; then fail "${package##*/}: files of another owner"; fi
done
expect_same "times in a package" 1 "$(dpkg-deb -c "${packages[0]}" | awk '{ print $4, $5 }' | sort -u | wc -l)"
if dpkg-deb -f "$work"/one/foresight-runtime_*.deb Depends | grep -E "embree|openmesh|tbb|ssl"; then
  fail "foresight-runtime depends on what only the compiler may"
fi

if command -v lintian >/dev/null; then
  lintian --fail-on error "${packages[@]}" >"$work/log" 2>&1 || fail "lintian finds errors"
fi

# An empty root. Without what the packages depend on: the programs run with the libraries of this machine.
place=$work/root
mkdir -p "$place"/var/lib/dpkg/{info,updates}
touch "$place/var/lib/dpkg/status"
export PATH=$PATH:/usr/sbin:/sbin
dpkg_there() {
  local as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(fakeroot --)
  "${as_root[@]}" dpkg --root="$place" --force-not-root,depends --log="$work/dpkg.log" "$@" >"$work/log" 2>&1
}
if [ "$(id -u)" -eq 0 ] || command -v fakeroot >/dev/null; then
  dpkg_there -i "${packages[@]}" || fail "dpkg cannot install the packages"
  dpkg_there -V || fail "dpkg finds other files than it installed"
else
  for package in "${packages[@]}"; do dpkg-deb -x "$package" "$place"; done
  echo "neither root nor fakeroot: unpacked instead of installed"
fi

bin=$place/usr/bin
share=$place/usr/share
for file in "$share"/man/man1/foresight{,c}.1.gz "$share"/bash-completion/completions/foresight{,c} "$share"/doc/{foresight-{runtime,compiler},libforesight-dev}/{copyright,changelog.gz}; do
  [ -s "$file" ] || fail "${file#"$place"} is not there"
done
cd "$work"
"$bin/foresightc" compile "$root/tests/consumer/wedge.off" --sensor "$share/foresight/models/sensors/paper.textproto" --views 20 --spacing 20 -o wedge.fdb
"$bin/foresightc" simulate "$root/tests/consumer/wedge.off" --sensor "$share/foresight/models/sensors/paper.textproto" --scenes 1 --seed 1 -o scans
"$bin/foresight" recognize wedge.fdb scans/*.pcd >"$work/log" || fail "foresight recognizes no wedge"
grep -q wedge "$work/log" || fail "foresight names no wedge"
if command -v pkg-config >/dev/null; then
  flags=$(PKG_CONFIG_PATH=$(dirname "$(find "$place" -name foresight.pc)") pkg-config --cflags --libs foresight)
  [[ $flags == *"$place/usr/"* ]] || fail "pkg-config knows another place: $flags"
fi

if [ -s "$place/var/lib/dpkg/status" ]; then
  dpkg_there -P foresight-compiler foresight-runtime libforesight-dev || fail "dpkg cannot remove the packages"
  left=$(find "$place" -path "$place/var" -prune -o -type f -print)
  expect_same "what is left behind" "" "$left"
fi
command -v lintian >/dev/null || skip "lintian is not installed, so that it was not asked; all else held"
echo "debian_test: all held"
