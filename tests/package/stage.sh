#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes the Debian packages of a build folder and unpacks them, as apt would, into one folder. Tests of what is installed use it.
#   stage.sh BUILD_FOLDER STAGED
set -eu
build=$1 staged=$2
rm -rf "$staged" "$staged.debs"
cd "$build"
# not compressed, which would take most of the time
cpack -D CPACK_DEBIAN_COMPRESSION_TYPE=none -B "$staged.debs" >"$staged.log" 2>&1 || { cat "$staged.log"; exit 1; }
rm -rf "$staged.debs/_CPack_Packages"
mkdir "$staged"
for deb in "$staged.debs"/*.deb; do
  dpkg-deb -x "$deb" "$staged"
  dpkg-deb -f "$deb" Package
done
