#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# compile_kernels.sh FOLDER: compiles every kernel of learner/device/kernels with nvcc, for the cards
# of compute capability 8.0 and 9.0 and as PTX for later ones. Prints registers, shared memory and
# spills of each kernel for 9.0; fails if nvcc warns or a kernel spills. FOLDER receives the output.
# Environment: NVCC, the compiler. Exit code 77: there is no nvcc.
set -euo pipefail

folder=${1:?usage: compile_kernels.sh FOLDER}
root=$(cd "$(dirname "$0")/../.." && pwd)
nvcc=${NVCC:-$(command -v nvcc || ls /usr/local/cuda/bin/nvcc 2>/dev/null || true)}
if [[ -z $nvcc ]]; then
  echo "skipped: nvcc was not found in PATH or /usr/local/cuda/bin; set NVCC to its path"
  exit 77
fi

mkdir -p "$folder"
cat > "$folder/all_kernels.cu" <<'SOURCE'
#include "learner/device/kernels/kernels.h"
#include "learner/device/kernels/launch.cuh"

void LaunchAny(const shoal::learner::kernels::Kernel& kernel, cudaStream_t stream) {
  std::visit([&](const auto& one) { shoal::learner::kernels::LaunchOnCard(one, stream); }, kernel);
}
SOURCE

log=$folder/ptxas.txt
if ! "$nvcc" -std=c++20 -O3 -I"$root" -Werror all-warnings -Xptxas -v \
  -gencode arch=compute_80,code=sm_80 -gencode arch=compute_90,code=sm_90 \
  -gencode arch=compute_90,code=compute_90 \
  -c "$folder/all_kernels.cu" -o "$folder/all_kernels.o" > "$log" 2>&1; then
  cat "$log"
  exit 1
fi

# ptxas prints, for each kernel: its mangled name and target, its stack and spills, its registers.
awk '
  /Compiling entry function/ {
    name = $0; sub(/.*RunKernelI/, "", name); sub(/EEvT_.*/, "", name)
    sub(/^NS1_[0-9]+/, "", name); sub(/E$/, "", name); target = $0
  }
  /bytes spill stores/ { stack = $1; spills = $5 + $9 }
  /Used [0-9]+ registers/ && target ~ /sm_90/ {
    shared = 0; if (match($0, /[0-9]+ bytes smem/)) shared = substr($0, RSTART, RLENGTH) + 0
    match($0, /Used [0-9]+/); registers = substr($0, RSTART + 5, RLENGTH - 5)
    printf "%-28s %3d registers %6d bytes shared %5d bytes stack %4d bytes spilled\n",
           name, registers, shared, stack, spills
    ++kernels; spilled += spills
  }
  END {
    printf "%d kernels, %d bytes spilled\n", kernels, spilled
    if (kernels == 0) { print "ptxas reported no kernel"; exit 1 }
    if (spilled > 0) { print "expected no spills"; exit 1 }
  }' "$log"
