#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "launch/commands/commands.h"
#include "launch/commands/target_options.h"
#include "launch/watch/live_terminal.h"
#include "launch/watch/run_client.h"
#include "launch/watch/run_metrics.h"
#include "launch/watch/top_table.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

struct TopOptions {
  TargetOptions target;
  bool once = false, json = false, describe = false;
};

constexpr milliseconds kKeys{100};   // between looks at the keyboard
constexpr seconds kCoordinator{10};  // without a view: it is gone

bool Ended(const RunViewMessage& view) { return view.state == "ended"; }

void Print(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

// What a key does to the order; false: quit.
bool OnKey(char key, TopOrder* order) {
  if (key == 'q' || key == 'Q') return false;
  if (key == 's') order->column = (order->column + 1) % TopColumns();
  if (key == 'S') order->column = (order->column + TopColumns() - 1) % TopColumns();
  if (key == 'r') order->reversed = !order->reversed;
  return true;
}

std::vector<std::string> Screen(const RunViewMessage& view, const TopOrder& order) {
  std::vector<std::string> lines = FormatTop(view, order, SizeOfTerminal().columns - 1);
  lines.insert(lines.begin(),
               fmt::format("s, S: sort by another column (now {}{}); r: reverse; q: quit",
                           TopColumnName(order.column), order.reversed ? ", reversed" : ""));
  return lines;
}

// A live table until a key, a signal or the run's end.
void ShowLive(RunClient& client, RunViewMessage view) {
  LiveTerminal terminal;
  TopOrder order;
  SteadyTime heard = Now();
  terminal.Draw(Screen(view, order));
  while (!StopRequested() && !Ended(view)) {
    const auto key = terminal.WaitForKey(kKeys);
    if (key && !OnKey(*key, &order)) return;
    const auto fresh = client.WaitForView(Now());
    if (fresh) {
      view = *fresh;
      heard = Now();
    }
    if (key || fresh) terminal.Draw(Screen(view, order));
    if (Now() - heard > kCoordinator) throw RuntimeError("the run's coordinator is silent");
  }
}

// A line a second until a signal or the run's end.
void ShowLines(RunClient& client, RunViewMessage view) {
  Print({FormatTopLine(view)});
  while (!StopRequested() && !Ended(view)) {
    const auto fresh = client.WaitForView(Now() + kCoordinator);
    if (StopRequested()) return;
    if (!fresh) throw RuntimeError("the run's coordinator is silent");
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
  RunClient client(ResolveTarget(options.target));
  const RunViewMessage view = client.FirstView();
  if (options.json) {
    Print({TopJson(view)});
  } else if (options.once) {
    const int width = isatty(STDOUT_FILENO) == 1 ? SizeOfTerminal().columns : 0;
    Print(FormatTop(view, TopOrder(), width));
  } else if (DrawsInPlace()) {
    ShowLive(client, view);
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
