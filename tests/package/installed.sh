#!/bin/bash
# SPDX-License-Identifier: MIT
# The packages on a real system: made, looked over by lintian, installed with apt, used by a user who owns nothing, and purged without
# a trace. Needs root, or sudo, and changes the system while it runs; refuses where one of the packages is installed already.
#   installed.sh [FOLDER OF .deb FILES]       (default: makes them)
set -euo pipefail
root=$(cd "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
as_root=()
[ "$(id -u)" = 0 ] || as_root=(sudo -n)
work=$(mktemp -d)
failures=0

check() {  # check WHAT COMMAND ...
  local what=$1
  shift
  if "$@"; then echo "ok    $what"; else echo "FAILS $what"; failures=$((failures + 1)); fi
}
equal() { [ "$1" = "$2" ] || { echo "      got '$1', expected '$2'"; return 1; }; }
has() { grep -qF -- "$2" <<<"$1" || { echo "      got '$1', expected it to have '$2'"; return 1; }; }
one_line() { [ -n "$1" ] && [ "$(grep -c '' <<<"$1")" = 1 ] || { echo "      got '$1', expected one line"; return 1; }; }
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -q -y -o DPkg::Lock::Timeout=300 "$@" >"$work/apt.log" 2>&1 </dev/null || { tail -n 20 "$work/apt.log"; return 1; }
}
# Whatever has our name in the places of a system.
traces() { "${as_root[@]}" find /bin /etc /lib /opt /run /srv /usr /var -xdev -name '*wholehand*' 2>/dev/null | sort -u; }
clean_up() {
  [ -z "${installed-}" ] || apt purge "${names[@]}" || :
  "${as_root[@]}" rm -rf "$work"
}
trap clean_up EXIT

# ---- the packages ----
began=$SECONDS
folder=$(realpath -m -- "${1-$work/debs}")
[ $# -gt 0 ] || "$root/wholehand" package "$folder" | tail -n 1
debs=("$folder"/*.deb)
names=()
for deb in "${debs[@]}"; do names+=("$(dpkg-deb -f "$deb" Package)"); done
echo "      ${names[*]}: made in $((SECONDS - began)) s"
for name in "${names[@]}"; do
  if dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null | grep -q '^installed'; then
    echo "$name is installed here, and this test would purge it; purge it first" >&2
    exit 2
  fi
done
tools=()
command -v lintian >/dev/null || tools+=(lintian)
command -v man >/dev/null || tools+=(man-db)
if [ ${#tools[@]} != 0 ]; then
  apt install --no-install-recommends "${tools[@]}" || { apt update && apt install --no-install-recommends "${tools[@]}"; }
fi
lintian --allow-root --fail-on error "${debs[@]}" >"$work/lintian" 2>&1 && found=0 || found=$?
sed 's/^/      /' "$work/lintian"
check "lintian finds no error" equal "$found" 0

# ---- installed ----
began=$SECONDS
before=$(traces)
chmod 755 "$work"
installed=yes
check "apt installs them" apt install "${debs[@]}"
echo "      installed in $((SECONDS - began)) s"
dpkg -L "${names[@]}" | sort -u >"$work/files"
check "nothing is installed outside /usr" equal "$(grep -v -e '^/usr' -e '^/\.$' "$work/files")" ""

# ---- used, by somebody who owns nothing but one folder ----
mkdir "$work/place"
"${as_root[@]}" chown 65534:65534 "$work/place"
cd "$work/place"
nobody() {  # nobody [NAME=VALUE ...] COMMAND ...
  "${as_root[@]}" setpriv --reuid=65534 --regid=65534 --clear-groups env -i PATH=/usr/bin:/bin LC_ALL=C.UTF-8 "$@"
}
began=$SECONDS
version=$(sed -n 's/^project(wholehand VERSION \([0-9.]*\) .*/\1/p' "$root/CMakeLists.txt")
check "wholehand runs from the path" equal "$(nobody wholehand --version | head -n 1)" "wholehand $version"
check "help names no launcher" equal "$(nobody wholehand --help | grep -c '^Usage: wholehand ')" 1
check "the shipped scenes are there" has "$(nobody wholehand scenes)" "small          tumbler"
for home in "" HOME=/nonexistent HOME=/usr; do
  output=$(nobody ${home:+"$home"} wholehand sweep small 2>&1) && code=0 || code=$?
  check "a sweep with ${home:-HOME unset}" equal "$code" 0
  check "writes its results here" equal "$(ls | tr '\n' ' ')" "small.best.csv small.nc small.tumbler.svg "
  check "and shows the best" has "$output" "  rank  "
  rm -f small.*
done
# on a busy machine another user's file may go while find reads it, which is no failure
output=$("${as_root[@]}" find / -xdev -user 65534 -newer "$work/files" -not -path "$work/*" -not -path '/proc/*' 2>/dev/null || :)
check "nothing is written elsewhere" equal "$output" ""
output=$(cd / && nobody wholehand sweep small --on core 2>&1) && code=0 || code=$?
check "a folder that cannot be written to gives exit code 2 or 3" has "2 3" "$code"
check "and one line" one_line "$(grep '^wholehand: ' <<<"$output")"
nobody wholehand sweep small >/dev/null 2>&1
check "the page of a result" nobody sh -c 'wholehand report small.nc >report.out 2>&1 && grep -q "<html" small.html'
check "a drawing of a grip" nobody sh -c \
  'wholehand grip small --vessel tumbler --height-mm 50 --svg grip.svg >grip.out && grep -q "<svg" grip.svg'
check "a session, recorded" nobody sh -c \
  'wholehand live --no-clock --seconds 2 --record session.nc >session.out && test -s session.nc'
output=$(nobody XDG_CACHE_HOME="$work/place/kept" wholehand devices 2>&1)
check "the cache is where XDG_CACHE_HOME says" has "$output" "$work/place/kept/wholehand"
echo "      used in $((SECONDS - began)) s"

# ---- what comes with the program ----
for page in wholehand wholehand-sweep wholehand-stability-wall; do
  check "man $page" has "$(nobody man -w "$page" 2>&1)" "/usr/share/man/man1/$page.1.gz"
  check "without a warning" equal "$(nobody MANWIDTH=80 man --warnings=w "$page" 2>&1 >/dev/null)" ""
done
output=$(bash --norc -c 'source /usr/share/bash-completion/completions/wholehand
  COMP_WORDS=(wholehand sweep sm) COMP_CWORD=2; _wholehand; echo "${COMPREPLY[@]}"')
check "bash completes a scene" equal "$output" small
check "udev knows grippers" grep -q 'wholehand gripper' /usr/lib/udev/rules.d/60-wholehand.rules
check "the dynamic linker knows the library" has "$(/sbin/ldconfig -p)" "libwholehand.so.0 "
if command -v cc >/dev/null && command -v pkg-config >/dev/null; then
  printf '#include <stdio.h>\n#include <wholehand/wholehand.h>\n%s\n' 'int main(void) { return puts(wh_version()) < 0; }' \
    >"$work/version.c"
  # shellcheck disable=SC2046
  check "a program in C is compiled" cc -o "$work/version" "$work/version.c" $(pkg-config --cflags --libs wholehand)
  check "and runs" equal "$("$work/version")" "$version"
fi
if [ -e /usr/lib/python3/dist-packages/wholehand/__init__.py ]; then
  check "the Python module is there" nobody /usr/bin/python3 -c 'import wholehand; wholehand.scene("small")'
fi

# ---- purged ----
cd /
began=$SECONDS
check "apt purges them" apt purge "${names[@]}"
installed=
echo "      purged in $((SECONDS - began)) s"
left=
while read -r path; do
  if [ -e "$path" ] && { [ ! -d "$path" ] || [[ $path == *wholehand* ]]; }; then left+="$path "; fi
done <"$work/files"
check "none of their files is left" equal "$left" ""
check "nor anything else with their name" equal "$(traces)" "$before"
check "dpkg has forgotten them" equal "$(dpkg-query -W "${names[@]}" 2>/dev/null)" ""

echo
[ $failures = 0 ] && echo "the installed package holds" || echo "$failures checks failed"
[ $failures = 0 ]
