// SPDX-License-Identifier: Apache-2.0
// Arrays of a user's environment as a record's frame and vector: images become frames, other arrays
// blocks. Actors and policies outside of training use the same conversion.
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
  // `spec` follows from `description` (hosted_spec.h). CHECK: it names no other arrays.
  ObservationMapping(const tasks::EnvironmentDescription& description, const ObservationSpec& spec);

  // `arrays` has the arrays of an observation in the description's order, each contiguous in C
  // order; arrays that neither a camera nor a block names are not read. `steps`, since the
  // episode's start, is for messages.
  //
  // Writes every block to `vector` (R). A number that is not finite is an EpisodeFault, and a part
  // of `vector` may be written then. Numbers outside of their declared bounds pass, with a warning
  // for the first of each array.
  void ReadVector(std::span<const void* const> arrays, int64_t steps, std::span<float> vector);
  // Writes the images of all cameras to `frame` (C, H, W).
  void ReadFrame(std::span<const void* const> arrays, std::span<uint8_t> frame);

  bool has_images() const { return !images_.empty(); }

 private:
  struct Image {
    size_t array = 0;  // of the observation
    ImageResize resize;
  };
  struct Block {
    size_t array = 0;  // of the observation
    size_t first = 0;  // of the vector
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
