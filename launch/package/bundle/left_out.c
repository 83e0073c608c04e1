/* SPDX-License-Identifier: Apache-2.0 */
/* What a slim bundle has in place of a library that it leaves out. WHAT: what needs the library
   ("films"). NAMES: a file with SHOAL_LEFT_OUT(function) a line, for each function that the
   programs use. A function says in one line what is missing and ends the program; with FAILS
   defined it returns 0, for a library whose failure the programs report themselves. */
#include <unistd.h>

/* Programs look for this symbol to say why the library fails. */
__attribute__((visibility("default"))) const char shoal_left_out[] = WHAT;

static long fail(void) {
#ifndef FAILS
  static const char line[] = "error: this is a slim bundle, which leaves out what " WHAT
                             " need: use the full bundle (docs/install.md)\n";
  if (write(STDERR_FILENO, line, sizeof line - 1) < 0) _exit(1);
  _exit(1);
#endif
  return 0;
}

#define SHOAL_LEFT_OUT(name) \
  __attribute__((visibility("default"))) long name(void) { return fail(); }
#include NAMES
