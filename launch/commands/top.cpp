// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <utility>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "launch/client/run_connection.h"
#include "launch/commands/commands.h"
#include "launch/commands/target_options.h"
#include "launch/watch/live_terminal.h"
#include "launch/watch/run_metrics.h"
#include "launch/watch/terminal_block.h"
#include "launch/watch/top_table.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

struct TopOptions {
  TargetOptions target;
  bool once = false, json = false, describe = false;
};

constexpr milliseconds kKeys{100};   // interval of keyboard polls
constexpr seconds kCoordinator{10};  // liveness timeout: no view for this long
constexpr char kSilent[] = "the run's coordinator is silent: it has ended, or is paused (Ctrl-Z)";

bool Ended(const RunViewMessage& view) { return view.state == "ended"; }

void Print(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

// The run shown, and its display settings.
struct Watched {
  RunViewMessage view;
  TopOrder order{};
  TopWidths widths{};
  bool help = false;  // show the keys instead of the table
};

// Handles a key. Returns false to quit.
bool OnKey(char key, Watched* watched) {
  TopOrder& order = watched->order;
  watched->help = !watched->help && (key == 'h' || key == '?');
  if (key == 'q' || key == 'Q') return false;
  if (key == 's') order.column = (order.column + 1) % TopColumns();
  if (key == 'S') order.column = (order.column + TopColumns() - 1) % TopColumns();
  if (key == 'r') order.reversed = !order.reversed;
  return true;
}

std::vector<std::string> HelpScreen() {
  std::vector<std::string> lines{"s, S  sort by the next, previous column: the one with a *",
                                 "r     reverse the order", "q     quit; any other key: back", ""};
  for (std::string& line : DescribeTopColumns()) lines.push_back(std::move(line));
  return lines;
}

std::vector<std::string> Screen(Watched* watched) {
  const int width = SizeOfTerminal().columns - 1;
  const TopOrder& order = watched->order;
  std::vector<std::string> lines =
      watched->help ? HelpScreen() : FormatTop(watched->view, order, width, &watched->widths);
  if (!watched->help) {
    lines.insert(
        lines.begin(),
        fmt::format("s, S: sort by another column (now {}{}); r: reverse; h: help; q: quit",
                    TopColumnName(order.column), order.reversed ? ", reversed" : ""));
  }
  for (std::string& line : lines) line = CutToColumns(std::move(line), static_cast<size_t>(width));
  return lines;
}

// Shows a live table until a quit key, a signal or the run's end. Returns the last view.
RunViewMessage ShowLive(RunClient& client, RunViewMessage view) {
  LiveTerminal terminal;
  Watched watched{.view = std::move(view)};
  SteadyTime heard = Now();
  TerminalSize size = SizeOfTerminal();
  terminal.Draw(Screen(&watched));
  while (!StopRequested() && !Ended(watched.view)) {
    const auto key = terminal.WaitForKey(kKeys);
    if (key == LiveTerminal::kSuspendKey) {
      terminal.Suspend();
      heard = Now();
    } else if (key && !OnKey(*key, &watched)) {
      break;
    }
    const auto fresh = client.WaitForView(Now());
    if (fresh) {
      watched.view = *fresh;
      heard = Now();
    }
    const bool resized = std::exchange(size, SizeOfTerminal()) != size;
    if (key || fresh || resized) terminal.Draw(Screen(&watched));
    if (Now() - heard > kCoordinator) throw RuntimeError("{}", kSilent);
  }
  return watched.view;
}

// Prints one line per second until a signal or the run's end.
void ShowLines(RunClient& client, RunViewMessage view) {
  Print({FormatTopLine(view)});
  while (!StopRequested() && !Ended(view)) {
    const auto fresh = client.WaitForView(Now() + kCoordinator);
    if (StopRequested()) return;
    if (!fresh) throw RuntimeError("{}", kSilent);
    view = *fresh;
    Print({FormatTopLine(view)});
  }
}

int Top(const TopOptions& options) {
  if (options.describe) {
    Print({DescribeMetrics(RunMetrics())});
    return 0;
  }
  if (options.json && !options.once) throw UsageError("--json goes with --once");
  InstallStopSignals();
  RunConnection connection(ResolveTarget(options.target));
  RunClient& client = connection.client();
  const RunViewMessage view = client.FirstView();
  if (options.json) {
    Print({TopJson(view)});
  } else if (options.once) {
    const int width = isatty(STDOUT_FILENO) == 1 ? SizeOfTerminal().columns : 0;
    Print(FormatTop(view, TopOrder(), width));
  } else if (DrawsInPlace()) {
    const RunViewMessage last = ShowLive(client, view);
    if (Ended(last)) Print({FormatTopLine(last)});  // the table's screen has been left
  } else {
    ShowLines(client, view);
  }
  return 0;
}

}  // namespace

void AddTopCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "top", "Watch a running run: every process with its rates, queues, waits and memory.");
  const auto options = std::make_shared<TopOptions>();
  AddTargetOptions(*command, &options->target);
  command->add_flag("--once", options->once, "Show one table and exit");
  command->add_flag("--json", options->json, "With --once: JSON (schema shoal-top-1)");
  command->add_flag("--describe", options->describe, "Print a table of all metrics and exit");
  command->callback([=] { *chosen = [=] { return Top(*options); }; });
}

}  // namespace shoal::launch
