// SPDX-License-Identifier: Apache-2.0
// Which arithmetic the networks' large products use.
#pragma once

#include <string>

namespace shoal::nn {

enum class Precision { kF32, kBf16 };

// "auto" -> bf16 for networks that see pixels where the CPU has it natively, else f32: without
// pixels bf16 is faster, too, but is asked for, as it rounds hidden layers. "bf16" on a CPU without
// it throws Error.
Precision ChoosePrecision(const std::string& asked, bool pixels);
const char* ToString(Precision precision);
// Sets the threads that networks use which the calling thread builds from now on.
void SetThreads(int threads);
// The instruction set that oneDNN found, e.g. "avx512_core_bf16", for meta.json.
std::string CpuIsa();

}  // namespace shoal::nn
