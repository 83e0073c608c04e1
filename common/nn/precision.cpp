#include "common/nn/precision.h"

#include <dnnl.hpp>

#include "common/base/error.h"

namespace shoal::nn {
namespace {

// avx512_core emulates bf16 products with f32 ones; only these have the instructions.
bool HasNativeBf16() {
  switch (dnnl::get_effective_cpu_isa()) {
    case dnnl::cpu_isa::avx512_core_bf16:
    case dnnl::cpu_isa::avx512_core_amx:
      return true;
    default:
      return false;
  }
}

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

const char* ToString(Precision precision) { return precision == Precision::kBf16 ? "bf16" : "f32"; }

std::string CpuIsa() {
  switch (dnnl::get_effective_cpu_isa()) {
    case dnnl::cpu_isa::sse41:
      return "sse41";
    case dnnl::cpu_isa::avx:
      return "avx";
    case dnnl::cpu_isa::avx2:
      return "avx2";
    case dnnl::cpu_isa::avx2_vnni:
      return "avx2_vnni";
    case dnnl::cpu_isa::avx512_core:
      return "avx512_core";
    case dnnl::cpu_isa::avx512_core_vnni:
      return "avx512_core_vnni";
    case dnnl::cpu_isa::avx512_core_bf16:
      return "avx512_core_bf16";
    case dnnl::cpu_isa::avx512_core_amx:
      return "avx512_core_amx";
    default:
      return "generic";
  }
}

}  // namespace shoal::nn
