// Which reported figures make up the progress display, in the coordinator and far from it.
#pragma once

#include "common/config/config.h"
#include "common/wire/metrics_report.h"
#include "launch/watch/metrics_view.h"
#include "launch/watch/progress.h"

namespace shoal::launch {

// Fills the figures that processes report; the others keep their defaults.
ProgressFigures CollectFigures(const MetricsView& view, SteadyTime now);

// Adds what the coordinator alone knows to its own report.
void AddRunFigures(const ProgressFigures& figures, MetricsReport* report);
// Adds what is asked of the run, with the present values.
void AddOrders(const Config& config, int usable_cores, MetricsReport* report);
// What a view shows, as the run's own progress display has it.
ProgressFigures FiguresOfView(const RunViewMessage& view, SteadyTime now);

}  // namespace shoal::launch
