# How far apart two outputs of `foresight recognize --format json` for the same scans are:
#   awk -v mm=0.01 -v degrees=0.01 -v score=0.001 -f compare_results.awk ONE TWO
# Prints the largest differences; ends with 1 when they pass the limits given, or the objects are not the same.
function read_detections(line, to, pieces, i, n, count, numbers, text) {
  n = split(line, pieces, /\{"object":"/)
  count = 0
  for (i = 2; i <= n; i++) {
    if (!match(pieces[i], /","pose":/)) continue
    if (index(substr(pieces[i], 1, RSTART - 1), "\"")) continue  # an alternative, whose score comes first
    to[++count, "object"] = substr(pieces[i], 1, RSTART - 1)
    text = substr(pieces[i], RSTART + RLENGTH)
    sub(/,"alpha".*/, "", text)
    gsub(/"score":/, "", text)
    gsub(/[][,]+/, " ", text)
    if (split(text, numbers, " ") != 17) exit broken = 1
    for (j = 1; j <= 17; j++) to[count, j] = numbers[j]
  }
  return count
}
function largest(what, value, where) {
  if (value > most[what]) {
    most[what] = value
    at[what] = where
  }
}
function square(x) { return x * x }
function compare(k, where, i, j, turn) {
  if (one[k, "object"] != two[k, "object"]) others++
  for (i = 0; i < 3; i++) for (j = 1; j <= 3; j++) turn += square(one[k, 4 * i + j] - two[k, 4 * i + j])
  turn = sqrt(turn / 8)
  largest("degrees", 2 * atan2(turn, sqrt(turn < 1 ? 1 - turn * turn : 0)) * 57.29577951308232, where)
  largest("mm", sqrt(square(one[k, 4] - two[k, 4]) + square(one[k, 8] - two[k, 8]) + square(one[k, 12] - two[k, 12])), where)
  largest("score", square(one[k, 17] - two[k, 17]) ^ 0.5, where)
}
{
  scans++
  if ((getline line < ARGV[ARGC - 1]) <= 0) exit broken = 1
  a = read_detections($0, one)
  b = read_detections(line, two)
  detections += a
  if (a != b) others++
  else for (k = 1; k <= a; k++) compare(k, substr($0, 1, index($0, ",") - 1))
  sub(/,"milliseconds".*/, "")
  sub(/,"milliseconds".*/, "", line)
  same_bytes += $0 == line
  sub(/.*"statistics"/, "")
  sub(/.*"statistics"/, "", line)
  same_statistics += $0 == line
  if (scans == total) exit
}
BEGIN {
  while ((getline line < ARGV[1]) > 0) total++
  close(ARGV[1])
  while ((getline line < ARGV[2]) > 0) lines++
  close(ARGV[2])
  if (total == 0 || total != lines) exit broken = 1
}
END {
  if (broken) {
    print "compare_results: no two results for the same scans"
    exit 1
  }
  printf "%d scans, %d detections; scans with other objects: %d, other counts of work: %d, other bytes: %d\n", \
    scans, detections, others, scans - same_statistics, scans - same_bytes
  printf "largest differences: %.3g mm, %.3g degrees, %.3g of the score\n", most["mm"], most["degrees"], most["score"]
  exit others > 0 || detections == 0 || most["mm"] > mm || most["degrees"] > degrees || most["score"] > score
}
