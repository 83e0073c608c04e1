// SPDX-License-Identifier: Apache-2.0
#include "common/nn/precision.h"

#include <dnnl.hpp>
#include <utility>

#include "common/base/error.h"

namespace shoal::nn {
namespace {

// Whether this CPU has all instructions of `isa`. oneDNN represents an instruction set by a set of
// bits, and newer sets contain those named here.
bool Has(dnnl::cpu_isa isa) {
  const auto bits = static_cast<unsigned>(isa);
  return (static_cast<unsigned>(dnnl::get_effective_cpu_isa()) & bits) == bits;
}

// CPUs with avx512_core alone emulate bf16 products with f32 products.
bool HasNativeBf16() { return Has(dnnl::cpu_isa::avx512_core_bf16); }

}  // namespace

Precision ChoosePrecision(const std::string& asked, bool pixels) {
  if (asked == "f32") return Precision::kF32;
  if (asked == "auto") return pixels && HasNativeBf16() ? Precision::kBf16 : Precision::kF32;
  if (asked != "bf16") throw UsageError("precision '{}': expected auto, f32 or bf16", asked);
  if (!HasNativeBf16()) {
    throw UsageError("precision bf16: this CPU ({}) has no bf16 arithmetic; use auto or f32",
                     CpuIsa());
  }
  return Precision::kBf16;
}

Precision ChooseGpuPrecision(const std::string& asked, bool pixels) {
  if (asked == "auto") return pixels ? Precision::kBf16 : Precision::kF32;
  return asked == "bf16" ? Precision::kBf16 : Precision::kF32;
}

const char* ToString(Precision precision) { return precision == Precision::kBf16 ? "bf16" : "f32"; }

std::string CpuIsa() {
  using enum dnnl::cpu_isa;
  constexpr std::pair<dnnl::cpu_isa, const char*> kNames[] = {
      {avx512_core_amx, "avx512_core_amx"},
      {avx512_core_bf16, "avx512_core_bf16"},
      {avx512_core_vnni, "avx512_core_vnni"},
      {avx512_core, "avx512_core"},
      {avx2_vnni, "avx2_vnni"},
      {avx2, "avx2"},
      {avx, "avx"},
      {sse41, "sse41"},
  };
  for (const auto& [isa, name] : kNames) {
    if (Has(isa)) return name;
  }
  return "generic";
}

}  // namespace shoal::nn
