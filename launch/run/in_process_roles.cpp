// SPDX-License-Identifier: Apache-2.0
#include "launch/run/in_process_roles.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "actor/evaluation/eval_actor.h"
#include "actor/loop/training_actor.h"
#include "actor/worlds/physics_library.h"
#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/main_guard.h"
#include "common/base/program_file.h"
#include "common/base/sleep.h"
#include "common/base/thread_group.h"
#include "common/base/usable_cores.h"
#include "common/config/learner_threads.h"
#include "common/config/run_files.h"
#include "common/link/run_topology.h"
#include "learner/learner_program.h"
#include "learner/openmp_environment.h"
#include "replay_server/service/replay_service.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;

constexpr seconds kEnd{60};  // time for a role's threads to end after a stop request
constexpr std::chrono::milliseconds kPoll{5};

// Threads cannot be killed individually, so the whole process ends, as if all roles were killed.
[[noreturn]] void EndProcess(const std::string& name) {
  std::fprintf(stderr,
               "shoal: error: %s does not end, and a role of one process (--in-process) cannot be "
               "killed alone: the run ends here; shoal train --resume goes on with it\n",
               name.c_str());
  std::_Exit(1);
}

// One role and its threads.
class RoleThreads final : public RunningProcess {
 public:
  RoleThreads(const ProcessSpec& spec, std::function<int()> body)
      : name_(spec.Name()),
        program_(std::filesystem::path(spec.command.at(0)).filename()),
        group_(name_, spec.output),
        body_(std::move(body)) {
    const ThreadGroup::Member member(&group_);
    thread_ = Thread([this] { Run(); });
  }
  ~RoleThreads() override {
    group_.RequestStop();
    const SteadyTime deadline = Now() + kEnd;
    while (!ended_ && Now() < deadline) SleepFor(kPoll);
    if (!ended_) EndProcess(name_);
    thread_.join();
  }
  RoleThreads(const RoleThreads&) = delete;
  RoleThreads& operator=(const RoleThreads&) = delete;

  pid_t pid() const override { return getpid(); }

  std::optional<ExitStatus> Poll() override {
    if (!ended_) return std::nullopt;
    return ExitStatus{.by_signal = false, .code = exit_code_};
  }

  void Signal(int signal) override {
    if (ended_) return;
    if (signal == SIGKILL) EndProcess(name_);
    group_.RequestStop();
  }

 private:
  void Run() {
    exit_code_ = GuardBody(program_, body_,
                           [this](const std::string& line) { log::WriteRaw(group_.log(), line); });
    ended_ = true;
  }

  const std::string name_, program_;
  ThreadGroup group_;
  const std::function<int()> body_;
  int exit_code_ = 0;  // valid once ended_
  std::atomic<bool> ended_{false};
  Thread thread_;  // last member: it uses the others
};

}  // namespace

InProcessRoles::InProcessRoles(const std::filesystem::path& folder, const Config& config)
    : folder_(folder), coordinator_(network_.Join(link::Role::kCoordinator)) {
  worlds::LoadTasks(config.task_library);
}

std::unique_ptr<RunningProcess> InProcessRoles::Start(const ProcessSpec& spec) {
  return std::make_unique<RoleThreads>(spec, [this, spec] { return Run(spec); });
}

int InProcessRoles::Run(const ProcessSpec& spec) {
  const std::optional<link::Role> role = link::FindRole(spec.role);
  CHECK(role.has_value()) << spec.role;
  const auto hub = network_.Join(*role);
  const link::RunProcess process{.role = *role, .index = static_cast<uint32_t>(spec.id)};
  switch (process.role) {
    case link::Role::kActor:
      return actor::TrainingActor(folder_, process.index, *hub).Run();
    case link::Role::kEval:
      return actor::EvalActor(folder_, *hub).Run();
    case link::Role::kReplay:
      return replay::ReplayService(folder_, process.Name(), *hub).Run();
    case link::Role::kLearner: {
      const RunConfig run = ReadRunConfig(folder_);
      const int threads = LearnerThreads(run.config, UsableCores());
      return learner::LearnerProgram(folder_, process.Name(), run, threads, *hub).Run();
    }
    case link::Role::kCoordinator:
    case link::Role::kClient:
      break;
  }
  CHECK(false) << spec.role << " is no child of the coordinator";
  return 1;
}

void PrepareForRolesInProcess() {
  setenv("LP_NUM_THREADS", "0", 1);  // no renderer threads: actors use all cores
  std::vector<std::string> words = ProgramWords();
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  learner::EnsurePassiveOpenMp(UsableCores(), arguments.data());
}

}  // namespace shoal::launch
