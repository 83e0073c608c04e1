/* SPDX-License-Identifier: Apache-2.0 */
/* What a bundle has in place of a library that it leaves out: every function says so in one line
   and ends the program. LINE: that line. NAMES: a file with SHOAL_LEFT_OUT(function) a line, for
   each function that is used. */
#include <unistd.h>

static void say_and_end(void) {
  static const char line[] = "error: " LINE "\n";
  if (write(STDERR_FILENO, line, sizeof line - 1) < 0) _exit(1);
  _exit(1);
}

#define SHOAL_LEFT_OUT(name) \
  __attribute__((visibility("default"))) void name(void) { say_and_end(); }
#include NAMES
