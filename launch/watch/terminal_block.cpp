#include "launch/watch/terminal_block.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace shoal::launch {
namespace {

// A byte of UTF-8 that goes on with a character.
bool GoesOn(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) == 0x80; }

}  // namespace

TerminalSize SizeOfTerminal() {
  winsize size{};
  TerminalSize result;
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return result;
  if (size.ws_col > 0) result.columns = size.ws_col;
  if (size.ws_row > 0) result.rows = size.ws_row;
  return result;
}

bool DrawsInPlace() {
  const char* kind = std::getenv("TERM");
  return isatty(STDOUT_FILENO) == 1 && (kind == nullptr || std::string_view(kind) != "dumb");
}

size_t ColumnsOf(std::string_view text) {
  return text.size() - static_cast<size_t>(std::ranges::count_if(text, GoesOn));
}

std::string CutToColumns(std::string text, size_t columns) {
  size_t end = 0;
  for (size_t taken = 0; end < text.size(); ++end) {
    if (!GoesOn(text[end]) && taken++ == columns) break;
  }
  text.resize(end);
  return text;
}

int RowsOf(const std::vector<size_t>& line_columns, int terminal_columns) {
  const auto width = static_cast<size_t>(std::max(1, terminal_columns));
  size_t rows = 0;
  for (const size_t columns : line_columns)
    rows += std::max<size_t>(1, (columns + width - 1) / width);
  return static_cast<int>(rows);
}

void TerminalBlock::Draw(const std::vector<std::string>& lines) {
  Erase();
  const auto rows = static_cast<size_t>(std::max(1, SizeOfTerminal().rows - 1));
  for (size_t i = 0; i < std::min(rows, lines.size()); ++i) {
    std::printf("%s\n", lines[i].c_str());
    drawn_.push_back(ColumnsOf(lines[i]));
  }
  std::fflush(stdout);
}

void TerminalBlock::Erase() {
  if (drawn_.empty()) return;
  std::printf("\x1b[%dA\x1b[J", RowsOf(drawn_, SizeOfTerminal().columns));  // up, then clear below
  drawn_.clear();
}

}  // namespace shoal::launch
