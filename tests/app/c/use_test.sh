#!/bin/sh
# SPDX-License-Identifier: MIT
# The installed C face: its header in C11 and in C++, and a program that uses all of it. STAGED: the folder where the packages are unpacked.
set -eu
here=$(dirname -- "$(readlink -f -- "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
library=$(dirname -- "$(find "$STAGED/usr/lib" -name libwholehand.so)")
export PKG_CONFIG_PATH="$library/pkgconfig"
flags=$(pkg-config --cflags --libs wholehand)
printf '#include <wholehand/wholehand.h>\nint main(void) { return wh_abi() != WH_ABI; }\n' >"$work/header.c"
cp "$work/header.c" "$work/header.cpp"
# shellcheck disable=SC2086
{
  cc -std=c99 -Wall -Wextra -pedantic -Werror "$work/header.c" $flags -o "$work/header_c"
  c++ -std=c++11 -Wall -Wextra -pedantic -Werror "$work/header.cpp" $flags -o "$work/header_cpp"
  cc -std=c11 -Wall -Wextra -pedantic -Werror -O1 "$here/use.c" $flags -lm -lpthread -o "$work/use"
}
export LD_LIBRARY_PATH="$library"
"$work/header_c"
"$work/header_cpp"
# the device speaks to the validation layer, and the layer has nothing to say
VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation "$work/use" >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }
cat "$work/said"
if grep -i -q 'validation' "$work/said"; then exit 1; fi

# the examples print what docs/c.md shows
for example in best_grip session; do
  # shellcheck disable=SC2086
  cc -std=c11 -Wall -Wextra -pedantic -Werror "$here/../../../examples/c/$example.c" $flags -lm -o "$work/$example"
  "$work/$example" >"$work/printed"
  while read -r line; do
    grep -q -F -- "    $line" "$here/../../../docs/c.md" || { echo "docs/c.md does not have this line of $example: $line"; exit 1; }
  done <"$work/printed"
  [ -s "$work/printed" ]
done

# a grip's text is the program's own
"$STAGED/usr/bin/wholehand" grip three_beakers --vessel beaker1 --height-mm 58.5 --json >"$work/program.json"
"$work/use" json three_beakers beaker1 0.0585 >"$work/library.json"
cmp "$work/program.json" "$work/library.json"
