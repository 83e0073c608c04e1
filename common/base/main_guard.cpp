// SPDX-License-Identifier: Apache-2.0
#include "common/base/main_guard.h"

#include <cstdio>
#include <exception>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/one_line.h"

namespace shoal {

namespace {

// A reason may quote what came from outside: one line of a length that people read.
constexpr size_t kReasonBytes = 1000;

void PrintError(const char* program, const char* reason) {
  std::fprintf(stderr, "%s: error: %s\n", program,
               Shortened(OneLine(reason), kReasonBytes).c_str());
}

}  // namespace

int GuardMain(const char* program, const std::function<int()>& body) {
  NoteUmask();
  try {
    return body();
  } catch (const Error& e) {
    PrintError(program, e.what());
    return e.exit_code();
  } catch (const std::exception& e) {
    PrintError(program, e.what());
    return 1;
  }
}

}  // namespace shoal
