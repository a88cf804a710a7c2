# Fields of read_help.awk to the roff of a man page's command, or of an option each.
BEGIN { FS = "\t" }

function roff(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  sub(/^[.']/, "\\\\\\&&", text)
  return text
}

function sentence(text) { return text == "" ? "" : text (text ~ /\.$/ ? "" : ".") }

$1 == "about" { about = $2 }
$1 == "usage" { print ".SS " command "\n" sentence(roff(about)) "\n.PP\n.B " roff($2) }
$1 == "Positionals" || $1 == "Options" {
  names = $2
  gsub(/,/, ", ", names)
  text = sentence($8)
  if ($4 != "") {
    choices = $4
    gsub(/ /, ", ", choices)
    text = text " One of " choices "."
  }
  if ($5 != "") text = text " " toupper(substr($5, 1, 1)) substr($5, 2) "."
  if ($6 != "") text = text " Default: " $6 "."
  if ($1 == "Options" && $7 != "") text = text " Must be given."
  print ".TP\n\\fB" roff(names) "\\fR" ($1 == "Options" && $3 != "" ? " \\fI" $3 "\\fR" : "") "\n" roff(text)
}
