#include "common/wire/metrics_report.h"

#include <unistd.h>

#include <fstream>

namespace shoal {

MetricsReport::MetricsReport(const std::string& role, uint32_t id) : last_(Now()) {
  char host[256] = "unknown";
  gethostname(host, sizeof host - 1);
  message_.role = role;
  message_.id = id;
  message_.host = host;
  message_.pid = getpid();
}

bool MetricsReport::Due(SteadyTime now) {
  const double elapsed = std::chrono::duration<double>(now - last_).count();
  if (elapsed < 1.0) return false;
  last_ = now;
  interval_seconds_ = elapsed;
  return true;
}

void MetricsReport::Begin(const std::string& state) {
  message_.state = state;
  message_.time = WallTimeSeconds();
  message_.names.clear();
  message_.values.clear();
}

void MetricsReport::Add(const std::string& name, double value) {
  message_.names.push_back(name);
  message_.values.push_back(value);
}

double ResidentMegabytes() {
  std::ifstream statm("/proc/self/statm");
  uint64_t total_pages = 0, resident_pages = 0;
  statm >> total_pages >> resident_pages;
  return static_cast<double>(resident_pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace shoal
