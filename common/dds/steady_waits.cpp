// SPDX-License-Identifier: Apache-2.0
#include "common/dds/steady_waits.h"

#include <dlfcn.h>
#include <pthread.h>

#include "common/base/check.h"

namespace shoal::dds {

void RequireSteadyWaits() {
  LinkTimedWait();
#if !defined(__SANITIZE_THREAD__)
  Dl_info found{}, libc{};
  const bool known = dladdr(dlsym(RTLD_DEFAULT, "pthread_cond_timedwait"), &found) != 0 &&
                     dladdr(reinterpret_cast<const void*>(&pthread_cond_clockwait), &libc) != 0;
  CHECK(known && found.dli_fbase != libc.dli_fbase)
      << "the DDS library would wait by the wall clock";
#endif
}

}  // namespace shoal::dds
