// SPDX-License-Identifier: Apache-2.0
// A client and a coordinator's server, connected by a link in memory. Time is simulated, so that
// long deadlines do not delay tests.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/sleep.h"
#include "common/base/thread_group.h"
#include "common/link/local_network.h"
#include "launch/client/run_client.h"
#include "launch/run/run_server.h"
#include "tests/simulation/fiber_scheduler.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {

// Result of a command.
struct PlayedClient {
  int code = -1;
  std::string error;               // message of the Error that ended the command
  std::vector<std::string> lines;  // printed lines
  double seconds = -1;             // duration; below 0 if the command did not end in two hours
};

// A report with one metric.
inline MetricsMessage ReportOf(const std::string& role, uint32_t id, const std::string& name,
                               double value) {
  MetricsMessage report;
  report.role = role;
  report.id = id;
  report.state = "running";
  report.names = {name};
  report.values = {value};
  return report;
}

// A simulated coordinator: publishes views and replies to commands.
struct PlayedCoordinator {
  double uptime = 0;  // s, at the start
  bool accepts = true;
  std::string text = "done";  // text of the replies
  std::string state = "running";
  std::vector<MetricsMessage> processes{};  // reports in addition to the coordinator's own
  int commands = 0;                         // number of received commands

  // Answers commands and publishes views for the time `span`.
  void Serve(RunServer& server, std::chrono::milliseconds span) {
    const SteadyTime start = Now();
    while (Now() < start + span) {
      for (const CommandMessage& command : server.TakeCommands()) {
        ++commands;
        server.AddEvent("command: " + command.verb + ": " + text);
        server.Answer({.client = command.client,
                       .request = command.request,
                       .accepted = accepts,
                       .text = text});
      }
      if (server.Due(Now())) server.Show(View(uptime + SecondsSince(start)), Now());
      SleepFor(std::chrono::milliseconds(50));
    }
  }

 private:
  RunViewMessage View(double seconds) const {
    RunViewMessage view{.state = state};
    view.processes = processes;
    view.processes.push_back(ReportOf("coordinator", 0, "uptime_seconds", seconds));
    return view;
  }
};

// Runs `command` as a client of the simulated coordinator.
inline PlayedClient PlayClient(
    const std::function<void(RunServer&)>& coordinator,
    const std::function<int(RunClient&, const std::function<void(const std::string&)>&)>& command) {
  const TemporaryFolder folder;
  PlayedClient played;
  simulation::FiberScheduler scheduler(/*seed=*/1, /*wall_time_ns=*/0);
  ThreadGroup group("client", folder.path() / "log");
  link::LocalNetwork network;
  scheduler.StartIn(&group, [&] {
    const auto server_hub = network.Join(link::Role::kCoordinator);
    const auto client_hub = network.Join(link::Role::kClient);
    Thread serving([&] {
      RunServer server(*server_hub, "run");
      coordinator(server);
    });
    {
      RunClient client(*client_hub, {.name = "run", .coordinator = "here:1"}, /*id=*/7);
      const SteadyTime start = Now();
      try {
        played.code =
            command(client, [&](const std::string& line) { played.lines.push_back(line); });
      } catch (const Error& error) {
        played.code = error.exit_code();
        played.error = error.what();
      }
      played.seconds = SecondsSince(start);
    }
    serving.join();
  });
  scheduler.RunUntil(SteadyTime() + std::chrono::hours(2));
  return played;
}

}  // namespace shoal::launch
