// SPDX-License-Identifier: Apache-2.0
// Shared memory (common/base/shared_memory.h) through which one process of a host passes received
// weights to its neighbours. There is a board of fixed size, and separate memory for each version.
// A version is written once, before the board names this version. The board names the newest two
// versions, so a reader that is late by one version still finds the version that it looked up.
// Mapped versions stay valid.
//
//   board   0   8     magic "SHOALWB1"
//           8   16    token, random
//           24  8     observation spec's hash
//           32  8     number of the newest version, from 1; 0 = none yet, 2^64 - 1 = closed
//           40  2 x   descriptor, bytes (8 each): version n is at index n mod 2
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

// Writing side, in the receiving process. Owns the memory. Any thread, one at a time.
class WeightsBoard {
 public:
  // Throws the errors of SharedMemory::Make.
  explicit WeightsBoard(uint64_t spec_hash);

  const BoardAddress& address() const { return address_; }
  // Adds a version, without the checkpoint's name, which only evaluations need. If memory for the
  // version cannot be allocated, closes the board permanently and throws Error.
  void Post(const ReceivedWeights& weights);

 private:
  const SharedMemory memory_;
  BoardAddress address_;
  uint64_t number_ = 0;
  std::array<Descriptor, 2> versions_;
};

// Reading side, in a neighbour process. One thread.
class WeightsBoardReader {
 public:
  // Throws Error if there is no board of this spec at the address.
  WeightsBoardReader(const BoardAddress& address, uint64_t spec_hash);

  const BoardAddress& address() const { return address_; }
  // Returns the newest version, each version once. Empty if there is no new version, or if the
  // version was replaced during the call; the next call then finds its successor.
  std::optional<ReceivedWeights> TryTake();
  // True if no further version will be added.
  bool closed() const;
  // True if the last version that was looked up could not be read, and no later version has been
  // read.
  bool failed() const { return failed_; }

 private:
  const BoardAddress address_;
  const SharedMemory memory_;
  uint64_t taken_ = 0;  // number of the last version taken
  bool failed_ = false;
};

}  // namespace shoal::actor
