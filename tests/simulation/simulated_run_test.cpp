// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/simulated_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::simulation {
namespace {

using std::chrono::milliseconds;
using ::testing::IsEmpty;

const Blueprint& TheBlueprint() {
  static const Blueprint blueprint = MakeBlueprint();
  return blueprint;
}

// Runs a seed in a child process, which takes the memory of what it kills with it; returns what it
// says.
std::string InChild(const std::function<std::string()>& body) {
  const TemporaryFolder folder;
  const std::filesystem::path answer = folder.path() / "answer";
  TheBlueprint();
  const pid_t child = fork();
  if (child == 0) {
    WriteFileAtomically(answer, body());
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "the child died";
  return ReadFile(answer);
}

std::string Violations(uint64_t seed, const std::vector<Fault>& faults) {
  return InChild([&] {
    const TemporaryFolder folder;
    const Outcome outcome = Simulate(TheBlueprint(), seed, faults, folder.path() / "run");
    std::string text;
    for (const std::string& violation : outcome.violations) text += violation + "\n";
    if (text.empty()) return text;
    for (const Fault& fault : faults) text += fault.Text() + "\n";
    return text + outcome.log;
  });
}

std::string TraceOf(uint64_t seed) {
  return InChild([&] {
    const TemporaryFolder folder;
    const Outcome outcome = Simulate(
        TheBlueprint(), seed, DrawFaults(seed, TheBlueprint().run.config), folder.path() / "run");
    return std::to_string(outcome.trace) + " " + std::to_string(outcome.switches);
  });
}

TEST(SimulatedRun, ASeedRepeatsAndAnotherOneDiffers) {
  const std::string first = TraceOf(3);
  EXPECT_EQ(first, TraceOf(3));
  EXPECT_NE(first, TraceOf(4));
}

TEST(SimulatedRun, EachRoleIsKilledInTheMiddleOfARunAndNothingIsLostUncounted) {
  for (const char* process : {"replay-0", "learner-0", "eval-0", "actor-0", "actor-1"}) {
    const std::vector<Fault> kill{{.at = milliseconds(5000), .process = process}};
    EXPECT_THAT(Violations(1, kill), IsEmpty()) << process;
  }
}

TEST(SimulatedRun, FixedSeedsKeepWhatIsPromised) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    EXPECT_THAT(Violations(seed, DrawFaults(seed, TheBlueprint().run.config)), IsEmpty())
        << "shoal-simulate --seed " << seed << " --trace";
  }
}

}  // namespace
}  // namespace shoal::simulation
