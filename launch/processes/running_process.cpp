// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/running_process.h"

namespace shoal::launch {
namespace {

class RunningChild final : public RunningProcess {
 public:
  explicit RunningChild(const ProcessSpec& spec) : child_(spec) {}
  pid_t pid() const override { return child_.pid(); }
  std::optional<ExitStatus> Poll() override { return child_.Poll(); }
  void Signal(int signal) override { child_.Signal(signal); }

 private:
  ChildProcess child_;
};

}  // namespace

std::unique_ptr<RunningProcess> StartChild(const ProcessSpec& spec) {
  return std::make_unique<RunningChild>(spec);
}

}  // namespace shoal::launch
