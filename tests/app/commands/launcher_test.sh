#!/bin/bash
# SPDX-License-Identifier: MIT
# The launcher, in a copy of its own with a program of a few lines: it builds, rebuilds, passes things on, and says what is wrong.
# No network, and nothing is installed: apt-get, dpkg-query, id and sudo are stand-ins where they matter.
#   launcher_test.sh SOURCE_DIR
set -u
source_dir=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tree="$work/a tree's place"
failures=0

check() {  # check WHAT CONDITION...
  local what=$1
  shift
  if "$@"; then echo "ok    $what"; else echo "FAILS $what"; failures=$((failures + 1)); fi
}
equal() { [ "$1" = "$2" ] || { echo "      got '$1', expected '$2'"; return 1; }; }
has() { grep -qF -- "$2" <<<"$1" || { echo "      got '$1', expected it to have '$2'"; return 1; }; }
lines() { printf '%s' "$1" | grep -c ''; }

# ---- the copy ----
mkdir -p "$tree/app" "$tree/core" "$work/bin"
cp "$source_dir/wholehand" "$tree/"
cat >"$tree/packages.txt" <<'EOF'
# runs
dpkg        # there on any Debian

# cluster
wholehand-cluster-only-package

# scale
wholehand-scale-only-package

# package
wholehand-package-only-package

# test
wholehand-test-only-package

# all
wholehand-all-only-package
EOF
cat >"$tree/CMakeLists.txt" <<'EOF'
cmake_minimum_required(VERSION 3.25)
project(stub LANGUAGES CXX)
option(WHOLEHAND_TESTS "" ON)
option(WHOLEHAND_MPI "" OFF)
option(WHOLEHAND_SCALE "" OFF)
file(GLOB sources CONFIGURE_DEPENDS core/*.cpp)
add_executable(wholehand app/main.cpp ${sources})
add_executable(wholehand-sweep app/main.cpp ${sources})
target_compile_definitions(wholehand-sweep PRIVATE ONLY_SWEEPS)
if(WHOLEHAND_MPI)
  add_executable(wholehand-mpi app/main.cpp)
endif()
if(WHOLEHAND_SCALE)
  add_executable(wholehand-scale app/main.cpp)
endif()
add_custom_target(packaging)
install(TARGETS wholehand)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT nobody)
set(CPACK_PACKAGE_VERSION 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
include(CPack)
EOF
cat >"$tree/CMakePresets.json" <<'EOF'
{"version": 5, "configurePresets": [{"name": "default", "generator": "Ninja", "binaryDir": "${sourceDir}/build/default"}]}
EOF
cat >"$tree/app/main.cpp" <<'EOF'
#include <cstdio>
#include <unistd.h>
#include "../core/version.h"
int main(int n, char** a) {
  std::printf(VERSION);
#ifdef ONLY_SWEEPS
  std::printf(" for sweeps");
#endif
  for (int i = 1; i < n; ++i) std::printf("[%s]", a[i]);
  char here[4096];
  std::printf("%s\n", getcwd(here, sizeof here));
  return 7;
}
EOF
echo '#define VERSION "v1"' >"$tree/core/version.h"

# ---- first start, and what is passed on ----
cd "$work" || exit 1
output=$("$tree/wholehand" one "two words" '' 2>"$work/err")
check "the exit code is the program's" equal $? 7
check "arguments and the caller's folder are passed on" equal "$output" "v1[one][two words][]$work"
check "the first start says that it builds" has "$(cat "$work/err")" "wholehand: building"

output=$("$tree/wholehand" 2>&1)
check "the second start says nothing of its own" equal "$output" "v1$work"
ln -s "$tree/wholehand" "$work/link"
mkdir -p "$work/else where"
output=$(cd "$work/else where" && ../link x 2>&1)
check "through a symbolic link, from another folder" equal "$output" "v1[x]$work/else where"
output=$(cd "$tree" && PATH="$tree:$PATH" wholehand 2>&1)
check "found on the path" equal "$output" "v1$tree"

# ---- sweeps have a program of their own, which is built sooner ----
check "the whole program sweeps where it is there" equal "$("$tree/wholehand" sweep one 2>&1)" "v1[sweep][one]$work"
check "and none is built for sweeps" [ ! -e "$tree/build/default/wholehand-sweep" ]
rm -rf "$tree/build"
check "a first sweep has its own" equal "$("$tree/wholehand" sweep 2>/dev/null)" "v1 for sweeps[sweep]$work"
check "and builds nothing else" [ ! -e "$tree/build/default/wholehand" ]
output=$("$tree/wholehand" sweep 2>&1)
check "the second sweep says nothing of the launcher's own" equal "$output" "v1 for sweeps[sweep]$work"
check "any other command builds the whole program" equal "$("$tree/wholehand" rank sweep 2>"$work/err")" "v1[rank][sweep]$work"
check "and says so" has "$(cat "$work/err")" "wholehand: building"
check "which sweeps from there on" equal "$("$tree/wholehand" sweep 2>&1)" "v1[sweep]$work"

# ---- what it costs: printed, not judged ----
measure() { local began=$EPOCHREALTIME; for _ in 1 2 3 4 5 6 7 8 9 10; do "$@" >/dev/null 2>&1; done; echo $(((${EPOCHREALTIME/./} - ${began/./}) / 10)); }
with=$(measure "$tree/wholehand")
without=$(measure "$tree/build/default/wholehand")
echo "      a later start adds $((with - without)) microseconds (program alone: $without)"

# ---- what makes it build again ----
sleep 0.05
echo '#define VERSION "v2"' >"$tree/core/version.h"
check "an edited header is built into the program for sweeps" equal "$("$tree/wholehand" sweep 2>/dev/null)" "v2 for sweeps[sweep]$work"
check "and into the whole one" equal "$("$tree/wholehand" 2>/dev/null)" "v2$work"
echo 'syntax error' >"$tree/core/new.cpp"
output=$("$tree/wholehand" 2>&1)
check "an added source that fails gives exit code 3" equal $? 3
check "and the compiler's words" has "$output" "new.cpp:1"
check "and the launcher's last line" has "$(tail -n 1 <<<"$output")" "wholehand: building failed"
rm "$tree/core/new.cpp"
check "a removed source builds again" equal "$("$tree/wholehand" 2>/dev/null)" "v2$work"
mv "$tree" "$work/moved"
tree=$work/moved
check "a tree that was moved builds again" equal "$("$tree/wholehand" 2>/dev/null)" "v2$work"
echo 'nonsense(' >>"$tree/CMakeLists.txt"
output=$("$tree/wholehand" 2>&1)
check "a broken CMakeLists.txt gives exit code 3" equal $? 3
check "and CMake's words" has "$output" "CMakeLists.txt:23"
sed -i '$d' "$tree/CMakeLists.txt"

# ---- a user who may not write here ----
touch "$tree/core/version.h"
check "(the program for sweeps)" equal "$("$tree/wholehand" sweep 2>/dev/null)" "v2 for sweeps[sweep]$work"
check "(and the whole one)" equal "$("$tree/wholehand" 2>/dev/null)" "v2$work"
others() {  # others COMMAND ...: as a user to whom the tree belongs as little as to anybody
  if [ "$(id -u)" = 0 ]; then setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; else "$@"; fi
}
sleep 0.05
touch "$work/status"  # dpkg's, of which a newer one means that root has installed something
sed "s|/var/lib/dpkg/status|$work/status|" "$source_dir/wholehand" >"$tree/wholehand.other"
chmod 755 "$work" "$tree/wholehand.other"
chmod -R a+rX,a-w "$tree"
output=$(others "$tree/wholehand.other" x 2>&1)
check "after root has installed a package the program runs, and nothing is said" equal "$output" "v2[x]$work"
touch "$tree/core/version.h"
output=$(others "$tree/wholehand" x 2>"$work/err")
check "after root has changed a source the program of before runs" equal "$output" "v2[x]$work"
check "with a note" has "$(cat "$work/err")" "wholehand: core has changed since the program was built, and you cannot write"
check "in one line" equal "$(lines "$(cat "$work/err")")" 1
output=$(others "$tree/wholehand" test 2>&1)
check "who cannot write cannot build" equal "$? $output" "3 wholehand: cannot write $tree/build, which the build needs"
chmod -R u+w "$tree"
mv "$tree/build/default/wholehand-sweep" "$work/kept"
chmod -R a-w "$tree"
output=$(others "$tree/wholehand" sweep x 2>"$work/err")
check "without the program for sweeps the whole one sweeps" equal "$output" "v2[sweep][x]$work"
check "with its own note" has "$(cat "$work/err")" "wholehand: core has changed since the program was built, and you cannot write"
chmod -R u+w "$tree"
mv "$work/kept" "$tree/build/default/wholehand-sweep"
mv "$tree/build/default/wholehand" "$work/kept"
chmod -R a-w "$tree"
check "a sweep needs its own alone" equal "$(others "$tree/wholehand" sweep x 2>/dev/null)" "v2 for sweeps[sweep][x]$work"
output=$(others "$tree/wholehand" 2>&1)
check "nor run what is not built" equal "$? $output" "3 wholehand: cannot write $tree/build, which the build needs"
chmod -R u+w "$tree"
mv "$work/kept" "$tree/build/default/wholehand"
rm "$tree/wholehand.other"

# ---- two starts at once ----
rm -rf "$tree/build"
"$tree/wholehand" first >"$work/first" 2>&1 &
first=$!
"$tree/wholehand" second >"$work/second" 2>&1
wait $first
check "two first starts at once: one" equal "$(tail -n 1 "$work/first")" "v2[first]$work"
check "and the other" equal "$(tail -n 1 "$work/second")" "v2[second]$work"
check "one of them waited" has "$(cat "$work/first" "$work/second")" "waiting for another start"

# ---- packages: stand-ins for the system's tools ----
tool() { cat >"$work/bin/$1" && chmod +x "$work/bin/$1"; }
tool dpkg-query <<EOF
#!/bin/sh
shift 3
for p; do if grep -qx "\$p" "$work/installed"; then echo "installed \$p"; fi; done
EOF
tool apt-get <<EOF
#!/bin/sh
echo "\$@" >>"$work/apt"
case "\$*" in
  *" update") touch "$work/updated" ;;
  *) if [ -e "$work/updated" ]; then for p; do echo "\$p"; done >>"$work/installed"; else echo "E: Unable to locate package" ; exit 100; fi ;;
esac
EOF
start() { PATH="$work/bin:$PATH" "$tree/wholehand" "$@" 2>&1; }
fresh() { echo dpkg >"$work/installed"; rm -f "$work/apt" "$work/updated"; touch "$tree/packages.txt"; }

fresh
tool id <<<'#!/bin/sh
echo 0'
check "nothing missing: apt-get is not called" equal "$(start)" "v2$work"
check "(no call)" [ ! -e "$work/apt" ]
sed -i '/^dpkg/a lib-one # with a remark' "$tree/packages.txt"
fresh
output=$(start)
check "what is missing is named" has "$output" "wholehand: installing: lib-one"
check "and installed, the lists fetched first where that is needed" equal "$(sed 's/.*120 //' "$work/apt" | tr '\n' ';')" \
  "install --no-install-recommends lib-one;update;install --no-install-recommends lib-one;"
check "then the program runs" equal "$(tail -n 1 <<<"$output")" "v2$work"
check "packages of later parts are not asked for by a run" equal "$(grep -c -e -only-package "$work/apt")" 0

fresh
touch "$work/updated"
output=$(start cluster)
check "cluster asks for its own" has "$(cat "$work/apt")" "install --no-install-recommends lib-one wholehand-cluster-only-package"
check "and for no others" equal "$(grep -c -e scale-only -e package-only -e test-only "$work/apt")" 0
check "cluster builds its program" [ -x "$tree/build/default/wholehand-mpi" ]
check "and says how to start it" has "$(tail -n 1 <<<"$output")" "mpirun -n N $tree/build/default/wholehand-mpi sweep SCENE"
output=$(start cluster --all)
check "it takes no argument" equal "$? $output" "2 wholehand: cluster takes no argument; found --all"

fresh
touch "$work/updated"
output=$(start scale one)
check "scale asks for its own" has "$(cat "$work/apt")" \
  "install --no-install-recommends lib-one wholehand-cluster-only-package wholehand-scale-only-package"
check "and for no others" equal "$(grep -c -e package-only -e test-only "$work/apt")" 0
check "and starts its program" has "$output" "[one]"

fresh
touch "$work/updated"
output=$(cd "$work" && start package "debs' place")
check "package asks for its own" has "$(cat "$work/apt")" "install --no-install-recommends lib-one wholehand-package-only-package"
check "and for no others" equal "$(grep -c -e cluster-only -e scale-only -e test-only "$work/apt")" 0
deb=$(echo "$work/debs' place/"*.deb)
check "makes a package of the program" has "$(dpkg-deb -c "$deb")" "/bin/wholehand"
check "and names it" equal "$(head -n 1 <<<"$(grep -v ^wholehand: <<<"$output")")" "$deb"
check "and how to install it" equal "$(eval "set -- $(tail -n 1 <<<"$output" | sed 's/.*apt-get //')"; echo "$*")" "install $deb"
check "in a second start too, in the build folder" has "$(start package)" "$tree/build/packages/stub_1_"
touch "$work/file"
output=$(start package "$work/file")
check "a folder that cannot be written to gives exit code 3" equal "$? $output" "3 wholehand: cannot write packages to $work/file"
output=$(start package --all)
check "an option gives exit code 2" equal "$? $output" "2 wholehand: package has no options; found --all"
output=$(start package --help)
check "but --help says what it does" equal "$? $output" \
  "0 ./wholehand package [DIR]          makes Debian packages in DIR (build/packages) and says how to install them"
output=$(start cluster -h)
check "as it does of cluster" equal "$? $(lines "$output") ${output%% *}" "0 1 ./wholehand"
output=$(start test -h)
check "and of test and test --all" equal "$? $(lines "$output") ${output%% *}" "0 2 ./wholehand"
output=$(start package one two)
check "as do two folders" equal "$? $output" "2 wholehand: package takes one folder at most"
check "nothing else is left in the build folder" equal "$(ls "$tree/build/default" | grep -c packing)" 0

fresh
touch "$work/updated"
start test >/dev/null
check "test asks for its own" has "$(cat "$work/apt")" "install --no-install-recommends lib-one wholehand-test-only-package"
check "and for no others" equal "$(grep -c -e cluster-only -e scale-only -e package-only -e all-only "$work/apt")" 0
fresh
touch "$work/updated"
start test --all >/dev/null
check "test --all asks for all" has "$(cat "$work/apt")" \
  "install --no-install-recommends lib-one wholehand-cluster-only-package wholehand-scale-only-package wholehand-package-only-package wholehand-test-only-package wholehand-all-only-package"
check "after which nothing is built again, for sweeps neither" equal "$(start sweep; start)" "v2[sweep]$work
v2$work"
chmod -R a-w "$tree"
check "nor called old" equal "$(others "$tree/wholehand" sweep 2>&1)" "v2[sweep]$work"
chmod -R u+w "$tree"

tool apt-get <<<'#!/bin/sh
echo "E: no network" ; exit 100'
fresh
output=$(start)
check "apt-get failing gives exit code 3" equal $? 3
check "and its reason in one line" has "$(tail -n 1 <<<"$output")" "could not install lib-one: E: no network"

tool id <<<'#!/bin/sh
echo 1000'
hidden=$(mktemp -d -p "$work")  # a path without sudo
for name in sh env readlink find sed grep mkdir flock date cmake ninja cat tail rm mv; do ln -s "$(command -v $name)" "$hidden/"; done
fresh
output=$(PATH="$work/bin:$hidden" "$tree/wholehand" 2>&1)
check "neither root nor sudo gives exit code 3" equal $? 3
check "and one line with the remedy" equal "$output" \
  "wholehand: packages are missing and neither root nor sudo is at hand: apt-get install lib-one"

echo
[ $failures = 0 ] && echo "the launcher holds" || echo "$failures checks failed"
[ $failures = 0 ]
