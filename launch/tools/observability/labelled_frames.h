// SPDX-License-Identifier: Apache-2.0
// Frames of a task from random play, labelled with the numbers that a network is trained to
// predict.
//
// Dimensions: S samples, L labels, C channels of a frame (all cameras), H, W.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal::launch {

struct LabelledFrames {
  ObservationSpec spec;            // only frames are observed, no vectors
  int labels = 0;                  // L
  std::vector<uint8_t> frames;     // (S, C, H, W)
  std::vector<float> values;       // (S, L)
  std::vector<uint64_t> episodes;  // (S), number of the sample's episode, from 0
  size_t size() const { return episodes.size(); }
  const uint8_t* frame(size_t sample) const {
    return frames.data() + sample * size_t(spec.FrameBytes());
  }
};

// Collects `samples` frames of config.task from the cameras of config.observation, at the start of
// episodes and during their first steps of uniform random actions. The labels are those of sac.aux,
// interpreted by PrivilegedBlocksOf. Throws Error on an unknown task, camera or block.
LabelledFrames CollectLabelledFrames(const Config& config, int samples);

}  // namespace shoal::launch
