// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/weights_board.h"

#include <unistd.h>

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>

#include "common/base/error.h"
#include "common/base/random_bytes.h"

namespace shoal::actor {
namespace {

constexpr uint64_t kBoardMagic = 0x3142574c414f4853;    // "SHOALWB1"
constexpr uint64_t kVersionMagic = 0x3156574c414f4853;  // "SHOALWV1"
constexpr uint64_t kBoardBytes = 4096;
constexpr uint64_t kClosed = UINT64_MAX;

struct Place {
  uint64_t descriptor, bytes;
};
struct Board {
  uint64_t magic;
  uint64_t token[2];
  uint64_t spec_hash;
  uint64_t newest;
  Place places[2];
};
struct Version {
  uint64_t magic;
  uint64_t token[2];
  uint64_t number;
  uint64_t session, update;
  uint64_t env_steps;
};
static_assert(std::endian::native == std::endian::little);
static_assert(offsetof(Board, newest) == 32 && sizeof(Board) == 72);
static_assert(sizeof(Version) == 56);

// A word that one process writes while others read. A reader that load(acquire)s the word sees
// everything that was written before its store(release).
std::atomic_ref<uint64_t> Word(uint64_t& word) {
  static_assert(std::atomic_ref<uint64_t>::is_always_lock_free);
  return std::atomic_ref<uint64_t>(word);
}

Board& BoardIn(const SharedMemory& memory) { return *reinterpret_cast<Board*>(memory.data()); }

bool SameToken(const uint64_t (&token)[2], const BoardAddress& address) {
  return token[0] == address.token[0] && token[1] == address.token[1];
}

std::array<uint64_t, 2> RandomToken() {
  std::array<uint64_t, 2> token{};
  FillWithRandomBytes(std::as_writable_bytes(std::span(token)));
  return token;
}

}  // namespace

WeightsBoard::WeightsBoard(uint64_t spec_hash)
    : memory_(SharedMemory::Make("shoal-weights-board", kBoardBytes)),
      address_{.pid = getpid(), .descriptor = memory_.descriptor(), .token = RandomToken()} {
  Board& board = BoardIn(memory_);
  board.token[0] = address_.token[0];
  board.token[1] = address_.token[1];
  board.spec_hash = spec_hash;
  board.magic = kBoardMagic;
}

void WeightsBoard::Post(const ReceivedWeights& weights) {
  Board& board = BoardIn(memory_);
  if (number_ == kClosed) return;
  ++number_;
  const uint64_t bytes = sizeof(Version) + weights.payload.size();
  const Version version{.magic = kVersionMagic,
                        .token = {address_.token[0], address_.token[1]},
                        .number = number_,
                        .session = weights.version.session,
                        .update = weights.version.update,
                        .env_steps = weights.env_steps};
  Descriptor& memory = versions_[number_ % 2];
  try {
    // Frees the older of two versions. Readers may still open the latest one.
    memory.Close();
    memory = SharedMemory::MakeOf(
        "shoal-weights",
        {{reinterpret_cast<const char*>(&version), sizeof version}, weights.payload.view()});
  } catch (const Error&) {
    number_ = kClosed;
    Word(board.newest).store(kClosed, std::memory_order_release);
    throw;
  }
  Place& place = board.places[number_ % 2];
  Word(place.descriptor).store(static_cast<uint64_t>(memory.get()), std::memory_order_relaxed);
  Word(place.bytes).store(bytes, std::memory_order_relaxed);
  Word(board.newest).store(number_, std::memory_order_release);
}

WeightsBoardReader::WeightsBoardReader(const BoardAddress& address, uint64_t spec_hash)
    : address_(address), memory_(SharedMemory::Open(address.pid, address.descriptor, kBoardBytes)) {
  const Board& board = BoardIn(memory_);
  if (board.magic != kBoardMagic || !SameToken(board.token, address)) {
    throw RuntimeError("the shared memory of process {} is no board of weights", address.pid);
  }
  if (board.spec_hash != spec_hash) {
    throw RuntimeError(
        "the weights of process {} are of observation spec {:016x}, expected {:016x}", address.pid,
        board.spec_hash, spec_hash);
  }
}

bool WeightsBoardReader::closed() const {
  return Word(BoardIn(memory_).newest).load(std::memory_order_acquire) == kClosed;
}

std::optional<ReceivedWeights> WeightsBoardReader::TryTake() {
  Board& board = BoardIn(memory_);
  const uint64_t number = Word(board.newest).load(std::memory_order_acquire);
  if (number == taken_ || number == kClosed) return std::nullopt;
  Place& place = board.places[number % 2];
  const auto descriptor =
      static_cast<int32_t>(Word(place.descriptor).load(std::memory_order_relaxed));
  const uint64_t bytes = Word(place.bytes).load(std::memory_order_relaxed);
  // The writer may have posted two newer versions meanwhile, or its process may have ended. The
  // descriptor then belongs to other memory, or to none.
  failed_ = true;
  std::shared_ptr<const SharedMemory> memory;
  try {
    memory = std::make_shared<SharedMemory>(SharedMemory::Open(address_.pid, descriptor, bytes));
  } catch (const Error&) {
    return std::nullopt;
  }
  Version version{};
  if (bytes < sizeof version) return std::nullopt;
  std::memcpy(&version, memory->data(), sizeof version);
  if (version.magic != kVersionMagic || !SameToken(version.token, address_) ||
      version.number != number) {
    return std::nullopt;
  }
  taken_ = number;
  failed_ = false;
  const auto* payload = reinterpret_cast<const char*>(memory->data()) + sizeof version;
  return ReceivedWeights{.version = {version.session, version.update},
                         .env_steps = version.env_steps,
                         .checkpoint = {},
                         .payload = {memory, {payload, bytes - sizeof version}}};
}

}  // namespace shoal::actor
