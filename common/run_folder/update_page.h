// SPDX-License-Identifier: Apache-2.0
// How many updates a run's learners have done and how many of these were lost, in a mapped file
// that survives SIGKILL of the learner (not power loss): what a page says was done and no
// checkpoint has was lost with the process, its last update included.
//
// File RUN/learner.page: UpdatePageContent. It tells of learners that have a successor; the updates
// of one that died last are counted when the run goes on.
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
  // Makes the run's page, or goes on with it: what its last learner did beyond `restored` updates,
  // those of the checkpoint that this one starts from, is lost. Throws Error when the folder cannot
  // be written or the file is no such page.
  UpdatePage(const std::filesystem::path& run, uint64_t restored);
  ~UpdatePage();
  UpdatePage(const UpdatePage&) = delete;
  UpdatePage& operator=(const UpdatePage&) = delete;

  // After each update.
  void SetDone(uint64_t updates);
  uint64_t lost() const { return content_->lost; }

 private:
  UpdatePageContent* content_ = nullptr;
};

// In place of a damaged page: what else is known.
void RebuildUpdatePage(const std::filesystem::path& run, uint64_t done, uint64_t lost);

// Updates lost in a run so far; 0 where no learner has come yet. Throws Error when the file is no
// such page.
uint64_t ReadLostUpdates(const std::filesystem::path& run);

}  // namespace shoal
