// SPDX-License-Identifier: Apache-2.0
// shoal-soak: kills or stops a training run's processes at random times and checks that no record
// is lost and no file or process is left; or runs undisturbed and checks that no resource grows.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "common/base/command_line.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "launch/processes/process_plan.h"
#include "tests/soak/fault_soak.h"
#include "tests/soak/run_under_test.h"
#include "tests/soak/steady_soak.h"
#include "tests/support/processes.h"

namespace {

struct Options {
  int faults = 10;
  double steady_minutes = 0;
  shoal::soak::SoakOptions soak;
  std::string json;
};

// An interrupted soak: its run's processes, which this one has adopted, and its files go away.
void LeaveNothing(const std::filesystem::path& folder) {
  for (const pid_t pid : shoal::ChildrenOf(getpid())) kill(pid, SIGKILL);
  while (waitpid(-1, nullptr, 0) > 0) {
  }
  std::filesystem::remove_all(folder);
}

// A steady soak lists what grows instead of stopping at the first figure.
void CheckNothingIsBroken(const nlohmann::ordered_json& result) {
  std::string lines;
  for (const auto& line : result.value("broken", nlohmann::ordered_json::array())) {
    lines += (lines.empty() ? "" : "; ") + line.get<std::string>();
  }
  if (!lines.empty()) throw shoal::soak::Broken(lines);
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app("Strikes a training run's processes at random moments, or watches it for leaks.",
               "shoal-soak");
  shoal::AddVersion(&app);
  app.add_option("--faults", options.faults, "SIGKILLs and ten-second SIGSTOPs")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--steady", options.steady_minutes,
                 "instead of faults, leave the run alone for so many minutes and look for trends")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", options.soak.seed, "of victims and moments")->capture_default_str();
  app.add_option("--actors", options.soak.actors, "actor processes")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--preset", options.soak.preset, "of the run, e.g. fetch-reach-her")
      ->capture_default_str();
  app.add_option("--env", options.soak.environment,
                 "environment of Python to train on, e.g. Pendulum-v1, by the preset");
  app.add_option("--set", options.soak.keys, "KEY=VALUE of the run; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--recovery", options.soak.recovery,
                 "seconds within which everything must go on; more on a busy machine")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--kills-alone", options.soak.kills_alone, "no SIGSTOPs");
  app.add_option("--json", options.json, "file for the result, which standard output gets, too");
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  prctl(PR_SET_CHILD_SUBREAPER, 1);  // this process adopts leftover processes of a run
  options.soak.programs = shoal::launch::ProgramFolder();
  shoal::InstallStopSignals();
  options.soak.folder = shoal::MakeFreshFolder("shoal-soak-");
  try {
    const auto result = options.steady_minutes > 0
                            ? shoal::soak::SoakSteadily(options.soak, options.steady_minutes)
                            : shoal::soak::SoakFaults(options.soak, options.faults);
    fmt::print("{}\n", result.dump(2));
    if (!options.json.empty() && options.json != "-")
      shoal::WriteFileAtomically(options.json, result.dump(2) + "\n");
    CheckNothingIsBroken(result);
  } catch (const shoal::soak::Broken& e) {
    throw shoal::RuntimeError("{} (seed {}; files kept in '{}')", e.what(), options.soak.seed,
                              options.soak.folder.string());
  } catch (const shoal::Error&) {
    if (shoal::StopRequested()) LeaveNothing(options.soak.folder);
    throw;
  }
  std::filesystem::remove_all(options.soak.folder);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-soak", [&] { return Run(argc, argv); });
}
