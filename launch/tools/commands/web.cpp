// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "launch/commands/target_options.h"
#include "launch/tools/commands/commands.h"
#include "launch/tools/web/web_server.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::milliseconds kLook{100};  // interval between checks for stop signals
constexpr int kLooksToTend = 20;

int Web(const WebOptions& options) {
  if (!IsAddress(options.listen.address)) {
    throw UsageError("--address {}: expected an IPv4 address of this host, such as 127.0.0.1",
                     options.listen.address);
  }
  InstallStopSignals();
  WebServer server(options);
  fmt::print("{} at {}\n",
             options.run.empty() ? fmt::format("the runs of '{}'", options.run_dir)
                                 : fmt::format("run '{}'", options.run),
             server.Url());
  fmt::print("{}\n", options.listen.Loopback()
                         ? "without the token, the page only shows runs, and only on this host; "
                           "Ctrl-C ends the server"
                         : "everyone with this address can watch and steer, and the network can "
                           "read the traffic; Ctrl-C ends the server");
  std::fflush(stdout);
  for (int looks = 1; !StopRequested(); ++looks) {
    std::this_thread::sleep_for(kLook);
    if (looks % kLooksToTend == 0) server.Tend();
  }
  return 0;
}

}  // namespace

void AddWebCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "web",
      "Serve a web page that shows runs: states, curves, processes, films; with the token of the "
      "printed address it can also set, scale and stop them. Needs libjs-dygraphs.");
  const auto options = std::make_shared<WebOptions>();
  options->listen.port = 8470;
  AddRunOption(*command, &options->run, &options->run_dir,
               "Name or folder of the run to show; default: all runs of --run-dir");
  command->add_option(
      "--secure", options->secure,
      "Folder of credentials of secured runs; default: the folder that each run was started with");
  command
      ->add_option(
          "--address", options->listen.address,
          "IPv4 address of this host to listen on; other addresses than loopback require the token")
      ->capture_default_str();
  command->add_option("--port", options->listen.port, "Port to listen on; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->callback([=] { *chosen = [=] { return Web(*options); }; });
}

}  // namespace shoal::launch
