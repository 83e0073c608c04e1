// SPDX-License-Identifier: Apache-2.0
// The newest metrics of every process of a run, and the totals of the counters.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/wire/messages.h"
#include "common/wire/process_name.h"

namespace shoal::launch {

// The metric `name` in a report; empty if the report does not contain the metric.
std::optional<double> FigureOf(const MetricsMessage& report, std::string_view name);

// One thread. Holds one report per process id, and one final value per counter of the dead
// processes.
class MetricsView {
 public:
  // Expects the reports of one process in the order in which they were made. Wall-clock times in
  // reports are not compared, because a clock may be set back. A report with another host or
  // process number, or with a shorter uptime, belongs to a successor.
  void OnMessage(const MetricsMessage& message, SteadyTime now);

  // The metric in the newest report of the process; empty if the report does not contain the
  // metric.
  std::optional<double> Get(const ProcessName& process, std::string_view name) const;
  // The largest value, and the mean, over the newest reports of the role's processes; empty if no
  // report contains the metric.
  std::optional<double> Largest(std::string_view role, std::string_view name) const;
  std::optional<double> Average(std::string_view role, std::string_view name) const;
  // Sum over the role's processes that have reported within kFresh; empty if no report contains the
  // metric.
  std::optional<double> Sum(std::string_view role, std::string_view name, SteadyTime now) const;
  // Mean over the role's processes that have reported within kFresh, weighted by the metric
  // `weight`.
  std::optional<double> Mean(std::string_view role, std::string_view name, std::string_view weight,
                             SteadyTime now) const;
  // A counter of the role over the whole run. Restarted processes count from 0, so the last values
  // of their predecessors are added.
  double Total(std::string_view role, std::string_view name) const;

  // The newest report of every process, by role and id. A process without a report for kFresh has
  // the state "silent". A process is left out if it has not reported for kForget, or if it is
  // silent and its last state was "stopping".
  std::vector<MetricsMessage> Reports(SteadyTime now) const;

  // Seconds that the role's processes have run, including processes that have ended.
  double Seconds(std::string_view role) const { return Total(role, "uptime_seconds"); }
  // Number of ids of the role from which a report has ever come.
  int Processes(std::string_view role) const;
  // Whether the role's process `id` has reported.
  bool Heard(std::string_view role, uint32_t id) const;

  static constexpr std::chrono::seconds kFresh{5};
  static constexpr std::chrono::seconds kForget{60};

 private:
  using Values = std::map<std::string, double, std::less<>>;
  struct Process {
    SteadyTime heard;
    MetricsMessage newest;
    Values values;
    Values ended;  // sums of the last values of earlier processes of this id
  };

  static bool IsSuccessor(const MetricsMessage& message, const Process& before);

  // Calls visit(process) for each process of the role.
  template <class Visit>
  void ForRole(std::string_view role, Visit visit) const;

  std::map<std::pair<std::string, uint32_t>, Process> processes_;
};

}  // namespace shoal::launch
