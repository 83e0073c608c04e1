// SPDX-License-Identifier: Apache-2.0
// Takes the numbers of the progress display from reports, for the coordinator and for other
// programs.
#pragma once

#include "common/config/config.h"
#include "common/wire/metrics_report.h"
#include "launch/watch/bottleneck.h"
#include "launch/watch/metrics_view.h"
#include "launch/watch/progress.h"
#include "launch/watch/recent_run.h"

namespace shoal::launch {

// Sets the members that processes report; the other members keep their initial values.
ProgressFigures CollectFigures(const MetricsView& view, SteadyTime now);

// Replaces the one-second rates by 30-second rates. Adds the shares of time in which the limiter
// held back actors and learner (`lately`: computed from recent.Totals()), and the time left until
// `figures->budget`.
void AddLately(const RecentRun& recent, const Bottleneck& lately, ProgressFigures* figures);

// Adds to the coordinator's report the numbers that no other process reports.
void AddRunFigures(const ProgressFigures& figures, MetricsReport* report);
// Adds budget, stop rule and resources of the run, with their present values.
void AddOrders(const Config& config, const RunResources& resources, MetricsReport* report);
// Adds the recent shares of time to the coordinator's report in a view.
void AddShares(const Bottleneck& lately, MetricsMessage* report);
// One sentence from a view: advice on speed or, while the run ends, its present stage.
std::string AdviceOfView(const RunViewMessage& view);
// The numbers of a view, in the form of the run's own progress display.
ProgressFigures FiguresOfView(const RunViewMessage& view, SteadyTime now);

}  // namespace shoal::launch
