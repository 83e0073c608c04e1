// A block of lines on the terminal that is drawn again and again in place, and keys as they are
// pressed.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

struct TerminalSize {
  int columns = 80, rows = 24;
};

// Of the terminal on stdout; 80 x 24 when it does not say.
TerminalSize SizeOfTerminal();

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
  void Draw(const std::vector<std::string>& lines);
  // The next key, waiting at most this long; none at a stop signal or without a terminal on stdin.
  std::optional<char> WaitForKey(std::chrono::milliseconds most);

 private:
  std::optional<termios> before_;  // what stdin was; empty when it is no terminal
  int drawn_lines_ = 0;
};

}  // namespace shoal::launch
