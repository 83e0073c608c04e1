// SPDX-License-Identifier: Apache-2.0
#include "common/base/build_info.h"

#include "shoal_build_commit.h"  // made at build time by common/cmake/build_commit.cmake

namespace shoal {

const char* BuildVersion() { return SHOAL_VERSION; }
const char* BuildCommit() { return SHOAL_BUILD_COMMIT; }

}  // namespace shoal
