// SPDX-License-Identifier: Apache-2.0
#include "learner/openmp_environment.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "common/base/error.h"
#include "common/base/program_file.h"

namespace shoal::learner {
namespace {

// Set before the program restarts itself, so that it restarts only once.
constexpr char kGuard[] = "SHOAL_OPENMP_SET";

}  // namespace

void EnsurePassiveOpenMp(int threads, char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv(kGuard) != nullptr) return;
  setenv(kGuard, "1", 1);
  setenv("OMP_WAIT_POLICY", "passive", 1);
  setenv("OMP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  execv(ProgramFile().c_str(), argv);
  throw RuntimeError("cannot start '{}' again: {}", argv[0], std::strerror(errno));
}

}  // namespace shoal::learner
