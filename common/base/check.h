// SPDX-License-Identifier: Apache-2.0
// CHECK(condition) << context: aborts if the condition is false. A false condition means a bug in
// the program. Active in every build.
#pragma once

#include <sstream>

namespace shoal::internal {

// Collects the context and aborts in its destructor, at the end of the full expression.
class CheckFailure {
 public:
  CheckFailure(const char* file, int line, const char* condition);
  [[noreturn]] ~CheckFailure();
  std::ostream& stream() { return stream_; }

 private:
  std::ostringstream stream_;
};

// Gives both branches of the conditional in CHECK the type void.
struct Voidify {
  void operator&(std::ostream&) const {}
};

}  // namespace shoal::internal

#define CHECK(condition)                       \
  (condition) ? static_cast<void>(0)           \
              : ::shoal::internal::Voidify() & \
                    ::shoal::internal::CheckFailure(__FILE__, __LINE__, #condition).stream()
