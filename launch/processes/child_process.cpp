// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/child_process.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/pipe.h"
#include "common/base/sleep.h"
#include "launch/processes/suspension.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTerminate{5000};  // between SIGTERM and SIGKILL
// After SIGKILL a child survives longer only in uninterruptible I/O; init reaps it then.
constexpr milliseconds kReap{5000};

Descriptor OpenForReading(const std::filesystem::path& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd >= 0) return Descriptor(fd);
  throw RuntimeError("cannot read '{}': {}", path.string(), std::strerror(errno));
}

Descriptor OpenForAppending(const std::filesystem::path& path) {
  return OpenRegular(path, O_WRONLY | O_CREAT | O_APPEND);
}

// Standard input of the child. If the input is a pipe, `held` receives the parent's end.
Descriptor OpenInput(const ProcessSpec& spec, Descriptor* held) {
  if (!spec.holds_input) return OpenForReading(spec.input.empty() ? "/dev/null" : spec.input);
  Pipe pipe;
  *held = std::move(pipe.write);
  return std::move(pipe.read);
}

// This process's environment with additions, as NAME=VALUE.
std::vector<std::string> Environment(
    const std::vector<std::pair<std::string, std::string>>& additions) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    bool replaced = false;
    for (const auto& [name, value] : additions) {
      replaced |= text.starts_with(name) && text.substr(name.size()).starts_with('=');
    }
    if (!replaced) all.emplace_back(text);
  }
  for (const auto& [name, value] : additions) all.push_back(fmt::format("{}={}", name, value));
  return all;
}

std::vector<char*> Pointers(std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  pointers.reserve(strings.size() + 1);
  for (std::string& s : strings) pointers.push_back(s.data());
  pointers.push_back(nullptr);
  return pointers;
}

// Data for the child between fork and exec, where memory must not be allocated.
struct ExecPlan {
  char* const* argv;
  char* const* envp;
  int input, output, errors, report;
  pid_t parent;
  bool outlives_parent;
  const cpu_set_t* cores;  // null: all cores of the parent
};

// Sends errno to the parent: the program was not started.
[[noreturn]] void Report(int pipe) {
  const int error = errno;
  [[maybe_unused]] const ssize_t n = write(pipe, &error, sizeof error);
  _exit(127);
}

[[noreturn]] void ExecChild(const ExecPlan& plan) {
  if (!plan.outlives_parent) {
    prctl(PR_SET_PDEATHSIG, SIGHUP);
    if (getppid() != plan.parent) _exit(1);  // the parent died before prctl
  }
  setpgid(0, 0);
  if (plan.cores != nullptr && sched_setaffinity(0, sizeof *plan.cores, plan.cores) != 0) {
    Report(plan.report);
  }
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);  // ignored signals survive exec
  signal(SIGHUP, SIG_DFL);   // sent when the parent dies; nohup would ignore it
  dup2(plan.input, STDIN_FILENO);
  dup2(plan.output, STDOUT_FILENO);
  dup2(plan.errors, STDERR_FILENO);
  execve(plan.argv[0], plan.argv, plan.envp);
  Report(plan.report);
}

}  // namespace

std::string ExitStatus::Describe() const {
  if (!by_signal) return fmt::format("exit code {}", code);
  const char* name = sigabbrev_np(code);
  return name ? fmt::format("killed by SIG{}", name) : fmt::format("killed by signal {}", code);
}

ChildProcess::ChildProcess(const ProcessSpec& spec) {
  std::vector<std::string> command = spec.command;
  std::vector<std::string> environment = Environment(spec.environment);
  const std::vector<char*> argv = Pointers(command), envp = Pointers(environment);
  const Descriptor input = OpenInput(spec, &held_input_);
  const Descriptor output = OpenForAppending(spec.output);
  const Descriptor errors = OpenForAppending(spec.errors.empty() ? spec.output : spec.errors);
  Pipe report;  // closed by a successful exec; carries errno of a failed one

  cpu_set_t cores;
  CPU_ZERO(&cores);
  for (const int core : spec.cores) CPU_SET(static_cast<size_t>(core), &cores);
  const ExecPlan plan{argv.data(),  envp.data(),          input.get(),
                      output.get(), errors.get(),         report.write.get(),
                      getpid(),     spec.outlives_parent, spec.cores.empty() ? nullptr : &cores};
  pid_ = fork();
  if (pid_ < 0) throw RuntimeError("cannot start {}: {}", spec.command[0], std::strerror(errno));
  if (pid_ == 0) ExecChild(plan);
  AddSuspended(pid_);
  report.write.Close();
  int error = 0;
  if (read(report.read.get(), &error, sizeof error) == static_cast<ssize_t>(sizeof error)) {
    KillAndReap();
    throw RuntimeError("cannot start '{}': {}", spec.command[0], std::strerror(error));
  }
}

ChildProcess::~ChildProcess() { KillAndReap(); }

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      held_input_(std::move(other.held_input_)),
      ended_(other.ended_) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this == &other) return *this;
  KillAndReap();
  pid_ = std::exchange(other.pid_, -1);
  held_input_ = std::move(other.held_input_);
  ended_ = other.ended_;
  return *this;
}

std::optional<ExitStatus> ChildProcess::Poll() {
  siginfo_t end{};
  if (ended_ || waitid(P_PID, static_cast<id_t>(pid_), &end, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      end.si_pid != pid_) {
    return ended_;
  }
  RemoveSuspended(pid_);  // before waitpid frees the pid
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return ended_;
  const bool by_signal = WIFSIGNALED(status);
  ended_ = ExitStatus{by_signal, by_signal ? WTERMSIG(status) : WEXITSTATUS(status)};
  return ended_;
}

void ChildProcess::Signal(int signal) {
  if (!Poll()) kill(pid_, signal);
}

void ChildProcess::KillAndReap() {
  if (pid_ < 0 || ended_) return;
  kill(pid_, SIGKILL);
  const SteadyTime deadline = Now() + kReap;
  while (!Poll() && Now() < deadline) SleepFor(milliseconds(1));
  if (ended_) return;
  RemoveSuspended(pid_);
  ended_ = ExitStatus{true, SIGKILL};
}

std::optional<ExitStatus> RunToEnd(const ProcessSpec& spec, std::chrono::seconds deadline,
                                   const std::function<bool()>& stop) {
  constexpr milliseconds kPoll{100};
  ChildProcess child(spec);
  const SteadyTime start = AwakeNow();
  std::optional<SteadyTime> terminated;
  while (true) {
    if (const auto status = child.Poll()) {
      return terminated ? std::nullopt : status;
    }
    if (!terminated && (AwakeNow() - start > deadline || stop())) {
      child.Signal(SIGTERM);
      terminated = AwakeNow();
    }
    if (terminated && AwakeNow() - *terminated > kTerminate) return std::nullopt;  // then killed
    SleepFor(kPoll);
  }
}

Error ProgramError(const std::string& program, const ExitStatus& status,
                   const std::filesystem::path& errors) {
  std::string line = LastLine(errors);
  const std::string prefix = program + ": error: ";
  if (line.starts_with(prefix)) line.erase(0, prefix.size());
  if (line.empty() || status.by_signal) line = fmt::format("{}: {}", status.Describe(), line);
  const bool usage = !status.by_signal && status.code == 2;
  return Error(usage ? ErrorKind::kUsage : ErrorKind::kRuntime,
               fmt::format("{}: {}", program, line));
}

std::string LastLine(const std::filesystem::path& file) {
  constexpr std::streamoff kTail = 4096;
  std::ifstream in(file, std::ios::binary);
  if (!in) return "";
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  in.seekg(size > kTail ? size - kTail : 0);
  std::string line, last;
  while (std::getline(in, line)) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last;
}

}  // namespace shoal::launch
