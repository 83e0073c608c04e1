// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/metrics_view.h"

#include <algorithm>

namespace shoal::launch {
namespace {

constexpr std::string_view kUptime = "uptime_seconds";

template <class Values>
std::optional<double> FindValue(const Values& values, std::string_view name) {
  const auto it = values.find(name);
  return it == values.end() ? std::nullopt : std::optional(it->second);
}

}  // namespace

std::optional<double> FigureOf(const MetricsMessage& report, std::string_view name) {
  for (size_t i = 0; i < report.names.size() && i < report.values.size(); ++i) {
    if (report.names[i] == name) return report.values[i];
  }
  return std::nullopt;
}

// Whether the report is from a new process. On several hosts or in containers a successor can have
// the pid of its predecessor, but its uptime is shorter.
bool MetricsView::IsSuccessor(const MetricsMessage& message, const Process& before) {
  if (message.pid != before.newest.pid || message.host != before.newest.host) return true;
  const auto uptime = FigureOf(message, kUptime);
  const auto uptime_before = FindValue(before.values, kUptime);
  return uptime && uptime_before && *uptime < *uptime_before;
}

void MetricsView::OnMessage(const MetricsMessage& message, SteadyTime now) {
  Process& process = processes_[{message.role, message.id}];
  if (IsSuccessor(message, process)) {
    for (const auto& [name, value] : process.values) process.ended[name] += value;
  }
  process.values.clear();
  for (size_t i = 0; i < message.names.size() && i < message.values.size(); ++i) {
    process.values[message.names[i]] = message.values[i];
  }
  process.heard = now;
  process.newest = message;
}

template <class Visit>
void MetricsView::ForRole(std::string_view role, Visit visit) const {
  for (const auto& [key, process] : processes_) {
    if (key.first == role) visit(process);
  }
}

std::optional<double> MetricsView::Get(const ProcessName& process, std::string_view name) const {
  const auto it = processes_.find({std::string(process.role), process.index});
  return it == processes_.end() ? std::nullopt : FindValue(it->second.values, name);
}

std::optional<double> MetricsView::Largest(std::string_view role, std::string_view name) const {
  std::optional<double> largest;
  ForRole(role, [&](const Process& process) {
    const auto value = FindValue(process.values, name);
    if (value) largest = std::max(largest.value_or(*value), *value);
  });
  return largest;
}

std::optional<double> MetricsView::Average(std::string_view role, std::string_view name) const {
  double sum = 0;
  int count = 0;
  ForRole(role, [&](const Process& process) {
    const auto value = FindValue(process.values, name);
    if (!value) return;
    sum += *value;
    ++count;
  });
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

std::optional<double> MetricsView::Sum(std::string_view role, std::string_view name,
                                       SteadyTime now) const {
  std::optional<double> sum;
  ForRole(role, [&](const Process& process) {
    const auto value = FindValue(process.values, name);
    if (value && now - process.heard <= kFresh) sum = sum.value_or(0) + *value;
  });
  return sum;
}

std::optional<double> MetricsView::Mean(std::string_view role, std::string_view name,
                                        std::string_view weight, SteadyTime now) const {
  double sum = 0, weights = 0;
  ForRole(role, [&](const Process& process) {
    const auto value = FindValue(process.values, name), w = FindValue(process.values, weight);
    if (!value || !w || now - process.heard > kFresh) return;
    sum += *value * *w;
    weights += *w;
  });
  return weights > 0 ? std::optional(sum / weights) : std::nullopt;
}

double MetricsView::Total(std::string_view role, std::string_view name) const {
  double total = 0;
  ForRole(role, [&](const Process& process) {
    total +=
        FindValue(process.values, name).value_or(0) + FindValue(process.ended, name).value_or(0);
  });
  return total;
}

std::vector<MetricsMessage> MetricsView::Reports(SteadyTime now) const {
  std::vector<MetricsMessage> reports;
  for (const auto& [key, process] : processes_) {
    const bool silent = now - process.heard > kFresh;
    if (now - process.heard > kForget || (silent && process.newest.state == "stopping")) continue;
    reports.push_back(process.newest);
    if (silent) reports.back().state = "silent";
  }
  return reports;
}

int MetricsView::Processes(std::string_view role) const {
  int count = 0;
  ForRole(role, [&](const Process&) { ++count; });
  return count;
}

bool MetricsView::Heard(std::string_view role, uint32_t id) const {
  return processes_.contains({std::string(role), id});
}

}  // namespace shoal::launch
