// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/frame_figures.h"

#include <algorithm>

#include "common/nn/frame_pooling.h"
#include "common/nn/parallel.h"
#include "learner/agent/frozen_cameras.h"

namespace shoal::learner {
namespace {

constexpr int kSpreadFrames = 32;

}  // namespace

void AddFrameFigures(const BatchView& batch, const ObservationSpec& spec, int shift_pad,
                     UpdateFigures* figures) {
  if (!spec.HasPixels()) return;
  const nn::ThreadScope scope(1);  // waking other threads would take longer
  const int frames = std::min(int(batch.reward.size()), kSpreadFrames);
  figures->Set(kFrameSpread,
               nn::MeanFrameSpread(batch.obs_frames.data(), frames, spec.InputBytes()));
  figures->Set(kFrozenCameras, FrozenCameras(batch.obs_frames, spec, shift_pad));
}

}  // namespace shoal::learner
