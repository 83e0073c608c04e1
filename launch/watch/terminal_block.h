// SPDX-License-Identifier: Apache-2.0
// Lines on the terminal that are drawn again and again in place.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::launch {

struct TerminalSize {
  int columns = 80, rows = 24;
  bool operator==(const TerminalSize&) const = default;
};

// Size of the terminal on stdout; 80 x 24 if it is unknown.
TerminalSize SizeOfTerminal();

// Whether stdout is a terminal on which lines can be drawn in place: TERM=dumb cannot, such as that
// of an editor or of a build server that only says that it is a terminal.
bool DrawsInPlace();

// Whether the terminal on stdout is this process's to draw on: not while a shell has it in the
// background, with its prompt in the foreground.
bool InForeground();

// Columns that a text of UTF-8 takes, a column per character.
size_t ColumnsOf(std::string_view text);
// The first `columns` of it, in whole characters.
std::string CutToColumns(std::string text, size_t columns);

// The text in lines of at most `columns`, broken at spaces where there are any. The first line
// keeps its leading spaces, the others begin two further in; with `hanging` false, at the left.
std::vector<std::string> WrapToColumns(std::string_view text, size_t columns, bool hanging = true);

// A line for people as stdout takes it: wrapped where it is a terminal, else whole.
std::vector<std::string> LinesOnTerminal(const std::string& line);

// Terminal rows that lines of these columns take on a terminal that wraps at `terminal_columns`.
int RowsOf(const std::vector<size_t>& line_columns, int terminal_columns);

// One thread.
class TerminalBlock {
 public:
  // Replaces what was drawn before. Lines that the terminal has no row for are left out.
  void Draw(const std::vector<std::string>& lines);
  // Leaves the cursor at the start of an empty line. What the terminal echoed below the block, as
  // the ^C of Ctrl-C, goes with it; so do the rows that a terminal has made of lines by wrapping
  // them when it became narrower. One that cuts lines instead (xterm) loses as many rows above.
  void Erase();
  // The block stays as the last thing on the terminal, without what was echoed below it.
  void Leave();
  // The block stays where it is, and the next one is drawn at the cursor: other output is below it.
  void Forget() { drawn_.clear(); }

 private:
  std::vector<size_t> drawn_;  // columns of each line on the terminal
};

}  // namespace shoal::launch
