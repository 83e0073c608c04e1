// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_watch.h"

#include <fmt/core.h>

#include <utility>

#include "common/link/metrics_writer.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/process_name.h"
#include "launch/watch/run_totals.h"

namespace shoal::launch {

RunWatch::RunWatch(const std::filesystem::path& run, const link::Hub& hub,
                   std::function<void(const std::string&)> say, WriteFaults* faults)
    : hub_(hub),
      say_(std::move(say)),
      faults_(*faults),
      log_(run / kMetricsFile, MetricsLogLimits()),
      own_report_(ProcessName::Coordinator()) {}

void RunWatch::OnReport(const MetricsMessage& report, SteadyTime now) {
  view_.OnMessage(report, now);
  WriteLine(report);
}

void RunWatch::WriteLine(const MetricsMessage& report) {
  log_.Write(report);
  faults_.Try(kMetricsFile, [this] { log_.Flush(); });
  if (!log_.full() || std::exchange(full_said_, true)) return;
  say_(fmt::format("{} has reached its size limit: it gets no more lines", kMetricsFile));
}

void RunWatch::LookBack(double seconds, uint64_t env_steps, const RunResources& resources) {
  recent_.Add({.seconds = seconds,
               .env_steps = static_cast<double>(env_steps),
               .updates = view_.Largest("learner", "updates")},
              TotalsOf(view_));
  lately_ = FindBottleneck(recent_.Totals(), resources);
}

std::vector<MetricsMessage> RunWatch::Reports(const ProgressFigures& figures, const Config& config,
                                              const RunResources& resources,
                                              const CoordinatorCounts& counts, SteadyTime now) {
  own_report_.Begin(figures.state);
  AddRunFigures(figures, &own_report_);
  AddOrders(config, resources, &own_report_);
  const auto add = [this](const char* name, uint64_t count) {
    own_report_.Add(name, static_cast<double>(count));
  };
  add("messages_dropped", counts.messages_dropped);
  add("metrics_lines_left_out", log_.lines_left_out());
  add("evaluations_repeated", counts.evaluations_repeated);
  add("evaluations_refused", counts.evaluations_refused);
  add("reports_refused", counts.reports_refused);
  if (counts.messages_dropped > dropped_said_) {
    const uint64_t former = std::exchange(dropped_said_, counts.messages_dropped);
    say_(fmt::format("{} report(s) dropped: they came faster than they were read",
                     counts.messages_dropped - former));
  }
  MetricsMessage own = own_report_.message();
  link::AddMalformed(hub_, &own);
  WriteLine(own);
  AddShares(lately_, &own);  // views only: the file has the counters they derive from
  view_.OnMessage(own, now);
  return view_.Reports(now);
}

}  // namespace shoal::launch
