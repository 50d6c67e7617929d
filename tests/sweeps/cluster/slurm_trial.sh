#!/bin/bash
# SPDX-License-Identifier: MIT
# examples/cluster/slurm.sh and slurm_array.sh on a Slurm of two nodes that runs on this machine: a job that is cut by its time goes back
# into the queue and on, and has the answer of one machine; one that loses a rank ends, and the next goes on; one that brings nothing new
# stays out of the queue; and nodes that share no file system write shards. By hand, as root, with slurm-wlm and munge installed:
#   tests/sweeps/cluster/slurm_trial.sh PROGRAM MPI_PROGRAM
# Each node is a slurmd with a name and a /tmp of its own. A job that is queued again waits for cred_expire.
set -eu
program=$(readlink -f "$1")
mpi_program=$(readlink -f "$2")
examples=$(readlink -f "$(dirname "$0")/../../../examples/cluster")
work=$(mktemp -d -p /var/tmp)  # not below /tmp, which each node has for itself
export SLURM_CONF=$work/slurm.conf WHOLEHAND_MPI=$mpi_program
stop() {
  scontrol shutdown >/dev/null 2>&1 || :
  sleep 1
  for pid in "$work"/run/*.pid; do kill "$(cat "$pid")" 2>/dev/null || :; done
  rm -rf "$work"
}
trap stop EXIT

mkdir -p "$work"/{state,spool-n1,spool-n2,tmp-n1,tmp-n2,run,log,results}
host=$(hostname -s)
cat >"$SLURM_CONF" <<EOF
ClusterName=trial
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=17817
AuthType=auth/munge
AuthInfo=socket=$work/run/munge.socket,cred_expire=5
MpiDefault=pmix
ProctrackType=proctrack/pgid
TaskPlugin=task/none
ReturnToService=2
SlurmctldPidFile=$work/run/slurmctld.pid
SlurmdPidFile=$work/run/slurmd-%n.pid
SlurmdSpoolDir=$work/spool-%n
StateSaveLocation=$work/state
KillOnBadExit=1
SlurmUser=root
SlurmdUser=root
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmctldLogFile=$work/log/slurmctld.log
SlurmdLogFile=$work/log/slurmd-%n.log
SchedulerParameters=sched_interval=1,bf_interval=1
NodeName=n1 NodeHostname=n1 NodeAddr=127.0.0.1 Port=17818 CPUs=2
NodeName=n2 NodeHostname=n2 NodeAddr=127.0.0.1 Port=17819 CPUs=2
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
EOF
(umask 077 && head -c 1024 /dev/urandom >"$work/munge.key")
munged --key-file="$work/munge.key" --socket="$work/run/munge.socket" --pid-file="$work/run/munged.pid" \
  --log-file="$work/log/munged.log" --seed-file="$work/run/seed" --force 2>/dev/null
slurmctld
for node in n1 n2; do
  unshare --uts --mount sh -c "hostname $node; mount --bind $work/tmp-$node /tmp; exec slurmd -N $node"
done
for _ in $(seq 50); do [ "$(sinfo -h -t idle -o %D)" = 2 ] && break || sleep 0.2; done
sinfo

cat >"$work/scene.toml" <<'EOF'
[[vessel]]
name = "cup"
shape = "cylinder"
diameter_mm = 60
height_mm = 100
wall_mm = 1.5

[liquid]
fills = [0, 1]

[table]

[strength]

[tilts]
deg = [0, 45]

[grips]
height_fraction = { from = 0.1, to = 0.95, count = 8000 }
roll_deg = { from = -90, to = 30, count = 13 }
obliquity_deg = { from = -15, to = 20, count = 4 }
EOF
cd "$work"
"$program" sweep scene.toml -o alone.nc --on core >/dev/null

# cut by its own time limit, as by Slurm's: the signal comes before the wall time in the same way
sbatch --nodes=2 --ntasks=2 --time=0:10:00 --output=job.out "$examples/slurm.sh" "$work/scene.toml" "$work/shared.nc" \
  --on core --threads 1 --time-limit 8
all_done() { for _ in $(seq 1200); do [ -z "$(squeue -h)" ] && return || sleep 0.5; done; echo "a job hangs"; exit 1; }
all_done
cut -c 1-150 job.out

# one rank is killed; the same command goes on
job=(--nodes=2 --ntasks=2 --time=0:10:00 --output=killed.out "$examples/slurm.sh" "$work/scene.toml" "$work/killed.nc" --on core --threads 1)
sbatch "${job[@]}" --mark-seconds 1
until [ -e killed.nc.partial.mark ]; do sleep 0.1; done
for pid in $(pgrep -x wholehand-mpi); do
  if grep -qz "$work/killed.nc" "/proc/$pid/cmdline" && grep -qzx SLURM_PROCID=1 "/proc/$pid/environ"; then kill -9 "$pid"; fi
done
start=$SECONDS
all_done
echo "it ended $((SECONDS - start)) s after a rank was killed"
sbatch "${job[@]}"
all_done
cut -c 1-150 killed.out

# robust scores that take longer than the time limit: the job is queued again for its grips, and then no more
sed 's/count = 8000/count = 10/' scene.toml >robust.toml
printf '[robust]\nheight_mm = 2\ncount = 4000\n' >>robust.toml
sbatch --nodes=2 --ntasks=2 --time=0:10:00 --output=robust.out "$examples/slurm.sh" "$work/robust.toml" "$work/robust.nc" --on core \
  --threads 1 --best 100 --time-limit 3
all_done
cut -c 1-150 robust.out

printf '%s\n' "$work/scene.toml" >scenes.txt
sbatch --wait --array=1-1 --ntasks=3 --time=0:10:00 --output=array.out "$examples/slurm_array.sh" "$work/scenes.txt" "$work/results" --on core
cut -c 1-150 array.out

# each node writes into a /tmp of its own
sbatch --wait --nodes=2 --ntasks=2 --time=0:10:00 --output=apart.out "$examples/slurm.sh" "$work/scene.toml" /tmp/apart.nc --on core \
  --threads 1 --shards
cut -c 1-150 apart.out
cp tmp-n1/apart.nc.partial tmp-n1/apart.nc.partial.mark tmp-n2/apart.nc.n2.shard .
"$program" merge apart.nc

/usr/bin/python3 - alone.nc shared.nc killed.nc apart.nc results/scene.nc <<'EOF'
import sys
import netCDF4

def values(path):
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        return {name: variable[...].tobytes() if variable.dtype is not str else str(variable[...]) for name, variable in file.variables.items()}

alone = values(sys.argv[1])
for path in sys.argv[2:]:
    assert values(path) == alone, path
    print(f"{path} has the values of {sys.argv[1]}, bit for bit")
EOF
