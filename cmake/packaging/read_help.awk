# Reads what `PROGRAM [COMMAND] --help` prints into lines of fields parted by tabs:
#   about  description
#   usage  usage line
#   kind (Positionals, Options, Subcommands)  names  value  choices, parted by blanks  range  default  yes where required  description
{ line[NR] = $0 }

function trimmed(text) {
  gsub(/^ +| +$/, "", text)
  return text
}

# "TEXT:{mm,cm}=mm", "INT:INT in [0 - 4096]=0", "FLOAT:0 to 10=0", "TEXT ... REQUIRED", "TEXT Needs: --depfile"
function print_entry(kind, left, text,    names, rest, value, choices, range, default_value, required) {
  names = left
  sub(/ .*/, "", names)
  rest = trimmed(substr(left, length(names) + 1))
  if (kind == "Subcommands") rest = ""
  sub(/ *(Needs|Excludes):.*/, "", rest)
  required = sub(/ *REQUIRED/, "", rest) ? "yes" : ""
  sub(/ *\.\.\./, "", rest)
  if (match(rest, /=[^={}]*$/)) {
    default_value = substr(rest, RSTART + 1)
    rest = substr(rest, 1, RSTART - 1)
  }
  value = rest
  sub(/:.*/, "", value)
  rest = substr(rest, length(value) + 2)
  if (rest ~ /^\{.*\}$/) {
    choices = substr(rest, 2, length(rest) - 2)
    gsub(/,/, " ", choices)
  } else if (rest != "") {
    range = rest
    sub(/^[A-Z]+ in \[/, "", range)
    sub(/\]$/, "", range)
    sub(/ - /, " to ", range)
    sub(/ to 2147483647$/, " or more", range)
  }
  print kind "\t" names "\t" value "\t" choices "\t" range "\t" default_value "\t" required "\t" text
}

END {
  indent = sprintf("%30s", "")
  for (i = 1; i <= NR; i++) {
    if (line[i] ~ /^Usage: /) print "usage\t" substr(line[i], 8)
    else if (line[i] ~ /^[A-Z][a-z]+:$/) kind = substr(line[i], 1, length(line[i]) - 1)
    else if (line[i] ~ /^  [^ ]/) {
      left = trimmed(substr(line[i], 1, 30))
      text = trimmed(substr(line[i], 31))
      if (i < NR && substr(line[i + 1], 1, 30) == indent) {  # too long for its column: the description follows
        left = trimmed(line[i])
        text = trimmed(line[++i])
      }
      print_entry(kind, left, text)
    } else if (line[i] != "" && kind == "") print "about\t" line[i]
  }
}
