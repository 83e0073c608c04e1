// SPDX-License-Identifier: Apache-2.0
// A screen of lines that is drawn again and again, and keys as they are pressed.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

// While it lives the terminal shows its alternate screen, which has no history: what a change of
// size makes of the lines is gone with the next drawing. Keys come without Enter and are not
// echoed; Ctrl-\ does nothing and Ctrl-Z is a key (kSuspendKey). Its end, which stop signals must
// lead to (common/base/stop.h), puts the terminal back as it was. One thread.
class LiveTerminal {
 public:
  // Stdout is a terminal; keys are read when stdin is one too.
  LiveTerminal();
  ~LiveTerminal();
  LiveTerminal(const LiveTerminal&) = delete;
  LiveTerminal& operator=(const LiveTerminal&) = delete;

  // Replaces what was drawn before. Lines that the terminal has no row for are left out.
  void Draw(const std::vector<std::string>& lines);
  // The next key, waiting at most this long; none at a stop signal or without a terminal on stdin.
  std::optional<char> WaitForKey(std::chrono::milliseconds most);
  // Handles Ctrl-Z: restores the terminal and stops this process until it is continued.
  void Suspend();

  static constexpr char kSuspendKey = 0x1a;

 private:
  void Enter();
  void Leave();

  std::optional<termios> before_;  // what stdin was; empty when it is no terminal
};

}  // namespace shoal::launch
