#!/bin/bash
# SPDX-License-Identifier: MIT
# Many scenes, each a job of its own: as many at a time as the cluster has room for.
#   sbatch --array=1-N --ntasks=8 --time=4:00:00 slurm_array.sh SCENES.txt FOLDER [OPTION ...]
# SCENES.txt names N scene files, one a line. The result of scene.toml is FOLDER/scene.nc. All else is as in slurm.sh.
#SBATCH --job-name=wholehand
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=USR1@120
set -u
[ $# -ge 2 ] || { echo "usage: sbatch --array=1-N [SBATCH-OPTION ...] slurm_array.sh SCENES.txt FOLDER [OPTION ...]" >&2; exit 2; }
scene=$(sed -n "${SLURM_ARRAY_TASK_ID}p" "$1")
[ -n "$scene" ] || { echo "$1 has no line ${SLURM_ARRAY_TASK_ID}" >&2; exit 2; }
name=$(basename "$scene" .toml)
result=$2/$name.nc
shift 2
progress() { sed -e 1d -e 's/"[a-z]*_seconds":[^,}]*//g' "$result.partial.mark" 2>/dev/null | cksum; }
before=$(progress)
srun --mpi=pmix --kill-on-bad-exit=0 --wait=60 "${WHOLEHAND_MPI:-wholehand-mpi}" sweep "$scene" -o "$result" --resume "$@"
code=$?
[ $code = 130 ] || exit $code
if [ "$(progress)" = "$before" ]; then
  echo "slurm_array.sh: this run brought nothing new; submit it again with a longer --time" >&2
elif [ "${SLURM_RESTART_COUNT:-0}" -ge "${WHOLEHAND_RESTARTS:-100}" ]; then
  echo "slurm_array.sh: queued again ${SLURM_RESTART_COUNT:-0} times; submit it again to go on" >&2
else
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
fi
exit $code
