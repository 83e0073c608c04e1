// SPDX-License-Identifier: Apache-2.0
// Sends the log lines of Cyclone DDS to Shoal's log.
#pragma once

#include <string>

namespace shoal::dds {

// Sends Cyclone's errors and warnings to shoal::log, for the whole process. The number of warnings
// is limited (LineBudget). May be called again.
void RouteDdsLog();

// Collects, during its lifetime, the errors that Cyclone reports on this thread, for the message of
// an exception. These errors are not logged.
class DdsErrorCapture {
 public:
  DdsErrorCapture();
  ~DdsErrorCapture();
  DdsErrorCapture(const DdsErrorCapture&) = delete;
  DdsErrorCapture& operator=(const DdsErrorCapture&) = delete;

  // The errors as one line; "no reason given" if Cyclone reported no error.
  std::string text() const;

 private:
  std::string lines_;
  DdsErrorCapture* outer_;
  friend struct DdsLogSink;
};

}  // namespace shoal::dds
