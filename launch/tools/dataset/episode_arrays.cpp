// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/dataset/episode_arrays.h"

#include <fmt/core.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/spec/record.h"

namespace shoal::launch {
namespace {

// The records of one episode, read as arrays.
class Episode {
 public:
  Episode(const ObservationSpec& spec, std::span<const uint8_t> records)
      : layout_(spec), records_(records), count_(records.size() / RecordBytes()) {
    CHECK(records.size() == count_ * RecordBytes() && count_ >= 2);
  }

  uint64_t count() const { return count_; }  // T + 1
  const RecordHeader& Header(uint64_t i) const { return RecordLayout::Header(At(i)); }
  // The floats of `range` of every record's vector.
  std::vector<float> Vectors(const ObservationSpec::Range& range) const {
    std::vector<float> values;
    for (uint64_t i = 0; i < count_; ++i) {
      const auto part = layout_.Vector(At(i)).subspan(size_t(range.first), size_t(range.size));
      values.insert(values.end(), part.begin(), part.end());
    }
    return values;
  }
  std::vector<uint8_t> Frames() const {
    std::vector<uint8_t> frames;
    frames.reserve(count_ * size_t(layout_.frame_bytes()));
    for (uint64_t i = 0; i < count_; ++i) {
      const auto frame = layout_.Frame(At(i));
      frames.insert(frames.end(), frame.begin(), frame.end());
    }
    return frames;
  }
  // Actions of the steps, without the reset.
  std::vector<float> Actions() const {
    std::vector<float> actions;
    for (uint64_t i = 1; i < count_; ++i) {
      const auto action = layout_.Action(At(i));
      actions.insert(actions.end(), action.begin(), action.end());
    }
    return actions;
  }
  // Whether each record from `first` on has the flag.
  std::vector<uint8_t> Flags(RecordFlags flag, uint64_t first) const {
    std::vector<uint8_t> flags;
    for (uint64_t i = first; i < count_; ++i)
      flags.push_back((Header(i).flags & flag) != 0 ? 1 : 0);
    return flags;
  }
  // One number of the header of each record from `first` on.
  std::vector<float> Numbers(float RecordHeader::*number, uint64_t first) const {
    std::vector<float> numbers;
    for (uint64_t i = first; i < count_; ++i) numbers.push_back(Header(i).*number);
    return numbers;
  }

 private:
  size_t RecordBytes() const { return size_t(layout_.record_bytes()); }
  const uint8_t* At(uint64_t i) const { return records_.data() + i * RecordBytes(); }

  const RecordLayout layout_;
  const std::span<const uint8_t> records_;
  const uint64_t count_;
};

}  // namespace

void CheckArrayNames(const ObservationSpec& spec) {
  for (const BlockSpec& block : spec.blocks) {
    const std::string& name = block.name;
    if (name.empty() || name == "." || name.find('/') != std::string::npos ||
        (name == "pixels" && spec.HasPixels())) {
      throw UsageError("the block '{}' of task {} cannot be exported: no name for an array", name,
                       spec.task);
    }
  }
}

void WriteEpisode(const ObservationSpec& spec, std::span<const uint8_t> records, uint64_t number,
                  Hdf5File* file) {
  const Episode episode(spec, records);
  const uint64_t observations = episode.count(), steps = observations - 1;
  const std::string group = fmt::format("episode_{}", number);
  for (const BlockSpec& block : spec.blocks) {
    const auto values = episode.Vectors(*spec.Recorded(block.name));
    file->Write(group + "/observations/" + block.name, {observations, uint64_t(block.size)},
                values);
  }
  if (spec.HasPixels()) {
    const std::vector<uint64_t> shape = {observations, uint64_t(spec.channels),
                                         uint64_t(spec.height), uint64_t(spec.width)};
    file->Write(group + "/observations/pixels", shape, episode.Frames());
  }
  file->Write(group + "/actions", {steps, uint64_t(spec.action_size)}, episode.Actions());
  file->Write(group + "/rewards", {steps}, episode.Numbers(&RecordHeader::reward, 1));
  file->WriteFlags(group + "/terminations", episode.Flags(kTerminated, 1));
  file->WriteFlags(group + "/truncations", episode.Flags(kTruncated, 1));
  const std::vector<float> distances = episode.Numbers(&RecordHeader::distance, 0);
  if (!std::isnan(distances.back())) {
    file->Write(group + "/infos/distance", {observations}, distances);
    file->WriteFlags(group + "/infos/is_success", episode.Flags(kSuccess, 0));
  }
  file->SetAttribute(group, "id", int64_t(number));
  file->SetAttribute(group, "total_steps", int64_t(steps));
  file->SetAttribute(group, "env", episode.Header(0).env);
  file->SetAttribute(group, "episode", episode.Header(0).episode);
}

}  // namespace shoal::launch
