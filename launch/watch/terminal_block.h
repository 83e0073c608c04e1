// SPDX-License-Identifier: Apache-2.0
// Lines that are redrawn in place on the terminal.
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

// Whether stdout is a terminal on which lines can be drawn in place. A terminal with TERM=dumb, as
// in an editor or on a build server, cannot draw in place.
bool DrawsInPlace();

// Whether this process may draw on the terminal of stdout. False while a shell runs this process in
// the background.
bool InForeground();

// Number of columns of a UTF-8 text: one per character.
size_t ColumnsOf(std::string_view text);
// The first `columns` columns of the text, in whole characters.
std::string CutToColumns(std::string text, size_t columns);

// The text in lines of at most `columns`, broken at spaces if there are any. The first line keeps
// its leading spaces. The other lines are indented two columns further than the first line, or not
// at all if `hanging` is false.
std::vector<std::string> WrapToColumns(std::string_view text, size_t columns, bool hanging = true);

// A line of text for stdout: wrapped if stdout is a terminal, else whole.
std::vector<std::string> LinesOnTerminal(const std::string& line);

// Number of terminal rows of lines with these columns if the terminal wraps at `terminal_columns`.
int RowsOf(const std::vector<size_t>& line_columns, int terminal_columns);

// One thread.
class TerminalBlock {
 public:
  // Replaces the block drawn before. Lines below the last row of the terminal are left out.
  void Draw(const std::vector<std::string>& lines);
  // Erases the block and leaves the cursor at the start of an empty line. Also erases text that the
  // terminal echoed below the block, such as the ^C of Ctrl-C. If the terminal became narrower, the
  // rows that wrapping has added are also erased. A terminal that cuts lines instead (xterm) loses
  // the same number of rows above the block.
  void Erase();
  // Keeps the block as the last lines on the terminal and erases text echoed below the block.
  void Leave();
  // Forgets the block without erasing it. The next block is drawn at the cursor, below other
  // output.
  void Forget() { drawn_.clear(); }

 private:
  std::vector<size_t> drawn_;  // columns of each line on the terminal
};

}  // namespace shoal::launch
