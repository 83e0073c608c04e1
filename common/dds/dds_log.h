// SPDX-License-Identifier: Apache-2.0
// Cyclone DDS's own log lines, led into ours.
#pragma once

#include <string>

namespace shoal::dds {

// Sends Cyclone's warnings (LineBudget) and errors to shoal::log, for the whole process. May be
// called again.
void RouteDdsLog();

// While it lives, errors that Cyclone reports on this thread are kept instead of logged, so that
// they become part of an exception's message.
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
