// SPDX-License-Identifier: Apache-2.0
// Peak rate of one core in bf16: dot products of registers, with nothing read or written.
// CPUs with AMX can do more by it; oneDNN 2.6 and 3 use it where it is.
#pragma once

namespace shoal::bench {

// Whether this CPU has AVX-512's instruction for them.
bool HasBf16Peak();

// Does at least `operations` (multiplications and additions) by vdpbf16ps in this thread. CHECKs
// HasBf16Peak().
void RunAtBf16Peak(double operations);
// The same by f32 multiply-adds of the same width.
void RunAtF32Peak(double operations);

}  // namespace shoal::bench
