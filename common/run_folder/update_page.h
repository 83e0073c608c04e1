// SPDX-License-Identifier: Apache-2.0
// Counts of the updates that a run's learners have done and lost, in a mapped file that survives
// SIGKILL of the learner (not power loss). Updates that the page counts and no checkpoint has were
// lost with the process, including its last one.
//
// File RUN/learner.page: UpdatePageContent. The count of lost updates covers learners that have a
// successor; those of the last learner are added when the run is resumed.
#pragma once

#include <cstdint>
#include <filesystem>

namespace shoal {

struct UpdatePageContent {
  char magic[8];  // "SHOALUP1"
  uint64_t done;  // by the present learner, those of its checkpoint included
  uint64_t lost;  // with its predecessors
};
static_assert(sizeof(UpdatePageContent) == 24);

// Owns the mapping. One thread, one learner per run.
class UpdatePage {
 public:
  // Makes the run's page, or continues it: the updates of its last learner beyond `restored`, the
  // updates of the checkpoint that this learner starts from, are lost. Throws Error if the folder
  // cannot be written or the file is no such page.
  UpdatePage(const std::filesystem::path& run, uint64_t restored);
  ~UpdatePage();
  UpdatePage(const UpdatePage&) = delete;
  UpdatePage& operator=(const UpdatePage&) = delete;

  // Call after each update.
  void SetDone(uint64_t updates);
  uint64_t lost() const { return content_->lost; }

 private:
  UpdatePageContent* content_ = nullptr;
};

// Replaces a damaged page by counts from other sources.
void RebuildUpdatePage(const std::filesystem::path& run, uint64_t done, uint64_t lost);

// Updates lost in a run so far; 0 before the first learner. Throws Error when the file is no
// such page.
uint64_t ReadLostUpdates(const std::filesystem::path& run);

}  // namespace shoal
