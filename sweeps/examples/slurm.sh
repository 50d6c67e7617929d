#!/bin/bash
# SPDX-License-Identifier: MIT
# One sweep on a cluster with Slurm. When its time is over the job closes the result, goes back into the queue, and goes on where it ended.
#   sbatch --nodes=4 --ntasks-per-node=8 --time=4:00:00 slurm.sh SCENE RESULT.nc [OPTION ...]
# The options are those of `wholehand sweep`. WHOLEHAND_MPI names the program, if it is not on the path. The folder of the result must be
# on a file system that all nodes share.
#SBATCH --job-name=wholehand
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=USR1@120
set -u
[ $# -ge 2 ] || { echo "usage: sbatch [SBATCH-OPTION ...] slurm.sh SCENE RESULT.nc [OPTION ...]" >&2; exit 2; }
scene=$1
result=$2
shift 2
# Open MPI and Slurm speak PMIx with each other
srun --mpi=pmix "${WHOLEHAND_MPI:-wholehand-mpi}" sweep "$scene" -o "$result" --resume "$@"
code=$?
# 130: interrupted, and what is done is marked
if [ $code = 130 ] && [ -e "$result.partial.mark" ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit $code
