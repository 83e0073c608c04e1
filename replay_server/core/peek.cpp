// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/peek.h"

#include <algorithm>
#include <optional>
#include <span>
#include <type_traits>

#include "common/base/aligned_bytes.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "common/config/run_files.h"
#include "common/config/sequences.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/batch_schema.h"
#include "replay_server/core/batch_gather.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/replay_core.h"
#include "replay_server/core/replay_policies.h"
#include "replay_server/core/ring.h"

namespace shoal::replay {
namespace {

constexpr int kBorder = 2;     // pixels between images
constexpr int kAttempts = 20;  // while a server overwrites the drawn records

// A batch with its own memory.
struct Batch {
  Batch(const ObservationSpec& spec, int size)
      : schema(spec, {.batch = size}), memory(schema.total_bytes()) {}
  BatchView View() const { return schema.View(memory.data()); }

  BatchSchema schema;
  AlignedBytes memory;
};

BatchPlan WithoutShift(BatchPlan plan) {
  for (BatchPlan::Element& element : plan.elements) element.obs = element.next_obs = {};
  return plan;
}

// Whether every record that the plan's elements need is still intact: the stack before the first
// step, that step, the steps after it, and the record that shows the goal. The server overwrites
// the oldest record first, but any record may be half overwritten.
bool StillThere(const Ring& ring, const EpisodeIndex& index, const BatchPlan& plan,
                const RunConfig& run) {
  const auto there = [&ring](uint64_t id) { return ring.Holds(id) && ring.Intact(id); };
  for (const BatchPlan::Element& element : plan.elements) {
    uint64_t id = element.id;
    if (!there(id) || (element.goal != 0 && !there(element.goal))) return false;
    if (run.spec.goal_picture && !there(index.GoalRecord(id))) return false;
    const int steps = SampleStepsOf(run.config);
    for (int k = 1; k < steps && index.Next(id) != 0; ++k) id = index.Next(id);
    const int records = steps + run.spec.stack;
    for (int k = 0; k < records && id != 0; ++k) {
      if (!there(id)) return false;
      id = ring.Slot(id).prev;
    }
  }
  return true;
}

std::string Caption(const Ring& ring, uint64_t id) {
  const RecordHeader& header = ring.Header(id);
  return fmt::format("record {} env {} episode {} index {} reward {:.3f}{}{}{}", id, header.env,
                     header.episode, header.index, header.reward,
                     (header.flags & kTerminated) != 0 ? " terminated" : "",
                     (header.flags & kTruncated) != 0 ? " truncated" : "",
                     (header.flags & kSuccess) != 0 ? " success" : "");
}

// Paints camera images of a batch into the picture.
class Painter {
 public:
  Painter(const ObservationSpec& spec, int batch, Peek* peek) : spec_(spec), peek_(*peek) {
    cameras_ = std::max(1, static_cast<int>(spec.cameras.size()));
    planes_ = spec.channels / cameras_;
    rows_ = spec.goal_picture ? 5 : 4;
    peek_.width = batch * (spec.width + kBorder) + kBorder;
    peek_.height = cameras_ * rows_ * (spec.height + kBorder) + kBorder;
    peek_.rgb.assign(static_cast<size_t>(peek_.width) * peek_.height * 3, 64);
  }

  // Paints the newest frame of each of the `inputs` (B, I, H, W) into row `row` of every camera.
  void PaintRow(std::span<const uint8_t> inputs, int row) {
    PaintFrames(inputs, spec_.stack - 1, row);
  }
  // Paints the goal picture of each input into the last row.
  void PaintGoals(std::span<const uint8_t> inputs) { PaintFrames(inputs, spec_.stack, rows_ - 1); }

 private:
  // Paints frame `k` of each input.
  void PaintFrames(std::span<const uint8_t> inputs, int k, int row) {
    const auto input_bytes = static_cast<size_t>(spec_.InputBytes());
    const size_t before = static_cast<size_t>(k) * static_cast<size_t>(spec_.FrameBytes());
    for (size_t b = 0; b < inputs.size() / input_bytes; ++b) {
      for (int camera = 0; camera < cameras_; ++camera) {
        const uint8_t* image = inputs.data() + b * input_bytes + before +
                               static_cast<size_t>(camera * planes_ * spec_.height * spec_.width);
        PaintImage(image, static_cast<int>(b), camera * rows_ + row);
      }
    }
  }
  // `image`: planes_ planes (H, W). A grey image is painted with red = green = blue.
  void PaintImage(const uint8_t* image, int column, int row) {
    const int left = kBorder + column * (spec_.width + kBorder);
    const int top = kBorder + row * (spec_.height + kBorder);
    for (int i = 0; i < spec_.height; ++i) {
      for (int j = 0; j < spec_.width; ++j) {
        uint8_t* pixel = &peek_.rgb[(static_cast<size_t>(top + i) * peek_.width + left + j) * 3];
        for (int c = 0; c < 3; ++c) {
          pixel[c] = image[(std::min(c, planes_ - 1) * spec_.height + i) * spec_.width + j];
        }
      }
    }
  }

  const ObservationSpec& spec_;
  Peek& peek_;
  int cameras_, planes_, rows_;  // rows_: for each camera
};

// Elements drawn from a ring, and the objects that gather them.
struct Draw {
  const Ring& ring;
  const EpisodeIndex& index;
  const BatchPlan& plan;
  const BatchGather& gather;
};

// One attempt: returns look(draw), or nothing if the server overwrote the draw.
template <class Look>
auto TryLook(const RunConfig& run, const std::filesystem::path& file, int batch, const Look& look,
             Random* random) -> std::optional<std::invoke_result_t<Look, const Draw&>> {
  const Ring ring = Ring::OpenSnapshot(run.spec, file);
  const EpisodeIndex index(ring, IndexOptionsOf(run));
  if (index.sampleable() == 0) {
    throw RuntimeError("replay file '{}' holds no step that can be sampled", file.string());
  }
  const ReplayPolicies policies = MakePolicies(run, ring, index);
  const PlanOptions options{.batch = batch, .shift_pad = run.config.replay.shift_pad};
  const auto plan = DrawPlan(options, policies.selector.get(), policies.relabeller.get(), random);
  if (!plan || !StillThere(ring, index, *plan, run)) return std::nullopt;
  const BatchGather gather(ring, index, run.spec, NStepOf(run.config), policies.goals.get());
  auto seen = look({ring, index, *plan, gather});
  if (!StillThere(ring, index, *plan, run)) return std::nullopt;
  return seen;
}

template <class Look>
auto LookIntoRing(const RunConfig& run, const std::filesystem::path& folder, int batch,
                  uint64_t seed, const Look& look) {
  if (run.config.replay.storage != "file") {
    throw UsageError("the run in '{}' keeps its replay in memory (replay.storage): nothing to see",
                     folder.string());
  }
  CheckRingIsThere(folder / kRingFile);
  Random random(StreamKey(seed, StreamRole::kReplaySampler));
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (auto seen = TryLook(run, folder / kRingFile, batch, look, &random)) {
      return *std::move(seen);
    }
  }
  throw RuntimeError("replay file '{}' is overwritten faster than it can be read",
                     (folder / kRingFile).string());
}

Peek Paint(const RunConfig& run, int batch, const Draw& draw) {
  const Batch plain(run.spec, batch), shifted(run.spec, batch);
  draw.gather.Gather(WithoutShift(draw.plan), plain.View());
  draw.gather.Gather(draw.plan, shifted.View());
  Peek peek;
  peek.records = draw.ring.last_id() - draw.ring.oldest_id() + 1;
  peek.sampleable = draw.index.sampleable();
  for (const BatchPlan::Element& e : draw.plan.elements) {
    peek.captions.push_back(Caption(draw.ring, e.id));
  }
  if (!run.spec.HasPixels()) return peek;
  Painter painter(run.spec, batch, &peek);
  painter.PaintRow(plain.View().obs_frames, 0);
  painter.PaintRow(shifted.View().obs_frames, 1);
  painter.PaintRow(plain.View().next_obs_frames, 2);
  painter.PaintRow(shifted.View().next_obs_frames, 3);
  if (run.spec.goal_picture) painter.PaintGoals(plain.View().obs_frames);
  return peek;
}

}  // namespace

std::string DescribeMissingRing(const std::filesystem::path& file) {
  return fmt::format(
      "there is no '{}': a run that has finished keeps its replay with --set replay.keep=true only",
      file.string());
}

void CheckRingIsThere(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw UsageError("{}", DescribeMissingRing(file));
}

Peek PeekBatch(const std::filesystem::path& folder, int batch, uint64_t seed) {
  const RunConfig run = ReadRunConfig(folder);
  return LookIntoRing(run, folder, batch, seed,
                      [&](const Draw& draw) { return Paint(run, batch, draw); });
}

PeekedObservations PeekObservations(const std::filesystem::path& folder, int batch, uint64_t seed) {
  const RunConfig run = ReadRunConfig(folder);
  return LookIntoRing(run, folder, batch, seed, [&](const Draw& draw) {
    const Batch plain(run.spec, batch);
    draw.gather.Gather(WithoutShift(draw.plan), plain.View());
    const BatchView view = plain.View();
    return PeekedObservations{{view.obs_frames.begin(), view.obs_frames.end()},
                              {view.obs_vector.begin(), view.obs_vector.end()}};
  });
}

}  // namespace shoal::replay
