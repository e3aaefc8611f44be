#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# One case of a cohort per task of a Slurm job array. Submit it for all rows of the table:
#
#   sbatch --array=1-$(kontur batch cases.csv --count) kontur-array.sh cases.csv
#
# Each task writes kontur-JOB_ROW.log beside the table. Sum up when the array has ended:
#
#   kontur batch cases.csv --collect --summary summary.json
#
#SBATCH --job-name=kontur
#SBATCH --cpus-per-task=4
#SBATCH --mem=4G
#SBATCH --time=00:30:00
#SBATCH --output=kontur-%A_%a.log
set -eu
kontur=${KONTUR:-kontur}
if ! command -v "$kontur" >/dev/null; then
    echo "$kontur is not on the node $(hostname); set KONTUR to its path before sbatch, on a disk that the nodes share" >&2
    exit 127
fi
exec "$kontur" batch "$1" --row "$SLURM_ARRAY_TASK_ID" --threads "${SLURM_CPUS_PER_TASK:-1}"
