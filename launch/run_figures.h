// Which reported figures make up the progress display.
#pragma once

#include "launch/metrics_view.h"
#include "launch/progress.h"

namespace shoal::launch {

// Fills the figures that processes report; the others keep their defaults.
ProgressFigures CollectFigures(const MetricsView& view, SteadyTime now);

}  // namespace shoal::launch
