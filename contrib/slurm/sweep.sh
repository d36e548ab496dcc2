#!/bin/sh
# Slurm: sbatch sweep.sh PLAN.toml ROWS. --array counts the plan's shards; --requeue repeats the tasks of a failed node.
# Finished shards are skipped, so the whole array may be submitted again. Finally: host-sim merge ROWS.
#SBATCH --array=0-13
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --time=01:00:00
exec host-sim sweep "$1" --out "$2"
