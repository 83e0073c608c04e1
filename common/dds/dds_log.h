// SPDX-License-Identifier: Apache-2.0
// Sends the log lines of Cyclone DDS to Shoal's log.
#pragma once

#include <string>

namespace shoal::dds {

// Sends Cyclone's warnings (LineBudget) and errors to shoal::log, for the whole process. May be
// called again.
void RouteDdsLog();

// Collects, during its lifetime, the errors that Cyclone reports on this thread. They are not
// logged, so that an exception's message can contain them.
class DdsErrorCapture {
 public:
  DdsErrorCapture();
  ~DdsErrorCapture();
  DdsErrorCapture(const DdsErrorCapture&) = delete;
  DdsErrorCapture& operator=(const DdsErrorCapture&) = delete;

  // One line; "no reason given" when Cyclone reported none.
  std::string text() const;

 private:
  std::string lines_;
  DdsErrorCapture* outer_;
  friend struct DdsLogSink;
};

}  // namespace shoal::dds
