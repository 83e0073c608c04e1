// SPDX-License-Identifier: Apache-2.0
// Peak rate of one core in bf16: dot products of registers, without memory access. On CPUs with
// AMX, which oneDNN 2.6 and 3 use if available, the peak rate with AMX is higher.
#pragma once

namespace shoal::bench {

// Whether this CPU has the AVX-512 instruction for these dot products.
bool HasBf16Peak();

// Executes at least `operations` (multiplications and additions) with vdpbf16ps in this thread.
// CHECKs HasBf16Peak().
void RunAtBf16Peak(double operations);
// Like RunAtBf16Peak, with f32 multiply-adds of the same width.
void RunAtF32Peak(double operations);

}  // namespace shoal::bench
