// A block of lines on the terminal that is drawn again and again in place, and keys as they are
// pressed.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "launch/watch/terminal_block.h"

namespace shoal::launch {

// While it lives, keys come without Enter and are not echoed, and Ctrl-\ does nothing. Its end,
// which stop signals must lead to (common/base/stop.h), puts the terminal back as it was. One
// thread.
class LiveTerminal {
 public:
  // Stdout is a terminal; keys are read when stdin is one too.
  LiveTerminal();
  ~LiveTerminal();
  LiveTerminal(const LiveTerminal&) = delete;
  LiveTerminal& operator=(const LiveTerminal&) = delete;

  // Replaces what was drawn before. Lines that the terminal has no row for are left out.
  void Draw(const std::vector<std::string>& lines) { block_.Draw(lines); }
  // The next key, waiting at most this long; none at a stop signal or without a terminal on stdin.
  std::optional<char> WaitForKey(std::chrono::milliseconds most);

 private:
  std::optional<termios> before_;  // what stdin was; empty when it is no terminal
  TerminalBlock block_;
};

}  // namespace shoal::launch
