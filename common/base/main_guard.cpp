#include "common/base/main_guard.h"

#include <sys/stat.h>

#include <cstdio>
#include <exception>

#include "common/base/error.h"
#include "common/base/one_line.h"

namespace shoal {

int GuardMain(const char* program, const std::function<int()>& body) {
  umask(0077);  // what a program writes is its user's own
  try {
    return body();
  } catch (const Error& e) {
    std::fprintf(stderr, "%s: error: %s\n", program, OneLine(e.what()).c_str());
    return e.exit_code();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: error: %s\n", program, OneLine(e.what()).c_str());
    return 1;
  }
}

}  // namespace shoal
