// SPDX-License-Identifier: Apache-2.0
// Which reported figures make up the progress display, in the coordinator and far from it.
#pragma once

#include "common/config/config.h"
#include "common/wire/metrics_report.h"
#include "launch/watch/bottleneck.h"
#include "launch/watch/metrics_view.h"
#include "launch/watch/progress.h"
#include "launch/watch/recent_run.h"

namespace shoal::launch {

// Fills the figures that processes report; the others keep their defaults.
ProgressFigures CollectFigures(const MetricsView& view, SteadyTime now);

// Replaces rates of the last second by those of late, and adds who was held back (`lately`: of
// recent.Totals()) and the time left of `figures->budget`.
void AddLately(const RecentRun& recent, const Bottleneck& lately, ProgressFigures* figures);

// Adds what the coordinator alone knows to its own report.
void AddRunFigures(const ProgressFigures& figures, MetricsReport* report);
// Adds what is asked of the run, with the present values.
void AddOrders(const Config& config, const RunResources& resources, MetricsReport* report);
// Adds where the time has gone lately to the coordinator's report in a view.
void AddShares(const Bottleneck& lately, MetricsMessage* report);
// One sentence: what to do about it, from a view; or what the run is at when it ends.
std::string AdviceOfView(const RunViewMessage& view);
// The figures of a view, in the form of the run's own progress display.
ProgressFigures FiguresOfView(const RunViewMessage& view, SteadyTime now);

}  // namespace shoal::launch
