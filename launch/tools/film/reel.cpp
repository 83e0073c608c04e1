// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/reel.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kUnknownStep = 40'000;      // microseconds, if a stream has no duration
constexpr uint32_t kShortestPicture = 20'000;  // 50 a second: screens show no more
constexpr uint32_t kLongestStep = 10'000'000;  // longest plausible step of a task
constexpr uint32_t kLastPicture = 500'000;

// Checks the header of a stream from another process.
void CheckHeader(const image::FrameStreamHeader& header, const ObservationSpec& spec,
                 const fs::path& stream) {
  const auto number = [](int value) { return static_cast<uint32_t>(value); };
  const bool input = header.channels == number(spec.InputChannels()) &&
                     header.frame_channels == number(spec.channels) &&
                     header.height == number(spec.height) && header.width == number(spec.width) &&
                     header.action_size == number(spec.action_size);
  if (!input || header.view_height != kFilmView || header.view_width != kFilmView) {
    throw RuntimeError(
        "'{}' has frames of {} x {} x {}, a view of {} x {} and {} action components; expected {} "
        "x "
        "{} x {}, {} x {} and {}",
        stream.string(), header.channels, header.height, header.width, header.view_height,
        header.view_width, header.action_size, spec.InputChannels(), spec.height, spec.width,
        kFilmView, kFilmView, spec.action_size);
  }
  if (header.step_microseconds > kLongestStep) {
    throw RuntimeError("'{}': env steps of {} microseconds are no task's", stream.string(),
                       header.step_microseconds);
  }
}

// Checks the order of a stream's records: each episode from its reset to its end, step by step.
class EpisodeOrder {
 public:
  EpisodeOrder(const fs::path& stream, uint32_t episodes) : stream_(stream), episodes_(episodes) {}

  void Next(const image::FrameRecordHeader& record) {
    if (record.episode != episode_ || record.step != step_ || episode_ >= episodes_) {
      throw RuntimeError("'{}': step {} of episode {} where step {} of episode {} of {} was due",
                         stream_.string(), record.step, record.episode, step_, episode_, episodes_);
    }
    if (!std::isfinite(record.reward)) {
      throw RuntimeError("'{}': the reward of step {} of episode {} is {}", stream_.string(),
                         record.step, record.episode, record.reward);
    }
    const bool end = (record.flags & image::kShownEnd) != 0;
    episode_ += end;
    step_ = end ? 0 : step_ + 1;
  }
  void End() const {
    if (episode_ == episodes_) return;
    throw RuntimeError("'{}' ends before step {} of episode {} of {}", stream_.string(), step_,
                       episode_, episodes_);
  }

 private:
  const fs::path stream_;
  const uint32_t episodes_;
  uint32_t episode_ = 0, step_ = 0;  // expected next
};

}  // namespace

FilmReel::FilmReel(const ObservationSpec& spec, const fs::path& output)
    : spec_(spec), output_(output), picture_(spec) {
  text_.title = spec.task;
}

void FilmReel::Begin(const image::FrameStreamHeader& header) {
  if (file_) return;
  const uint32_t step = header.step_microseconds > 0 ? header.step_microseconds : kUnknownStep;
  stride_ = (kShortestPicture + step - 1) / step;
  picture_microseconds_ = stride_ * step;
  const FilmLayout& layout = picture_.layout();
  file_.emplace(output_, layout.width, layout.height, picture_microseconds_);
}

void FilmReel::Add(const fs::path& stream, const std::string& subtitle, uint32_t episodes,
                   FilmStrip* strip) {
  image::FrameStreamReader reader(stream);
  CheckHeader(reader.header(), spec_, stream);
  Begin(reader.header());
  text_.subtitle = subtitle;
  text_.episodes = episodes;
  EpisodeOrder order(stream, episodes);
  while (const auto frame = reader.Next()) {
    order.Next(frame->record);
    Show(*frame, frame->record.episode == 0 ? strip : nullptr);
  }
  order.End();
}

void FilmReel::Show(const image::ShownFrame& frame, FilmStrip* strip) {
  const image::FrameRecordHeader& record = frame.record;
  const bool reset = record.step == 0, end = (record.flags & image::kShownEnd) != 0;
  text_.episode = record.episode + 1;
  text_.step = record.step;
  text_.reward = reset ? std::nullopt : std::optional(record.reward);
  text_.episode_return = reset ? 0 : text_.episode_return + double{record.reward};
  text_.success = (record.flags & image::kShownSuccess) != 0;
  if (!end && record.step % stride_ != 0) return;
  picture_.Draw(text_, frame.input, frame.view);
  if (strip != nullptr) {
    const FilmLayout& layout = picture_.layout();
    strip->Add({layout.width, layout.height, picture_.stride(), picture_.pixels()});
  }
  const uint32_t times = end ? std::max(1U, kLastPicture / picture_microseconds_) : 1;
  for (uint32_t i = 0; i < times; ++i) file_->Add(picture_.pixels(), picture_.stride());
}

void FilmReel::Finish() {
  CHECK(file_.has_value());
  file_->Finish();
}

uint64_t FilmReel::frames() const { return file_ ? file_->frames() : 0; }

double FilmReel::seconds() const {
  return 1e-6 * static_cast<double>(frames()) * picture_microseconds_;
}

}  // namespace shoal::launch
