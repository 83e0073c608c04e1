// SPDX-License-Identifier: Apache-2.0
// shoal-gpu-trial: compares a GPU with the host and measures rates of updates; a table on stderr,
// JSON (schema shoal-gpu-trial-1) on stdout. Exit code 1 if a row has not passed.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/base/build_info.h"
#include "common/base/command_line.h"
#include "common/base/main_guard.h"
#include "common/base/or_null.h"
#include "common/nn/precision.h"
#include "learner/device/card_loader.h"
#include "learner/device/host_device.h"
#include "learner/openmp_environment.h"
#include "tests/cuda/trial.h"

namespace {

using shoal::learner::device::Device;
using shoal::learner::device::DeviceInfo;
using shoal::trial::Row;
using shoal::trial::Trials;

// Null for "none".
std::unique_ptr<Device> OpenDevice(const std::string& name) {
  if (name == "none") return nullptr;
  if (name == "host") return std::make_unique<shoal::learner::device::HostDevice>();
  return std::unique_ptr<Device>(shoal::learner::OpenCard().reply.device);
}

int Run(int argc, char** argv) {
  std::string name = "cuda";
  shoal::trial::UpdateTrials what;
  double seconds = 3;
  std::string only;
  std::vector<std::string> parts{"commands", "updates", "rates"};
  CLI::App app("Compares a GPU with the host and measures rates of updates.", "shoal-gpu-trial");
  shoal::AddVersion(&app);
  app.add_option("--device", name,
                 "cuda; host: the device that tests use; none: updates of the CPU beside those of "
                 "the CPU with parameters that are changed by 1e-7, as rounding does")
      ->check(CLI::IsMember({"cuda", "host", "none"}));
  app.add_flag("--quick", what.quick, "small shapes and few updates");
  app.add_option("--seconds", seconds, "of each rate")->check(CLI::Range(0.1, 60.0));
  app.add_option("--part", parts, "commands, updates and rates")
      ->check(CLI::IsMember({"commands", "updates", "rates"}));
  app.add_option("--stretch", what.stretch,
                 "updates in a row, before the device gets the state of the CPU again")
      ->check(CLI::Range(1, 200));
  app.add_option("--only", only, "trials whose name contains this text");
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  shoal::nn::SetThreads(1);
  shoal::learner::EnsurePassiveOpenMp(1, argv);

  const std::unique_ptr<Device> device = OpenDevice(name);
  what.device = device.get();
  DeviceInfo info;
  if (device != nullptr) {
    info = device->info();
  } else {
    info.name = "the CPU";
    parts = {"updates"};
  }
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  bool passed = true;
  const auto show = [&](const Row& row) {
    std::cerr << fmt::format("{:<4}  {:<58} {:>12.4g} {}\n", row.passed ? "ok" : "FAIL", row.trial,
                             row.figure, row.unit);
    if (!row.fault.empty()) std::cerr << "      " << row.fault << "\n";
    rows.push_back({{"trial", row.trial},
                    {"figure", row.figure},
                    {"unit", row.unit},
                    {"limit", shoal::OrNull(row.limit)},
                    {"passed", row.passed}});
    if (!row.fault.empty()) rows.back()["fault"] = row.fault;
    passed = passed && row.passed;
  };
  std::cerr << fmt::format("{} {}\n", info.name,
                           info.driver.empty() ? "" : " (driver " + info.driver + ")");
  const Trials trials(only, show);
  const auto has = [&](const char* part) { return std::ranges::count(parts, part) > 0; };
  if (has("commands")) shoal::trial::TryCommands(device.get(), what.quick, trials);
  if (has("updates")) shoal::trial::TryUpdates(what, trials);
  if (has("rates")) shoal::trial::TimeUpdates(device.get(), what.quick, seconds, trials);
  const nlohmann::ordered_json object{{"schema", "shoal-gpu-trial-1"},
                                      {"commit", shoal::BuildCommit()},
                                      {"device", info.name},
                                      {"driver", info.driver},
                                      {"passed", passed},
                                      {"rows", rows}};
  std::cout << object.dump(2) << "\n";
  return passed ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-gpu-trial", [&] { return Run(argc, argv); });
}
