// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/observability/labelled_frames.h"

#include <algorithm>

#include "actor/worlds/environment.h"
#include "common/base/random.h"
#include "common/config/privileged_blocks.h"

namespace shoal::launch {
namespace {

// Random play hardly moves object and goal, so short episodes, which draw both again, vary them.
constexpr int kStepsPerEpisode = 9;

std::vector<float> LabelsOf(const PrivilegedBlocks& blocks, const ObservationSpec& spec,
                            std::span<const float> recorded) {
  std::vector<float> values;
  for (const AuxLabel& label : blocks.labels) {
    const auto of = [&](const std::string& block, int i) {
      return recorded[size_t(spec.Recorded(block)->first + i)];
    };
    for (int i = 0; i < label.size; ++i) {
      values.push_back(of(label.block, i) - (label.minus.empty() ? 0 : of(label.minus, i)));
    }
  }
  return values;
}

}  // namespace

LabelledFrames CollectLabelledFrames(const Config& config, int samples) {
  const auto environment =
      worlds::MakeEnvironment(config, worlds::MakeRenderContext(config.observation));
  const ObservationSpec& spec = environment->spec();
  const PrivilegedBlocks blocks = PrivilegedBlocksOf(config, spec);
  LabelledFrames collected;
  collected.spec = spec;
  for (BlockSpec& block : collected.spec.blocks) block.observed = false;
  for (const AuxLabel& label : blocks.labels) collected.labels += label.size;

  std::vector<uint8_t> frame(size_t(spec.FrameBytes()));
  std::vector<float> vector(size_t(spec.RecordedVectorSize()));
  const auto seed = uint64_t(config.seed);
  Random random(StreamKey(seed, StreamRole::kTrainPolicy));
  std::vector<float> action(size_t(spec.action_size));
  const auto keep = [&](uint64_t episode) {
    collected.frames.insert(collected.frames.end(), frame.begin(), frame.end());
    const std::vector<float> values = LabelsOf(blocks, spec, vector);
    collected.values.insert(collected.values.end(), values.begin(), values.end());
    collected.episodes.push_back(episode);
  };
  for (uint64_t episode = 0; collected.size() < size_t(samples); ++episode) {
    environment->Reset(StreamKey(seed, StreamRole::kTrainEnvironment, episode), {frame, vector});
    keep(episode);
    for (int step = 0; step < kStepsPerEpisode && collected.size() < size_t(samples); ++step) {
      for (float& component : action) component = float(random.Uniform(-1, 1));
      const worlds::StepResult result = environment->Step(action, {frame, vector});
      keep(episode);
      if (result.terminated || result.truncated) break;
    }
  }
  return collected;
}

}  // namespace shoal::launch
