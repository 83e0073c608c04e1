// SPDX-License-Identifier: Apache-2.0
#include <malloc.h>

#include "common/dds/bus.h"

namespace shoal::dds {

void TuneMalloc() {
  // By default every megabyte sample is a fresh mmap, and a receiver spends most time in page
  // faults.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_TOP_PAD, 64 << 20);
}

}  // namespace shoal::dds
