// SPDX-License-Identifier: Apache-2.0
#include "launch/check/check.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/config/config_io.h"
#include "launch/check/loopback.h"
#include "launch/commands/commands.h"
#include "launch/commands/json_output.h"
#include "launch/record/machine.h"

namespace shoal::launch {
namespace {

int Check(const CheckRequest& request, const std::string& json) {
  const JsonOutput output(json);
  InstallStopSignals();
  const SteadyTime start = Now();
  const std::vector<CheckLine> lines = CheckMachine(request, [&](const CheckLine& line) {
    std::fputs(ToText(line).c_str(), output.text());
    std::fflush(output.text());
  });
  if (StopRequested()) {
    std::fputs("interrupted\n", output.text());
    return kInterruptedExit;
  }
  const double seconds = SecondsSince(start);
  output.Write(ToJson(lines, seconds, DescribeMachine()).dump(2) + "\n");
  const Verdict worst = Worst(lines);
  fmt::print(
      output.text(), "{} in {:.1f} s\n",
      worst == Verdict::kFail ? "this machine cannot train as it is" : "this machine can train",
      seconds);
  return worst == Verdict::kFail ? 1 : 0;
}

}  // namespace

void AddCheckCommand(CLI::App& app, Action* chosen) {
  CLI::App* command =
      app.add_subcommand("check",
                         "Check whether this machine can train: CPU, cores, rendering, physics, "
                         "transport, memory and disk space, and a short training loop; each line "
                         "is OK, WARN or FAIL. Exit code 1 if a line is FAIL.");
  const auto request = std::make_shared<CheckRequest>();
  const auto json = std::make_shared<std::string>();
  const auto run_dir = std::make_shared<std::string>("runs");
  const auto peer = std::make_shared<std::string>();
  command->add_option("--json", *json,
                      "Write the result as JSON to this file, which is replaced; - for standard "
                      "output (schema shoal-check-1)");
  command->add_option("--run-dir", *run_dir, "Folder that will hold the runs")
      ->capture_default_str();
  // Internal: the second process of the loopback measurement.
  command->add_option("--loopback-peer", *peer)->group("");
  command->callback([=] {
    *chosen = [=] {
      if (!peer->empty()) {
        InstallStopSignals();
        return RunLoopbackPeer(*peer, TransportConfig{});
      }
      request->run_dir = *run_dir;
      return Check(*request, *json);
    };
  });
}

}  // namespace shoal::launch
