// SPDX-License-Identifier: Apache-2.0
#define SHOAL_LANES 16
#include "actor/worlds/native/output_kernels.h"
#include "actor/worlds/native/shading_kernels.h"
#include "actor/worlds/native/sky_kernels.h"
#include "actor/worlds/native/visibility_kernels.h"

namespace shoal::worlds::native {

const Kernels kAvx512Kernels{"avx512", SHOAL_LANES, Clear, See,      SeeOver,
                             Shade,    Blend,       Sky,   DrawHaze, Write};

}  // namespace shoal::worlds::native
