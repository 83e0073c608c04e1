// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/frame_recorder.h"

#include <utility>

namespace shoal::actor {
namespace {

image::FrameStreamHeader HeaderOf(const ObservationSpec& seen, const EpisodeView& view) {
  return {.magic = {},
          .channels = static_cast<uint32_t>(seen.InputChannels()),
          .height = static_cast<uint32_t>(seen.height),
          .width = static_cast<uint32_t>(seen.width),
          .frame_channels = static_cast<uint32_t>(seen.channels),
          .view_height = static_cast<uint32_t>(view.height()),
          .view_width = static_cast<uint32_t>(view.width()),
          .action_size = static_cast<uint32_t>(seen.action_size),
          .step_microseconds = view.step_microseconds()};
}

}  // namespace

FrameRecorder::FrameRecorder(const ObservationSpec& spec, const std::filesystem::path& file,
                             std::unique_ptr<EpisodeView> view)
    : view_(std::move(view)),
      picture_(size_t{3} * static_cast<size_t>(view_->height() * view_->width())),
      writer_(file, HeaderOf(spec, *view_)),
      no_action_(static_cast<size_t>(spec.action_size), 0.0F) {}

void FrameRecorder::OnBegin(uint64_t stream_key, std::span<const uint8_t> stack) {
  view_->Begin(stream_key, picture_);
  step_ = 0;
  running_ = true;
  writer_.Write({.episode = episode_, .step = step_, .reward = 0, .flags = 0}, no_action_, stack,
                picture_);
}

void FrameRecorder::OnStep(const SeenStep& step) {
  view_->Step(step.action, step.reward, picture_);
  ++step_;
  const uint32_t flags =
      (step.success ? image::kShownSuccess : 0U) | (step.ended ? image::kShownEnd : 0U);
  writer_.Write({.episode = episode_, .step = step_, .reward = step.reward, .flags = flags},
                step.action, step.stack, picture_);
  if (step.ended) ++episode_;
  running_ = !step.ended;
}

void FrameRecorder::OnFault(std::span<const uint8_t> stack) {
  writer_.Write({.episode = episode_,
                 .step = running_ ? step_ + 1 : 0,
                 .reward = 0,
                 .flags = image::kShownEnd},
                no_action_, stack, picture_);
  ++episode_;
  running_ = false;
}

}  // namespace shoal::actor
