#!/usr/bin/env bash
# The committed meshes are closed solids and are what their sources give today.
#
#   tests/models/regenerate_test.sh
#
# Ends with 77 (skipped) when OpenSCAD is absent; what needs no OpenSCAD is tested all the same.
# OPENSCAD names another openscad program, as for models/regenerate.
set -euo pipefail
export LC_ALL=C

models=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../models" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

wrong() {
  echo "FAILED: $1" >&2
  failures=$((failures + 1))
}

# Vertex and triangle count, volume and area of a mesh; fails when an edge does not join exactly two triangles
# in opposite directions, or when the inside is out. Needs the form models/regenerate writes.
measures() {
  awk '
    NR == 1 && $0 != "OFF" { print "no plain OFF header"; bad = 1; exit }
    NR == 1 { next }
    NR == 2 { vertices = $1; triangles = $2; next }
    NR <= 2 + vertices {
      if (NF != 3 || /[eE]/) { print "bad vertex: " $0; bad = 1; exit }
      x[NR - 3] = $1; y[NR - 3] = $2; z[NR - 3] = $3
      next
    }
    {
      if (NF != 4 || $1 != 3) { print "bad triangle: " $0; bad = 1; exit }
      a = $2; b = $3; c = $4; found++
      edges[a "," b]++; edges[b "," c]++; edges[c "," a]++
      ux = x[b] - x[a]; uy = y[b] - y[a]; uz = z[b] - z[a]
      vx = x[c] - x[a]; vy = y[c] - y[a]; vz = z[c] - z[a]
      nx = uy * vz - uz * vy; ny = uz * vx - ux * vz; nz = ux * vy - uy * vx
      area += sqrt(nx * nx + ny * ny + nz * nz) / 2
      volume += (x[a] * nx + y[a] * ny + z[a] * nz) / 6
    }
    END {
      if (bad) exit 1
      if (found != triangles) { print found + 0 " triangles, the header says " triangles; exit 1 }
      for (edge in edges) {
        split(edge, end, ",")
        if (edges[edge] != 1 || edges[end[2] "," end[1]] != 1) { print "open or not manifold at edge " edge; exit 1 }
      }
      if (volume <= 0) { print "inside out"; exit 1 }
      printf "%d %d %.6f %.6f\n", vertices, triangles, volume, area
    }
  ' "$1"
}

# Whether two meshes are one solid, however its faces were cut into triangles: same vertices to 0.001 mm,
# same number of triangles, same volume and area to one part in a million.
same_solid() {
  [ "$(sed -n 2p "$1")" = "$(sed -n 2p "$2")" ] || return 1
  awk '
    FNR <= 2 { if (FNR == 2) vertices = $1; next }
    FNR > 2 + vertices { next }
    FNR == NR { x[FNR] = $1; y[FNR] = $2; z[FNR] = $3; next }
    {
      for (i in x) if ((x[i] - $1) ^ 2 + (y[i] - $2) ^ 2 + (z[i] - $3) ^ 2 < 1e-6) { delete x[i]; matched++; break }
    }
    END { exit matched != vertices }
  ' "$1" "$2" || return 1
  echo "$(measures "$1") $(measures "$2")" |
    awk '{ exit !($1 == $5 && $2 == $6 && ($3 / $7 - 1) ^ 2 < 1e-12 && ($4 / $8 - 1) ^ 2 < 1e-12) }'
}

# Every mesh has a source, every source a mesh (prism.scad only helps the others).
for mesh in "$models"/*.off; do
  [ -f "${mesh%.off}.scad" ] || wrong "${mesh##*/}: no source"
done
for source in "$models"/*.scad; do
  [ "${source##*/}" = prism.scad ] || [ -f "${source%.scad}.off" ] || wrong "${source##*/}: no mesh"
done

for mesh in "$models"/*.off; do
  said=$(measures "$mesh") || wrong "${mesh##*/}: $said"
done

# What regenerate cannot do it says, and what would mend it.
if said=$(OPENSCAD=$work/absent "$models/regenerate" "$work" 2>&1); then
  wrong "regenerate without OpenSCAD ends with 0"
elif [[ $said != *"not found; install OpenSCAD"* ]]; then
  wrong "regenerate without OpenSCAD says: $said"
fi

if ! command -v "${OPENSCAD:-openscad}" >/dev/null; then
  [ "$failures" -eq 0 ] || exit 1
  echo "SKIPPED: OpenSCAD is not installed, so the meshes were not made again from their sources"
  exit 77
fi

if said=$("$models/regenerate" "$work/absent" 2>&1); then
  wrong "regenerate into a folder that does not exist ends with 0"
elif [[ $said != *"no such folder"* ]]; then
  wrong "regenerate into a folder that does not exist says: $said"
fi

mkdir "$work/made"
"$models/regenerate" "$work/made" || {
  wrong "regenerate ends with $?"
  exit 1
}
for mesh in "$models"/*.off; do
  name=${mesh##*/}
  if [ ! -f "$work/made/$name" ]; then
    wrong "$name: regenerate does not make it"
  elif cmp -s "$mesh" "$work/made/$name"; then
    echo "$name: same bytes"
  elif same_solid "$mesh" "$work/made/$name"; then
    echo "$name: same solid, other triangles"
  else
    wrong "$name: not what its source gives; run models/regenerate and commit the mesh"
  fi
done

[ "$failures" -eq 0 ]
