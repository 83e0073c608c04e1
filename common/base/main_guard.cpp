#include "common/base/main_guard.h"

#include <sys/stat.h>

#include <cstdio>
#include <exception>

#include "common/base/error.h"

namespace shoal {

int GuardMain(const char* program, const std::function<int()>& body) {
  umask(0077);  // what a program writes is its user's own
  try {
    return body();
  } catch (const Error& e) {
    std::fprintf(stderr, "%s: error: %s\n", program, e.what());
    return e.exit_code();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: error: %s\n", program, e.what());
    return 1;
  }
}

}  // namespace shoal
