#!/bin/bash
# SPDX-License-Identifier: MIT
# One sweep on a cluster with Slurm. When its time is over the job closes the result, goes back into the queue, and goes on where it ended.
#   sbatch --nodes=4 --ntasks-per-node=8 --time=4:00:00 slurm.sh SCENE RESULT.nc [OPTION ...]
# The options are those of `wholehand sweep`. WHOLEHAND_MPI names the program, if it is not on the path. The folder of the result must be
# on a file system that all nodes share, unless --shards is given. Then rank 0 must run on the same node each time, so name all nodes
# (--nodelist), and merge the shards at the end (docs/cluster.md). The job stays out of the queue if it brought nothing new, or after
# WHOLEHAND_RESTARTS (100) times.
#SBATCH --job-name=wholehand
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=USR1@120
set -u
[ $# -ge 2 ] || { echo "usage: sbatch [SBATCH-OPTION ...] slurm.sh SCENE RESULT.nc [OPTION ...]" >&2; exit 2; }
scene=$1
result=$2
shift 2
# what the mark knows, without its checksum and its times
progress() { sed -e 1d -e 's/"[a-z]*_seconds":[^,}]*//g' "$result.partial.mark" 2>/dev/null | cksum; }
before=$(progress)
# Open MPI and Slurm speak PMIx with each other. --wait: a minute after the first rank has ended the others have, too: a rank that died
# leaves none waiting, and ranks that end together are not cut (as --kill-on-bad-exit=1 would).
srun --mpi=pmix --kill-on-bad-exit=0 --wait=60 "${WHOLEHAND_MPI:-wholehand-mpi}" sweep "$scene" -o "$result" --resume "$@"
code=$?
[ $code = 130 ] || exit $code
# 130: interrupted, and what is done is marked
if [ "$(progress)" = "$before" ]; then
  echo "slurm.sh: this run brought nothing new; submit it again with a longer --time" >&2
elif [ "${SLURM_RESTART_COUNT:-0}" -ge "${WHOLEHAND_RESTARTS:-100}" ]; then
  echo "slurm.sh: queued again ${SLURM_RESTART_COUNT:-0} times; submit it again to go on" >&2
else
  scontrol requeue "$SLURM_JOB_ID"
fi
exit $code
