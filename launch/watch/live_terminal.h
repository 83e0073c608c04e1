// SPDX-License-Identifier: Apache-2.0
// A screen of lines that is redrawn, and keyboard input without Enter.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

// While the object exists, the terminal shows its alternate screen, which has no history: lines
// that a change of size has wrapped disappear with the next drawing. Keys are read without Enter
// and are not echoed; Ctrl-\ does nothing and Ctrl-Z is a key (kSuspendKey). The destructor
// restores the terminal; stop signals must lead to it (common/base/stop.h). One thread.
class LiveTerminal {
 public:
  // Stdout must be a terminal; keys are read if stdin is a terminal too.
  LiveTerminal();
  ~LiveTerminal();
  LiveTerminal(const LiveTerminal&) = delete;
  LiveTerminal& operator=(const LiveTerminal&) = delete;

  // Replaces what was drawn before. Lines below the last row of the terminal are left out.
  void Draw(const std::vector<std::string>& lines);
  // Waits at most `most` for the next key. Returns none at a stop signal or without a terminal on
  // stdin.
  std::optional<char> WaitForKey(std::chrono::milliseconds most);
  // Handles Ctrl-Z: restores the terminal and stops this process until it is continued.
  void Suspend();

  static constexpr char kSuspendKey = 0x1a;

 private:
  void Enter();
  void Leave();

  std::optional<termios> before_;  // former settings of stdin; empty if stdin is no terminal
};

}  // namespace shoal::launch
