// SPDX-License-Identifier: Apache-2.0
// Number type of the networks' large matrix products.
#pragma once

#include <string>

namespace shoal::nn {

enum class Precision { kF32, kBf16 };

// Returns the precision for the configured word `asked`. "auto" is bf16 for networks with pixels on
// a CPU with native bf16, else f32. Without pixels bf16 is faster too, but it rounds hidden layers,
// so it must be configured explicitly. Throws Error for "bf16" on a CPU without bf16.
Precision ChoosePrecision(const std::string& asked, bool pixels);
// The same for networks on a GPU, which has bf16.
Precision ChooseGpuPrecision(const std::string& asked, bool pixels);
const char* ToString(Precision precision);
// Sets the number of threads of networks that the calling thread builds from now on.
void SetThreads(int threads);
// The instruction set that oneDNN detected, e.g. "avx512_core_bf16", for meta.json.
std::string CpuIsa();

}  // namespace shoal::nn
