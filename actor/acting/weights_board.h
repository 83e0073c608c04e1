// SPDX-License-Identifier: Apache-2.0
// Weights that one process of a host has received, in shared memory (common/base/shared_memory.h)
// for its neighbours: a board of fixed size, and memory of its own for each version, written once
// before the board names it. The board names the newest two, so that a reader that was late by one
// still finds what it looked up; what a reader has mapped stays whole.
//
//   board   0   8     magic "SHOALWB1"
//           8   16    token, random
//           24  8     observation spec's hash
//           32  8     number of the newest version, from 1; 0 = none yet, 2^64 - 1 = no more
//           40  2 x   descriptor, bytes (8 each): version n has place n mod 2
//   version 0   8     magic "SHOALWV1"
//           8   16    the board's token
//           24  8     number
//           32  16    weights session, weights update
//           48  8     env steps
//           then      payload
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "actor/acting/weights_inbox.h"
#include "common/base/shared_memory.h"

namespace shoal::actor {

// Address of a board within one host.
struct BoardAddress {
  int32_t pid = 0;
  int32_t descriptor = 0;
  std::array<uint64_t, 2> token{};

  bool operator==(const BoardAddress&) const = default;
};

// The receiving process's side. Owns the memory. Any thread, one at a time.
class WeightsBoard {
 public:
  // Throws Error: SharedMemory::Make.
  explicit WeightsBoard(uint64_t spec_hash);

  const BoardAddress& address() const { return address_; }
  // The checkpoint's name, which evaluations alone need, is left out. Without memory for them the
  // board is closed for good and Error is thrown.
  void Post(const ReceivedWeights& weights);

 private:
  const SharedMemory memory_;
  BoardAddress address_;
  uint64_t number_ = 0;
  std::array<Descriptor, 2> versions_;
};

// A neighbour's side. One thread.
class WeightsBoardReader {
 public:
  // Throws Error when no board of this spec lies there.
  WeightsBoardReader(const BoardAddress& address, uint64_t spec_hash);

  const BoardAddress& address() const { return address_; }
  // The newest version, once. Empty also where it has just been replaced: the next look finds its
  // successor.
  std::optional<ReceivedWeights> TryTake();
  // There will be no more.
  bool closed() const;
  // The last version that was looked up could not be read, and none since.
  bool failed() const { return failed_; }

 private:
  const BoardAddress address_;
  const SharedMemory memory_;
  uint64_t taken_ = 0;  // its number
  bool failed_ = false;
};

}  // namespace shoal::actor
