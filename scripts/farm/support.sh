# shellcheck shell=bash
# shellcheck disable=SC2015,SC2034,SC2154
# What the scripts of this folder share. They work on a folder of parts:
#
#   cad.txt       CAD files, one a line, with full paths; parts and objects are named after them
#   options.txt   options of each `foresightc compile`, one word a line
#   NAME.fdb      a part, made by one process of its own
#   NAME.fdb.done three digests: of what decides about all parts (foresightc, options, sensor file), of the CAD file, of the part
#
# A part is done when the three digests are those of today. Times do not say it: foresightc leaves alone a part that comes out
# as it was, and hosts' clocks differ. So whatever was killed, copied or changed, what is left to do can be told; and as
# foresightc puts whole files in place only, a part that was killed on the way is just not done.

me=$(basename "$0")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export LC_ALL=C

refuse() { # CAUSE: wrong use
  echo "$me: $1" >&2
  exit 2
}

# FORESIGHTC, or the one installed with this folder, or the one on the PATH.
find_foresightc() {
  local named=${FORESIGHTC-}
  if [ -z "$named" ] && [[ $here == */share/foresight/farm ]] && [ -x "$here/../../../bin/foresightc" ]; then
    named=$here/../../../bin/foresightc
  fi
  foresightc=$(command -v "${named:-foresightc}") ||
    refuse "${named:-foresightc}: there is no such program; install it, or name it: FORESIGHTC=PROGRAM $me ..."
  foresightc=$(realpath "$foresightc")
}

# LIST -o DB [--parts FOLDER] [--link-anyway] [WORD VALUE of values]... [-- OPTION...]
read_arguments() { # "WORD..." ARGUMENT...: words with a value, which become variables, and what the user said
  local values=" -o --parts $1 " word
  shift
  o="" parts="" list="" link=(link_parts) options=()
  while [ $# -gt 0 ]; do
    word=${1#-} word=${word#-}
    case $1 in
      --) shift && options=("$@") && break ;;
      -h | --help) sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "$0" && exit 0 ;;
      --link-anyway) link+=(--anyway) && shift ;;
      --wait) wait=yes && shift ;;
      -?*)
        [[ $values == *" $1 "* ]] || refuse "$1: unknown option; see $me --help"
        [ $# -ge 2 ] || refuse "$1: without a value; see $me --help"
        declare -g "$word=$2" && shift 2
        ;;
      *)
        [ -z "$list" ] || refuse "$1: a second list; CAD files are named in one file, one a line"
        list=$1 && shift
        ;;
    esac
  done
  [ -n "$list" ] && [ -n "$o" ] || refuse "give a list of CAD files, and -o DATABASE; see $me --help"
  database=$(realpath -m -- "$o")
  folder=$(realpath -m -- "${parts:-${o%.fdb}.parts}")
}

# Fills the folder of parts from list and options.
make_folder() {
  local twins
  [ "$list" = - ] || [ -r "$list" ] || refuse "$list: cannot be read; give a file that names CAD files, one a line, or - for the input"
  mkdir -p "$folder" || refuse "$folder: cannot be made; name another folder with --parts"
  cat -- "$list" | { grep -v '^$' || :; } | tr '\n' '\0' | xargs -0r realpath -ms -- >"$folder/cad.txt.new"
  [ -s "$folder/cad.txt.new" ] || refuse "$list: names no CAD file"
  twins=$(sed 's:.*/::; s:\(.\)\.[^.]*$:\1:' "$folder/cad.txt.new" | sort | uniq -d | paste -sd ' ')
  [ -z "$twins" ] || refuse "$list: more than one CAD file is named $twins; objects are named after their files, which must differ"
  mv "$folder/cad.txt.new" "$folder/cad.txt"
  : >"$folder/options.txt"
  [ ${#options[@]} -eq 0 ] || printf '%s\n' "${options[@]}" >"$folder/options.txt"
}

digests() { # FILE...: the digest of each, in order
  [ $# -eq 0 ] || printf '%s\0' "$@" | xargs -0 sha256sum -z -- | tr '\0' '\n' | cut -c 1-64
}

# The folder's lists, and the digest of what decides about all parts.
read_folder() { # FOLDER
  local i sensor=()
  folder=$1
  [ -r "$folder/cad.txt" ] && [ -r "$folder/options.txt" ] || refuse "$folder: is no folder of parts; compile_with_parallel and compile_with_slurm make them"
  mapfile -t cads <"$folder/cad.txt"
  mapfile -t options <"$folder/options.txt"
  names=("${cads[@]##*/}")
  for i in "${!names[@]}"; do [[ ${names[i]} != ?*.* ]] || names[i]=${names[i]%.*}; done
  for i in "${!options[@]}"; do
    case ${options[i]} in
      --sensor) sensor=("${options[i + 1]-}") ;;
      --sensor=*) sensor=("${options[i]#*=}") ;;
    esac
  done
  settings=$({ digests "$foresightc" "${sensor[@]}" && cat "$folder/options.txt"; } | sha256sum | cut -c 1-64)
}

# Prints the lines of cad.txt, counted from 1, whose parts are not done.
undone() {
  local i part candidates=() inputs=() outputs=() now=() said
  for i in "${!cads[@]}"; do
    part=$folder/${names[i]}.fdb
    [ -r "$part.done" ] && [ -r "$part" ] && [ -r "${cads[i]}" ] || continue
    candidates+=("$i")
    inputs+=("${cads[i]}")
    outputs+=("$part")
  done
  mapfile -t now < <(paste -d ' ' <(digests "${inputs[@]}") <(digests "${outputs[@]}"))
  local is_done=()
  for i in "${!candidates[@]}"; do
    IFS= read -r said <"${outputs[i]}.done" || continue
    [ "$said" != "$settings ${now[i]-}" ] || is_done[candidates[i]]=yes
  done
  for i in "${!cads[@]}"; do [ -n "${is_done[i]-}" ] || echo $((i + 1)); done
}
