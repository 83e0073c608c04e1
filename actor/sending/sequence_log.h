// SPDX-License-Identifier: Apache-2.0
// Sequence log: the number of records that an actor session has made, and the next unused episode
// number of each of its environments. The mapped file survives SIGKILL of the actor, but not power
// loss. Records that are counted as made and are not stored were lost with the process.
//
// File RUN/made/actor-ID-SESSION.page: SequenceLogHeader, then env_count u32 "next episode".
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace shoal::actor {

struct SequenceLogHeader {
  char magic[8];  // "SHOALMD1"
  uint32_t actor;
  uint32_t env_count;
  uint32_t first_env;
  uint32_t rebuilt;  // 1: written by RebuildSequenceLog
  uint64_t session;
  uint64_t made;  // number of records that have a sequence
};
static_assert(sizeof(SequenceLogHeader) == 40);

// Owns the mapping. One thread.
class SequenceLog {
 public:
  // Creates the file of this session, or opens the existing file if the session continues
  // (lockstep). Episode numbers continue the numbers of earlier sessions with the same
  // environments. Throws Error if the folder cannot be written, and Error (usage) if an older file
  // is damaged.
  SequenceLog(const std::filesystem::path& run, uint32_t actor, uint64_t session,
              uint32_t first_env, uint32_t env_count);
  ~SequenceLog();
  SequenceLog(const SequenceLog&) = delete;
  SequenceLog& operator=(const SequenceLog&) = delete;

  // Counts one more record; returns its sequence (from 1).
  uint64_t CountRecord();
  uint64_t made() const { return header_->made; }
  // Returns the number of the episode that local environment `e` begins now. Each number is used
  // once.
  uint32_t TakeEpisode(uint32_t e);

 private:
  SequenceLogHeader* header_ = nullptr;
  uint32_t* next_episode_ = nullptr;
  size_t bytes_ = 0;
};

struct MadeCount {
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t made = 0;
  bool rebuilt = false;  // `made` counts only the records that the receiver has seen
};

// The counters of all sessions of a run, sorted by file name. Throws Error (usage) naming a damaged
// file.
std::vector<MadeCount> ReadSequenceLogs(const std::filesystem::path& run);

std::filesystem::path SequenceLogFile(const std::filesystem::path& run, uint32_t actor,
                                      uint64_t session);

// A sequence log that cannot be read. Its file name gives the actor and the session.
struct DamagedPage {
  std::filesystem::path path;
  uint32_t actor = 0;
  uint64_t session = 0;
};
// The damaged sequence logs of a run, sorted by file name. Throws Error (usage) naming a file that
// belongs to no actor.
std::vector<DamagedPage> FindDamagedPages(const std::filesystem::path& run);

// Replaces a damaged or missing file. `made` is the number of records that the receiver has seen.
// New episode numbers are so high that the session cannot have used them. Throws Error.
void RebuildSequenceLog(const std::filesystem::path& run, uint32_t actor, uint64_t session,
                        uint32_t env_count, uint64_t made);

}  // namespace shoal::actor
