// SPDX-License-Identifier: Apache-2.0
// Converts arrays of a user's environment to a record's frame and vector: images become frames,
// other arrays become blocks. Actors and deployed policies use the same conversion.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "actor/hosted/image_resize.h"
#include "common/spec/observation_spec.h"
#include "common/tasks/environment_description.h"

namespace shoal::hosted {

class ObservationMapping {
 public:
  // `spec` was computed from `description` (hosted_spec.h). CHECK: `spec` names only arrays of
  // `description`.
  ObservationMapping(const tasks::EnvironmentDescription& description, const ObservationSpec& spec);

  // Writes every block to `vector` (R). `arrays`: the arrays of an observation in the description's
  // order, each contiguous in C order. Arrays that are neither a camera nor a block are not read.
  // `steps`: steps since the episode's start, for messages.
  //
  // Throws EpisodeFault if a number is not finite; a part of `vector` may then have been written.
  // Numbers outside their declared bounds are accepted; the first such number of each array is
  // logged as a warning.
  void ReadVector(std::span<const void* const> arrays, int64_t steps, std::span<float> vector);
  // Writes the images of all cameras to `frame` (C, H, W).
  void ReadFrame(std::span<const void* const> arrays, std::span<uint8_t> frame);

  bool has_images() const { return !images_.empty(); }

 private:
  struct Image {
    size_t array = 0;  // index in the observation
    ImageResize resize;
  };
  struct Block {
    size_t array = 0;  // index in the observation
    size_t first = 0;  // index in the vector
    tasks::ArraySpace space;
    bool bounded = false, warned = false;
  };

  void CheckNumbers(std::span<const float> numbers, int64_t steps, Block* block) const;
  void WarnOutside(size_t element, float value, int64_t steps, Block* block) const;

  const std::string id_;  // of the environment
  const size_t plane_;    // H * W
  std::vector<Image> images_;
  std::vector<Block> blocks_;
};

}  // namespace shoal::hosted
