#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# One case of a cohort per task of a Slurm job array. Submit it for all rows of the table:
#
#   sbatch --array=1-$(kontur batch cases.csv --count) kontur-array.sh cases.csv
#
# and sum up when the array has ended:
#
#   kontur batch cases.csv --collect --summary summary.json
#
#SBATCH --job-name=kontur
#SBATCH --cpus-per-task=4
#SBATCH --mem=4G
#SBATCH --time=00:30:00
#SBATCH --output=/dev/null
set -eu
exec "${KONTUR:-kontur}" batch "$1" --row "$SLURM_ARRAY_TASK_ID" --threads "${SLURM_CPUS_PER_TASK:-1}"
