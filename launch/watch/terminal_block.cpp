// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/terminal_block.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace shoal::launch {
namespace {

// Whether the byte is a continuation byte of UTF-8.
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

bool InForeground() {
  const pid_t foreground = tcgetpgrp(STDOUT_FILENO);
  return foreground < 0 || foreground == getpgrp();  // < 0: not the terminal of our session
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

std::vector<std::string> WrapToColumns(std::string_view text, size_t columns, bool hanging) {
  const size_t leading = std::min(text.find_first_not_of(' '), text.size());
  const std::string indent(hanging && leading + 2 < columns ? leading + 2 : 0, ' ');
  std::vector<std::string> lines;
  std::string rest(text);
  while (ColumnsOf(rest) > columns) {
    const std::string fits = CutToColumns(rest, columns);
    // The line may end at a space directly after the text that fits, but not within the indent.
    size_t end = rest[fits.size()] == ' ' ? fits.size() : fits.rfind(' ');
    const size_t first_word = std::min(rest.find_first_not_of(' '), fits.size());
    const bool at_space = end != std::string::npos && end > first_word;
    if (!at_space) end = std::max<size_t>(1, fits.size());
    lines.push_back(rest.substr(0, end));
    rest = indent + rest.substr(at_space ? end + 1 : end);
  }
  lines.push_back(std::move(rest));
  return lines;
}

std::vector<std::string> LinesOnTerminal(const std::string& line) {
  if (isatty(STDOUT_FILENO) != 1) return {line};
  return WrapToColumns(line, static_cast<size_t>(SizeOfTerminal().columns));
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
  std::printf("\r");  // moves before echoed input
  if (!drawn_.empty()) std::printf("\x1b[%dA", RowsOf(drawn_, SizeOfTerminal().columns));
  std::printf("\x1b[J");  // clears to the end of the screen
  drawn_.clear();
}

void TerminalBlock::Leave() {
  if (drawn_.empty()) return;
  std::printf("\r\x1b[J");
  std::fflush(stdout);
  drawn_.clear();
}

}  // namespace shoal::launch
