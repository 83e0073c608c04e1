// SPDX-License-Identifier: Apache-2.0
#include "common/wire/metrics_report.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include "common/base/host_name.h"
#include "common/base/thread_group.h"

namespace shoal {

MetricsReport::MetricsReport(const ProcessName& process)
    : start_(Now()), last_due_(start_), last_begin_(start_) {
  message_.role = process.role;
  message_.id = process.index;
  message_.host = HostName();
  message_.pid = getpid();
}

bool MetricsReport::Due(SteadyTime now) {
  if (now - last_due_ < std::chrono::seconds(1)) return false;
  last_due_ = now;
  return true;
}

void MetricsReport::Begin(const std::string& state) {
  interval_seconds_ = SecondsSince(std::exchange(last_begin_, Now()));
  message_.state = state;
  message_.time = WallTimeSeconds();
  message_.names.clear();
  message_.values.clear();
}

void MetricsReport::Add(const std::string& name, double value) {
  message_.names.push_back(name);
  message_.values.push_back(value);
}

void MetricsReport::AddQuantiles(const std::string& name, QuantileWindow* window) {
  if (const auto quantiles = window->Take()) AddQuantiles(name, *quantiles);
}

void MetricsReport::AddQuantiles(const std::string& name, const Quantiles& quantiles) {
  Add(name + "_p50", quantiles.p50);
  Add(name + "_p90", quantiles.p90);
  Add(name + "_p99", quantiles.p99);
}

void MetricsReport::AddRate(const std::string& name, double total, double most) {
  const double before = std::exchange(totals_[name], total);
  if (interval_seconds_ < kShortest) return;
  Add(name, std::min(most, (total - before) / interval_seconds_));
}

void MetricsReport::AddShare(const std::string& name, double part, double whole) {
  const auto before = std::exchange(parts_[name], {part, whole});
  if (whole <= before.second) return;
  Add(name, (part - before.first) / (whole - before.second));
}

void MetricsReport::AddSeconds(const std::string& stage, double total) {
  Add("seconds_" + stage, total);
  AddRate("share_" + stage, total, 1);
}

void MetricsReport::AddResources() {
  Add("uptime_seconds", SecondsSince(start_));
  Add("rss_mb", ResidentMegabytes());
  Add("open_files", OpenFiles());
  Add("cpu_seconds", CpuSeconds());
  AddRate("cpu_share", CpuSeconds());
}

double ResidentMegabytes() {
  std::ifstream statm("/proc/self/statm");
  uint64_t total_pages = 0, resident_pages = 0;
  statm >> total_pages >> resident_pages;
  return static_cast<double>(resident_pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

int OpenFiles() {
  struct stat status {};
  if (stat("/proc/self/fd", &status) == 0 && status.st_size > 0) {
    return static_cast<int>(status.st_size);  // the number of files since Linux 6.2
  }
  int files = 0;
  std::error_code error;
  for (std::filesystem::directory_iterator it("/proc/self/fd", error), end; !error && it != end;
       it.increment(error)) {
    ++files;
  }
  return files > 0 ? files - 1 : 0;
}

double CpuSeconds() {
  if (const ThreadGroup* group = ThreadGroup::Current()) return group->CpuSeconds();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace shoal
