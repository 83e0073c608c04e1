#include "launch/watch/live_terminal.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace shoal::launch {

TerminalSize SizeOfTerminal() {
  winsize size{};
  TerminalSize result;
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return result;
  if (size.ws_col > 0) result.columns = size.ws_col;
  if (size.ws_row > 0) result.rows = size.ws_row;
  return result;
}

LiveTerminal::LiveTerminal() {
  termios settings{};
  if (tcgetattr(STDIN_FILENO, &settings) != 0) return;
  before_ = settings;
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  settings.c_cc[VQUIT] = _POSIX_VDISABLE;
  tcsetattr(STDIN_FILENO, TCSANOW, &settings);
}

LiveTerminal::~LiveTerminal() {
  std::fflush(stdout);
  if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
}

void LiveTerminal::Draw(const std::vector<std::string>& lines) {
  if (drawn_lines_ > 0) std::printf("\x1b[%dA\x1b[J", drawn_lines_);  // up, then clear below
  const int rows = std::max(1, SizeOfTerminal().rows - 1);
  drawn_lines_ = std::min(rows, static_cast<int>(lines.size()));
  for (int i = 0; i < drawn_lines_; ++i) std::printf("%s\n", lines[static_cast<size_t>(i)].c_str());
  std::fflush(stdout);
}

std::optional<char> LiveTerminal::WaitForKey(std::chrono::milliseconds most) {
  pollfd input{.fd = before_ ? STDIN_FILENO : -1, .events = POLLIN, .revents = 0};
  if (poll(&input, 1, static_cast<int>(most.count())) <= 0) return std::nullopt;
  char key = 0;
  if (read(STDIN_FILENO, &key, 1) != 1) return std::nullopt;
  return key;
}

}  // namespace shoal::launch
