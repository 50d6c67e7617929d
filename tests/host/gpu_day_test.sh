#!/bin/bash
# SPDX-License-Identifier: MIT
# gpu_day.sh packs, and runs every step in an empty root that has bash, a few programs of coreutils and lavapipe, here the GPU's driver.
# Exit code 77, which skips the test, where the system lets nobody make such a root.
#   gpu_day_test.sh BUILD_FOLDER [OPTION of gpu_day.sh run]
set -euo pipefail
here=$(cd "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/root
space=(unshare --mount)
[ "$(id -u)" = 0 ] || space+=(--map-root-user)
"${space[@]}" true || exit 77

copy() { cp -L --parents -t "$root" -- "$@"; }  # to the same place in the root
mkdir -p "$root/proc" "$root/dev" "$root/tmp" "$root/bin"
driver=$(sed -n 's/.*"library_path": *"\(.*\)".*/\1/p' /usr/share/vulkan/icd.d/lvp_icd.*.json)
copy "$driver" /usr/share/vulkan/icd.d/lvp_icd.*.json
programs=(bash)
for name in cat chmod date dirname env ln mkdir mktemp nproc rm sleep tee timeout uname; do programs+=("$name"); done
for name in "${programs[@]}"; do cp -L "$(command -v "$name")" "$root/bin/"; done
ldd "$driver" "$root"/bin/* | sed -nE 's/^(.* => |[[:space:]]*)(\/[^ ]*) \(.*/\2/p' | sort -u |
  while read -r library; do copy "$library"; done
printf '#!/bin/bash\necho clocks\n' >"$root/bin/nvidia-smi"
chmod +x "$root/bin/nvidia-smi"

bash "$here/gpu_day.sh" pack "$root/packed" "$1"
mib=$(du -sm "$root/packed" | cut -f 1)
echo "packed: $mib MiB"
[ "$mib" -lt 60 ]
# shellcheck disable=SC2016
"${space[@]}" sh -c 'mount --rbind /proc "$1/proc" && mount --rbind /dev "$1/dev" && root=$1 && shift &&
  exec chroot "$root" /bin/env -i PATH=/bin /bin/bash /packed/gpu_day.sh run "$@" /out' - "$root" "${@:2}" ||
  { tail -n 5 "$root"/out/*.txt; exit 1; }
for file in summary.md devices.txt clocks.csv; do [ -s "$root/out/$file" ]; done
! grep 'is not packed' "$root/out/summary.md"
grep -q 'PASSED  . [1-9]' "$root/out/parity.txt" && grep -q 'PASSED  . [1-9]' "$root/out/extremes.txt"
grep -q llvmpipe "$root/out/devices.txt"
