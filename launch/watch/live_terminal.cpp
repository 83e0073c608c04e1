// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/live_terminal.h"

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "launch/watch/terminal_block.h"

namespace shoal::launch {
namespace {

constexpr char kAlternateScreen[] = "\x1b[?1049h", kOwnScreen[] = "\x1b[?1049l";
constexpr char kHome[] = "\x1b[H", kClearLine[] = "\x1b[K", kClearBelow[] = "\x1b[J";

}  // namespace

LiveTerminal::LiveTerminal() { Enter(); }

LiveTerminal::~LiveTerminal() { Leave(); }

void LiveTerminal::Enter() {
  std::printf("%s%s", kAlternateScreen, kHome);
  std::fflush(stdout);
  termios settings{};
  if (tcgetattr(STDIN_FILENO, &settings) != 0) return;
  before_ = settings;
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  settings.c_cc[VQUIT] = _POSIX_VDISABLE;
  settings.c_cc[VSUSP] = _POSIX_VDISABLE;
  tcsetattr(STDIN_FILENO, TCSANOW, &settings);
}

void LiveTerminal::Leave() {
  std::printf("%s", kOwnScreen);
  std::fflush(stdout);
  if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
}

void LiveTerminal::Draw(const std::vector<std::string>& lines) {
  const auto rows = static_cast<size_t>(SizeOfTerminal().rows);
  std::printf("%s", kHome);
  for (size_t i = 0; i < lines.size() && i < rows; ++i) {
    std::printf("%s%s%s", i > 0 ? "\r\n" : "", lines[i].c_str(), kClearLine);
  }
  std::printf("%s", kClearBelow);
  std::fflush(stdout);
}

std::optional<char> LiveTerminal::WaitForKey(std::chrono::milliseconds most) {
  pollfd input{.fd = before_ ? STDIN_FILENO : -1, .events = POLLIN, .revents = 0};
  if (poll(&input, 1, static_cast<int>(most.count())) <= 0) return std::nullopt;
  char key = 0;
  if (read(STDIN_FILENO, &key, 1) != 1) return std::nullopt;
  return key;
}

void LiveTerminal::Suspend() {
  Leave();
  raise(SIGTSTP);  // returns after SIGCONT
  Enter();
}

}  // namespace shoal::launch
