// Lines on the terminal that are drawn again and again in place.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::launch {

struct TerminalSize {
  int columns = 80, rows = 24;
};

// Of the terminal on stdout; 80 x 24 when it does not say.
TerminalSize SizeOfTerminal();

// Whether stdout is a terminal on which lines can be drawn in place: TERM=dumb cannot, such as that
// of an editor or of a build server that only says that it is a terminal.
bool DrawsInPlace();

// Columns that a text of UTF-8 takes, a column per character.
size_t ColumnsOf(std::string_view text);
// The first `columns` of it, in whole characters.
std::string CutToColumns(std::string text, size_t columns);

// Terminal rows that lines of these columns take on a terminal that wraps at `terminal_columns`.
int RowsOf(const std::vector<size_t>& line_columns, int terminal_columns);

// One thread.
class TerminalBlock {
 public:
  // Replaces what was drawn before. Lines that the terminal has no row for are left out.
  void Draw(const std::vector<std::string>& lines);
  // Also when the terminal has become narrower since, and has wrapped the lines.
  void Erase();

 private:
  std::vector<size_t> drawn_;  // columns of each line on the terminal
};

}  // namespace shoal::launch
