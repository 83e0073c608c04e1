// SPDX-License-Identifier: Apache-2.0
// Peak rate of one core in bf16: dot products of registers, without memory access. CPUs with AMX
// reach more with AMX, which oneDNN 2.6 and 3 use if available.
#pragma once

namespace shoal::bench {

// Whether this CPU has the AVX-512 instruction for these dot products.
bool HasBf16Peak();

// Does at least `operations` (multiplications and additions) by vdpbf16ps in this thread. CHECKs
// HasBf16Peak().
void RunAtBf16Peak(double operations);
// The same with f32 multiply-adds of the same width.
void RunAtF32Peak(double operations);

}  // namespace shoal::bench
