// SPDX-License-Identifier: Apache-2.0
// One episode in Minari's layout of an HDF5 file: T steps, T + 1 observations.
//
//   episode_N/                    attributes id = N, total_steps = T, env, episode (in the run)
//     observations/BLOCK          (T+1, size) f32: each recorded block, observed or not
//     observations/pixels         (T+1, C, H, W) u8: single frames, no stacks
//     actions                     (T, A) f32 in [-1, 1], as the actor chose them
//     rewards                     (T,) f32, unscaled
//     terminations, truncations   (T,) bool
//     infos/distance              (T+1,) f32, m; only for tasks with goals
//     infos/is_success            (T+1,) bool; only for tasks with goals
#pragma once

#include <cstdint>
#include <span>

#include "common/spec/observation_spec.h"
#include "launch/tools/dataset/hdf5_file.h"

namespace shoal::launch {

// Throws Error (usage) naming a block whose name cannot be the name of an array: a name with a
// slash, a single dot, or `pixels` if the spec has pixels.
void CheckArrayNames(const ObservationSpec& spec);

// Writes episode `number`. `records`: the records of the episode one after the other, first the
// reset, then at least one step. Each record has RecordLayout(spec).record_bytes() bytes and is
// aligned to 8. Throws the errors of Hdf5File.
void WriteEpisode(const ObservationSpec& spec, std::span<const uint8_t> records, uint64_t number,
                  Hdf5File* file);

}  // namespace shoal::launch
