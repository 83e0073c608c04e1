// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/host_weights.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::actor {
namespace {

// Interval between looks while no board can be read yet.
constexpr std::chrono::milliseconds kFirstLooks{50};

std::string ToText(const BoardAddress& address) {
  return nlohmann::json{
      {"pid", address.pid}, {"descriptor", address.descriptor}, {"token", address.token}}
      .dump();
}

// Throws Error or nlohmann::json::exception.
BoardAddress ReadAddress(const std::filesystem::path& file) {
  const auto json = ParseBoundedJson<nlohmann::json>(ReadFile(file));
  return {.pid = json.at("pid").get<int32_t>(),
          .descriptor = json.at("descriptor").get<int32_t>(),
          .token = json.at("token").get<std::array<uint64_t, 2>>()};
}

// Reads the third field of /proc/PID/stat. The field follows the name in brackets.
bool IsStopped(int32_t pid) {
  try {
    const std::string stat = ReadFile(fmt::format("/proc/{}/stat", pid));
    const size_t name_end = stat.rfind(')');
    return name_end != std::string::npos && name_end + 2 < stat.size() &&
           (stat[name_end + 2] == 'T' || stat[name_end + 2] == 't');
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

HostWeights::HostWeights(const std::filesystem::path& run, const std::string& host,
                         uint64_t spec_hash, Subscribe subscribe)
    : lock_file_(run / kMadeFolder / fmt::format("weights-{}.lock", host)),
      address_file_(run / kMadeFolder / fmt::format("weights-{}.json", host)),
      spec_hash_(spec_hash),
      subscribe_(std::move(subscribe)),
      inbox_(spec_hash, [this](const ReceivedWeights& weights) { Post(weights); }) {}

std::optional<ReceivedWeights> HostWeights::TryTake() {
  if (const SteadyTime now = Now(); !receives() && now >= next_look_) Look(now);
  auto weights = receives() ? inbox_.TryTake() : reader_ ? reader_->TryTake() : std::nullopt;
  // A process that takes over the subscription receives versions again that it has already read
  // from the board.
  if (!weights || !weights->version.NewerThan(taken_)) return std::nullopt;
  taken_ = weights->version;
  return weights;
}

void HostWeights::Look(SteadyTime now) {
  if (TryReceiveForHost()) return;
  const std::string fault = OpenBoard();
  next_look_ = now + (reader_ ? SteadyTime::duration(kLook) : kFirstLooks);
  if (fault.empty()) {
    useless_since_.reset();
    return;
  }
  if (!useless_since_) useless_since_ = now;
  if (now - *useless_since_ >= kPatience) ReceiveAlone(fault);
}

bool HostWeights::TryReceiveForHost() {
  try {
    lock_ = FileLock::Take(lock_file_);
    if (!lock_) return false;
    board_ = std::make_unique<WeightsBoard>(spec_hash_);
    WriteFileAtomically(address_file_, ToText(board_->address()));
  } catch (const Error& e) {
    // Keeps the lock: a neighbour that took the lock would fail as well, and a process that cannot
    // read a board receives the weights itself.
    board_.reset();
    ReceiveAlone(e.what());
    return true;
  }
  reader_.reset();
  subscription_ = subscribe_(inbox_);
  log::Info("receives the weights for the actors of this host");
  return true;
}

std::string HostWeights::OpenBoard() {
  try {
    const BoardAddress address = ReadAddress(address_file_);
    if (!reader_ || !(reader_->address() == address)) {
      reader_.reset();
      reader_ = std::make_unique<WeightsBoardReader>(address, spec_hash_);
    }
    if (reader_->closed()) return fmt::format("process {} posts no more weights", address.pid);
    if (reader_->failed()) return fmt::format("what process {} posts cannot be read", address.pid);
    if (IsStopped(address.pid)) {
      return fmt::format("process {}, which receives, is stopped", address.pid);
    }
    return "";
  } catch (const Error& e) {
    return e.what();
  } catch (const nlohmann::json::exception&) {
    return fmt::format("'{}' names no board", address_file_.string());
  }
}

void HostWeights::ReceiveAlone(const std::string& reason) {
  log::Info("receives weights for itself alone: {}", reason);
  reader_.reset();
  subscription_ = subscribe_(inbox_);
}

void HostWeights::Post(const ReceivedWeights& weights) {
  if (!board_) return;
  try {
    board_->Post(weights);
  } catch (const Error& e) {
    log::Failure("the other actors of this host have to receive weights themselves: {}", e.what());
  }
}

}  // namespace shoal::actor
