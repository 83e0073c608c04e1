// SPDX-License-Identifier: Apache-2.0
// A screen of lines that is redrawn, and keyboard input without Enter.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

// While the object exists, the terminal shows its alternate screen, which has no history. If a
// change of the terminal's size wraps lines, the wrapped lines disappear with the next drawing.
// Keys are read without Enter and are not echoed; Ctrl-\ does nothing and Ctrl-Z is a key
// (kSuspendKey). The destructor restores the terminal. A stop signal must therefore not end the
// process directly (common/base/stop.h). One thread.
class LiveTerminal {
 public:
  // Stdout must be a terminal. Keys are read only if stdin is also a terminal.
  LiveTerminal();
  ~LiveTerminal();
  LiveTerminal(const LiveTerminal&) = delete;
  LiveTerminal& operator=(const LiveTerminal&) = delete;

  // Replaces the lines drawn before. Lines below the last row of the terminal are left out.
  void Draw(const std::vector<std::string>& lines);
  // Waits at most `most` for the next key. Empty if no key came, at a stop signal, or if stdin is
  // not a terminal.
  std::optional<char> WaitForKey(std::chrono::milliseconds most);
  // Handles Ctrl-Z: restores the terminal and suspends this process until SIGCONT.
  void Suspend();

  static constexpr char kSuspendKey = 0x1a;

 private:
  void Enter();
  void Leave();

  std::optional<termios> before_;  // former settings of stdin; empty if stdin is no terminal
};

}  // namespace shoal::launch
