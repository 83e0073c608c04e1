// SPDX-License-Identifier: Apache-2.0
// Progress display of a running run: a live block on a terminal, plain lines elsewhere.
#pragma once

#include <cstdio>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "launch/record/evaluation_point.h"
#include "launch/watch/terminal_block.h"

namespace shoal::launch {

// Numbers on the display. Numbers that no process has reported yet are empty.
struct ProgressFigures {
  std::string run;    // name
  std::string state;  // "running", "draining", "stopping"
  double elapsed_seconds = 0;
  uint64_t env_steps = 0, budget = 0;
  std::optional<double> env_steps_per_second;  // recent rate
  std::optional<double> updates, updates_per_second;
  std::optional<double> seconds_left;                          // until the budget is used up
  std::vector<std::pair<std::string, double>> update_figures;  // name, value
  std::optional<double> policy_lag;  // policy lag of the actors, updates, median
  std::optional<double> data_age;    // data age of the batches, updates, median
  // Means over the last episodes of the actors.
  std::optional<double> rollout_success, rollout_return, rollout_length;
  std::optional<double> actors_wait;    // recent share of time in which the limiter held actors
  std::optional<double> learner_waits;  // recent share in which the limiter held the learner
  std::optional<EvaluationPoint> last_evaluation, best;
  int processes = 0, restarts = 0;
  // Number of training actors that are not down after a death; in lockstep, of all actors.
  int actors_working = 0;
  std::string trouble;           // one line: actors that do not work, and why; empty if all work
  uint64_t faulty_episodes = 0;  // of the training actors, over the whole run
};

// "12:05" or "1:02:03"; "-" if unknown.
std::string FormatDuration(std::optional<double> seconds);
// One plain line.
std::string FormatProgressLine(const ProgressFigures& figures);
// The live block, each line at most `width` characters.
std::vector<std::string> FormatProgressBlock(const ProgressFigures& figures, int width);

// Writes to stdout and copies event lines to a log file. One thread.
class Progress {
 public:
  // `on_say` receives every line that Say gets. `plain`: writes plain lines even if the terminal
  // can draw in place. Throws Error if the log cannot be opened; empty `log_file` = no log.
  explicit Progress(const std::string& log_file,
                    std::function<void(const std::string&)> on_say = nullptr, bool plain = false);
  // Leaves the cursor below the last block.
  ~Progress();

  // Shows the numbers, as a block at most twice a second or as a line every 5 s. Draws no block
  // while another program uses the terminal.
  void Show(const ProgressFigures& figures, SteadyTime now);
  // Writes one line that stays. On a terminal the line is wrapped and appears above the block; in
  // the log it has a time stamp.
  void Say(const std::string& line);
  // Call after another program has written to the terminal. The old block is then not erased.
  void Resume() { block_.Forget(); }

 private:
  const bool terminal_;
  std::ofstream log_;
  const std::function<void(const std::string&)> on_say_;
  TerminalBlock block_;
  std::optional<SteadyTime> shown_;
};

}  // namespace shoal::launch
