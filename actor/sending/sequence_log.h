// SPDX-License-Identifier: Apache-2.0
// The *made* counter of an actor session and the next unused episode of each of its environments,
// in a mapped file that survives SIGKILL of the actor (not power loss). Records that it counts as
// made and that are not stored were lost with the process.
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
  uint32_t rebuilt;  // 1: by RebuildSequenceLog
  uint64_t session;
  uint64_t made;  // records given a sequence
};
static_assert(sizeof(SequenceLogHeader) == 40);

// Owns the mapping. One thread.
class SequenceLog {
 public:
  // Creates the page of this session, or continues it if the session continues (lockstep). Its
  // episodes continue the numbers of earlier sessions with the same environments. Throws Error if
  // the folder cannot be written, and Error (usage) if an older page is broken.
  SequenceLog(const std::filesystem::path& run, uint32_t actor, uint64_t session,
              uint32_t first_env, uint32_t env_count);
  ~SequenceLog();
  SequenceLog(const SequenceLog&) = delete;
  SequenceLog& operator=(const SequenceLog&) = delete;

  // Counts one more record; returns its sequence (from 1).
  uint64_t CountRecord();
  uint64_t made() const { return header_->made; }
  // Number of the episode that local environment `e` begins now; never used again.
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
  bool rebuilt = false;  // `made` is only what the receiver of the records had seen
};

// The counters of all sessions of a run, by file name; empty when there are none. Throws Error
// (usage) naming a broken page.
std::vector<MadeCount> ReadSequenceLogs(const std::filesystem::path& run);

std::filesystem::path SequenceLogFile(const std::filesystem::path& run, uint32_t actor,
                                      uint64_t session);

// A page that cannot be read, with its actor and session by its name.
struct DamagedPage {
  std::filesystem::path path;
  uint32_t actor = 0;
  uint64_t session = 0;
};
// Sorted by file name. Throws Error (usage) naming a page that belongs to no actor.
std::vector<DamagedPage> FindDamagedPages(const std::filesystem::path& run);

// Writes a page in place of a damaged or missing one: `made` is what the receiver of the records
// has seen, and the episodes go on at numbers that the session cannot have reached. Throws Error.
void RebuildSequenceLog(const std::filesystem::path& run, uint32_t actor, uint64_t session,
                        uint32_t env_count, uint64_t made);

}  // namespace shoal::actor
