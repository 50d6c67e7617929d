#!/bin/bash
# SPDX-License-Identifier: MIT
# Measures what a GPU makes of the program in less than six minutes, and writes one folder to commit as docs/results/<device>/.
#   gpu_day.sh [--quick] OUT             packs and runs on this machine
#   gpu_day.sh pack FOLDER [BUILD]       packs what a build folder (default: build/default) has, with its libraries: less than 60 MiB
#   FOLDER/gpu_day.sh run [--quick] OUT  runs a packed folder where there are a Vulkan driver, bash and coreutils
# --quick: one scene and the smallest sizes, for a CPU driver. Exit codes: 0 every step did, 1 some step did not, 2 wrong usage, 3 failure.
set -euo pipefail
shopt -s nullglob
here=$(cd "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
sampler=
trap '[ -z "$sampler" ] || kill "$sampler" || :; rm -rf "$work"' EXIT
fail() { echo "gpu_day.sh: $1" >&2; exit "${2-2}"; }
usage() { while read -r line; do [[ $line != "#   "* ]] || echo "${line#"#   "}"; done <"${BASH_SOURCE[0]}" >&2; exit 2; }

# ---- on the machine that built ----
libraries_of() { ldd "$@" | sed -nE 's/^(.* => |[[:space:]]*)(\/[^ ]*) \(.*/\2/p' | sort -u; }
pack() {
  local root folder=$1 build program programs=() vulkan xz
  root=$(cd "$here/../.." && pwd) build=${2-$root/build/default}
  [ -f "$root/CMakeLists.txt" ] || fail "only a source tree can be packed"
  [ -x "$build/wholehand" ] || fail "$build has no program: build it with ./wholehand"
  vulkan=$(PATH=$PATH:/sbin ldconfig -p | sed -n 's/.*libvulkan\.so\.1 .* => //p' | head -n 1)  # the loader, opened at run time
  xz=$(command -v xz) || fail "xz is needed (xz-utils)" 3
  [ -n "$vulkan" ] || fail "the Vulkan loader is needed (libvulkan1)" 3
  [ ! -e "$folder/files" ] || fail "$folder has a packed folder already"
  mkdir -p "$folder/start" "$folder/files" "$folder/examples"
  for program in wholehand tests/wholehand_tests_plain tests/wholehand_bench; do
    if [ -x "$build/$program" ]; then
      programs+=("$build/$program")
      strip -o "$folder/files/${program##*/}" "$build/$program"
    else
      echo "gpu_day.sh: $build has no $program; its steps will be left out" >&2
    fi
  done
  libraries_of "${programs[@]}" "$vulkan" | xargs cp -L -t "$folder/files" -- "$vulkan"
  find "$folder/files" -type f -print0 | xargs -0 -n 1 -P "$(nproc)" xz -1
  libraries_of "$xz" | xargs cp -L -t "$folder/start" -- "$xz"
  cp -r "$root/examples/scenes" "$root/examples/extreme" "$folder/examples/"
  cp -- "${BASH_SOURCE[0]}" "$folder/gpu_day.sh"
  git -C "$root" describe --always --dirty >"$folder/commit" 2>/dev/null || echo "unknown commit" >"$folder/commit"
}

# ---- on the machine with the GPU ----
# Unpacks into $work. `start` becomes what starts a program: on the system's C library where that is new enough, as the driver needs it too.
unpack() {
  local file name folder loader=("$here"/start/ld-linux*)
  [ ${#loader[@]} = 1 ] || fail "$here is no packed folder: make one with 'gpu_day.sh pack FOLDER'"
  mkdir "$work/bin" "$work/lib" "$work/base" "$work/scratch"
  for file in "$here"/files/*.xz; do
    name=${file##*/} name=${name%.xz}
    case $name in
      wholehand*|ld-linux*) folder=bin ;;
      libc.so.*|libm.so.*|libpthread.so.*|libresolv.so.*|libstdc++.so.*|libgcc_s.so.*) folder=base ;;
      *) folder=lib ;;
    esac
    "${loader[0]}" --library-path "$here/start" "$here/start/xz" -dc "$file" >"$work/$folder/$name" &
  done
  wait
  chmod +x "$work"/bin/*
  ln -s "$here/examples" "$work/examples"
  start=(env "LD_LIBRARY_PATH=$work/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}")
  "${start[@]}" "$work/bin/wholehand" --version >/dev/null 2>&1 ||
    start=("$work/bin/${loader[0]##*/}" --library-path "$work/base:$work/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}")
  "${start[@]}" "$work/bin/wholehand" --version >/dev/null || fail "the packed program does not start here" 3
}

row() { printf '| %s |\n' "$1" | tee -a "$out/summary.md"; }

# step NAME LIMIT PROGRAM ARG ...: at most LIMIT seconds, less where less is left; its output is OUT/NAME.txt. Sets `took`, in ms.
failed=0
step() {
  local name=$1 limit=$2 left=$((END - SECONDS)) code=0 begin seconds
  shift 2
  took=0
  [ -x "$work/bin/$1" ] || { row "$name | left out: $1 is not packed | | "; return; }
  [ "$left" -ge 5 ] || { row "$name | left out: no time is left | | "; return; }
  [ "$limit" -lt "$left" ] || limit=$left
  begin=$(date +%s%N)
  (cd "$work/scratch" && exec timeout -k 5 "$limit" "${start[@]}" "$work/bin/$1" "${@:2}") >"$out/$name.txt" 2>&1 || code=$?
  took=$((($(date +%s%N) - begin) / 1000000))
  [ $code = 0 ] || failed=1
  seconds=$((took / 1000)).$((took % 1000 / 100))
  [[ $code != 124 && $code != 137 ]] || seconds+=", stopped"
  row "$name | \`${*//$out/OUT}\` | $code | $seconds"
}

# A scene's first sweep with nothing compiled, its second, and its check.
scene_steps() {
  export HOME="$work/cache-$1" XDG_CACHE_HOME="$work/cache-$1"
  mkdir -p "$HOME"
  step "sweep-$1-compiling" 40 wholehand sweep "$1" --on vulkan
  step "sweep-$1-again" 20 wholehand sweep "$1" --on vulkan
  step "check-$1" 60 wholehand check "$1"
}

# Sweeps of the default scene's vessels and states that keep nothing but the best grips. One that may not fit is left out.
sweep_steps() {
  local power=5 expected=0 heights obliquities rolls scene
  scene=$(<"$here/examples/scenes/three_beakers.toml")
  while read -r heights obliquities rolls && [ $power -le "$largest" ]; do
    if [ $expected -gt 90 ] || [ $expected -gt $((END - SECONDS)) ]; then
      row "sweep-1e$power | left out: may take $expected s | | "
      return
    fi
    printf '%s\n' "${scene%%\[grips\]*}" '[grips]' "height_fraction = { from = 0.1, to = 0.95, count = $heights }" \
      "obliquity_deg = { from = -20, to = 20, count = $obliquities }" "roll_deg = { from = -90, to = 30, count = $rolls }" \
      '[tilts]' 'deg = { from = 0, to = 150, count = 31 }' '[output]' 'keep = []' 'apart_mm = 0' >"$work/scratch/sweep-1e$power.toml"
    step "sweep-1e$power" 90 wholehand sweep "sweep-1e$power.toml" --on vulkan
    expected=$((took / 100)) power=$((power + 1))  # s of ten times the grips
  done <<<$'128 13 20\n256 26 50\n512 65 100\n1024 130 250'
}

clocks() {
  local fields=timestamp,name,driver_version,clocks.sm,clocks.mem,clocks.max.sm,clocks.max.mem,power.draw,temperature.gpu
  nvidia-smi --query-gpu=$fields --format=csv
  while sleep 5; do nvidia-smi --query-gpu=$fields --format=csv,noheader; done
}

run() {
  local scene scenes=(three_beakers mixing_board paper_pose small)
  local largest=8 parity='Parity*' extremes=Extreme.EveryBackendHolds
  local bench=('--benchmark_filter=^roofline' --roofline "$out/roofline.csv")
  if [ -n "$quick" ]; then
    scenes=(paper_pose) largest=5 parity='Parity.PaperPose*' extremes=Extreme.RowsHaveTheColumnsOfTheHead
    bench=('--benchmark_filter=^vulkan_float/' --benchmark_min_time=0.1 --csv "$out/bench.csv")
  fi
  unpack
  if command -v nvidia-smi >/dev/null; then
    clocks >"$out/clocks.csv" 2>&1 &
    sampler=$!
  fi
  export WHOLEHAND_VALIDATION=0  # the tests' layer is not packed
  printf '%s\n' "# wholehand $(<"$here/commit"), $(date -uI), $(uname -srm), $(nproc) processors" '' \
    '| step | command | exit code | s |' '|---|---|---|---|' | tee "$out/summary.md"
  step devices 10 wholehand devices
  scene_steps "${scenes[0]}"
  sweep_steps
  step parity 60 wholehand_tests_plain "--gtest_filter=$parity"
  step extremes 40 wholehand_tests_plain "--gtest_filter=$extremes"
  step roofline 70 wholehand_bench "${bench[@]}"
  for scene in "${scenes[@]:1}"; do scene_steps "$scene"; done
}

# ---- what is asked ----
END=315  # s from the start; packing takes half a minute
quick=
if [ "${1-}" = pack ]; then
  [[ $# = [23] ]] || usage
  pack "${@:2}"
  exit
fi
packed=
if [ "${1-}" = run ]; then packed=$here; shift; fi
if [ "${1-}" = --quick ]; then quick=--quick; shift; fi
[[ $# = 1 && $1 != -* ]] || usage
[ -n "$packed" ] || { pack "$work/packed" && bash "$work/packed/gpu_day.sh" run $quick "$1"; exit; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
run
exit $failed
