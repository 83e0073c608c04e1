// SPDX-License-Identifier: Apache-2.0
#include "common/base/openmp_binding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "common/base/usable_cores.h"

extern "C" int omp_get_max_threads(void);

namespace shoal {
namespace {

constexpr char kSecondStart[] = "SHOAL_TEST_SECOND_START";

int CoresOfMask() {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  return CPU_COUNT(&set);
}

// Starts this program again, to run the test SecondStart with the variable and on `core`, unless
// that is negative. Returns its exit code.
int StartWith(const std::string& variable, const std::string& expected_cores, int core = -1) {
  const pid_t child = fork();
  if (child == 0) {
    const size_t equals = variable.find('=');
    setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
    setenv(kSecondStart, (expected_cores + " " + variable).c_str(), 1);
    if (core >= 0) {
      cpu_set_t set;
      CPU_ZERO(&set);
      CPU_SET(static_cast<size_t>(core), &set);
      sched_setaffinity(0, sizeof set, &set);
    }
    execl("/proc/self/exe", "test", "--gtest_filter=OpenMpBinding.SecondStart", nullptr);
    _exit(99);
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int FirstCore() {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  int core = 0;
  while (core + 1 < CPU_SETSIZE && !CPU_ISSET(static_cast<size_t>(core), &set)) ++core;
  return core;
}

// Runs in the programs that the other tests start.
TEST(OpenMpBinding, SecondStart) {
  const char* order = std::getenv(kSecondStart);
  if (order == nullptr) GTEST_SKIP() << "only as a program that another test starts";
  const std::string text = order, variable = text.substr(text.find(' ') + 1);
  EXPECT_EQ(std::to_string(CoresOfMask()), text.substr(0, text.find(' ')));
  EXPECT_GE(omp_get_max_threads(), 1) << "libgomp is loaded";
  EXPECT_THAT(IgnoredOpenMpBindings(), testing::ElementsAre(variable));
  const std::string name = variable.substr(0, variable.find('='));
  EXPECT_EQ(std::getenv(name.c_str()), nullptr) << "programs started from here would obey it";
  EXPECT_NE(std::getenv("PATH"), nullptr) << "other variables stay";
  if (CoresOfMask() == 1) {
    EXPECT_THAT(DescribeLimits({.online = 2, .affinity = 1, .quota = 2}),
                testing::HasSubstr("which " + variable + " may have bound"));
  }
}

TEST(OpenMpBinding, AProgramKeepsItsMaskWhateverOpenMpIsToldToBind) {
  if (CoresOfMask() < 2) GTEST_SKIP() << "needs two cores";
  const std::string cores = std::to_string(CoresOfMask());
  for (const char* variable : {"OMP_PROC_BIND=true", "OMP_PROC_BIND=close", "OMP_PROC_BIND=spread",
                               "OMP_PLACES=cores", "OMP_PLACES={0}", "GOMP_CPU_AFFINITY=0",
                               "KMP_AFFINITY=compact", "OMP_PROC_BIND_ALL=true"}) {
    EXPECT_EQ(StartWith(variable, cores), 0) << variable;
  }
}

TEST(OpenMpBinding, AMaskThatTheUserSetIsKept) {
  EXPECT_EQ(StartWith("OMP_PROC_BIND=true", "1", FirstCore()), 0);
}

}  // namespace
}  // namespace shoal
