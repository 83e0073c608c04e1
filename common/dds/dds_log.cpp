// SPDX-License-Identifier: Apache-2.0
#include "common/dds/dds_log.h"

#include <optional>
#include <string_view>

#include "common/base/clock.h"
#include "common/base/line_budget.h"
#include "common/base/log.h"
#include "common/base/mutex.h"
// clang-format off
#include "dds/dds.h"
#include "dds/ddsrt/log.h"
// clang-format on

namespace shoal::dds {

namespace {
thread_local DdsErrorCapture* current_capture = nullptr;
}  // namespace

struct DdsLogSink {
  static void Write(void*, const dds_log_data_t* data) {
    std::string_view line(data->message, data->size);
    while (!line.empty() && (line.back() == '\n' || line.back() == '\0')) line.remove_suffix(1);
    const bool is_error = (data->priority & (DDS_LC_ERROR | DDS_LC_FATAL)) != 0;
    if (is_error && current_capture != nullptr) {
      std::string& lines = current_capture->lines_;
      lines += (lines.empty() ? "" : "; ") + std::string(line);
    } else if (is_error) {
      log::Failure("dds: {}", line);
    } else if ((data->priority & DDS_LC_WARNING) != 0) {
      WriteWarning(line);
    }
  }

  // Any thread. Lines are limited: the library warns about each damaged datagram, and anybody can
  // send those.
  static void WriteWarning(std::string_view line) {
    static Mutex mutex;
    static LineBudget budget;
    std::optional<uint64_t> left_out;
    {
      const MutexLock lock(mutex);
      left_out = budget.Take(Now());
    }
    if (!left_out) return;
    if (*left_out > 0) log::Warning("dds: {} warnings were left out", *left_out);
    log::Warning("dds: {}", line);
  }
};

void RouteDdsLog() { dds_set_log_sink(&DdsLogSink::Write, nullptr); }

DdsErrorCapture::DdsErrorCapture() : outer_(current_capture) { current_capture = this; }

DdsErrorCapture::~DdsErrorCapture() { current_capture = outer_; }

std::string DdsErrorCapture::text() const { return lines_.empty() ? "no reason given" : lines_; }

}  // namespace shoal::dds
