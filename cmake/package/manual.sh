#!/bin/sh
# SPDX-License-Identifier: MIT
# Writes a manual page for the program and for each of its commands: wholehand.1.gz, wholehand-sweep.1.gz, wholehand-stability-wall.1.gz ...
# Everything in them is what the program prints for --help, but the sections that manual.h2m adds to the first page.
#   manual.sh PROGRAM VERSION FOLDER
set -eu
version=$2 folder=$3
here=$(dirname -- "$0")
rm -rf -- "$folder"
mkdir -p -- "$folder"
# help2man takes the words of a shell: neither the program's place nor that of the pages may stand in them
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ln -s -- "$(realpath -- "$1")" "$work/program"
program=$work/program
export LC_ALL=C.UTF-8 HOME="$work"
# help2man prints the month of the making; the program's is the same in all makings
: "${SOURCE_DATE_EPOCH:=$(stat -Lc %Y "$program")}"
export SOURCE_DATE_EPOCH

help_of() { "$program" "$@" --help; }
commands_of() { help_of "$@" | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p'; }
escaped() { sed 's/\\/\\\\/g; s/-/\\-/g'; }

# The section on exit codes: "Exit codes: 0 done, 1 the answer is no (check, grip), ..."
exit_codes() {
  echo '[EXIT STATUS]'
  help_of | sed -n 's/^Exit codes: \(.*\)\.$/, \1/p' | sed 's/, \([0-9]\)/\n\1/g' |
    sed -n 's/^\([0-9]*\) \(.*\)$/.TP\n.B \1\n\2/p'
}

see_also() {  # see_also PAGE ...
  echo '[SEE ALSO]'
  for page; do printf '.BR %s (1),\n' "$page" | escaped; done | sed '$s/,$//'
}

# page SUMMARY_EDIT INCLUDE WORD ...: of `wholehand WORD ...`
page() {
  include=$1
  shift
  name=wholehand
  for word; do name=$name-$word; done
  # help2man starts a program and takes its file's name for the page's. Options read better with a space after the comma; sentences end.
  {
    echo '#!/bin/sh'
    echo "exec '$work/filter' '$program' $* --help"
  } >"$work/$name"
  chmod +x "$work/$name"
  summary=$(help_of "$@" | head -n 1 | sed 's/\.$//; s/^[A-Z]/\l&/')
  help2man --no-info --name="$summary" --manual="User Commands" --source="wholehand $version" --version-string="$version" \
    --include="$include" "$work/$name" | gzip -9n >"$folder/$name.1.gz"
  [ "$(gzip -dc "$folder/$name.1.gz" | wc -l)" -gt 20 ] || { echo "no manual page of $name" >&2; exit 1; }
}

cat >"$work/filter" <<'END'
#!/bin/sh
"$@" | sed -e '1s/[^.]$/&./' -e 's/^  \(-[A-Za-z]\),--/  \1, --/' -e 's/^Positionals:/Arguments:/' -e 's/^Subcommands:/Commands:/' \
  -e '/^In a checkout/d' -e '/^Exit codes:/d'
END
chmod +x "$work/filter"

pages=
for command in $(commands_of); do
  pages="$pages wholehand-$command"
  inner=
  for part in $(commands_of "$command"); do
    inner="$inner wholehand-$command-$part"
    { exit_codes; see_also "wholehand-$command" wholehand; } >"$work/include"
    page "$work/include" "$command" "$part"
  done
  # shellcheck disable=SC2086
  { exit_codes; see_also wholehand $inner; } >"$work/include"
  page "$work/include" "$command"
done
# shellcheck disable=SC2086
{ exit_codes; cat "$here/manual.h2m"; see_also $pages; } >"$work/include"
page "$work/include"
touch "$folder/.made"
