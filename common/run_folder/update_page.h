// SPDX-License-Identifier: Apache-2.0
// Counts of the updates that a run's learners made, and of the updates that were lost. The counts
// are in a mapped file that survives SIGKILL of the learner (not power loss). If a learner dies,
// the updates that its page counts but no checkpoint contains are lost.
//
// File RUN/learner.page: UpdatePageContent. When a learner starts, it adds the lost updates of the
// previous learner.
#pragma once

#include <cstdint>
#include <filesystem>

namespace shoal {

struct UpdatePageContent {
  char magic[8];  // "SHOALUP1"
  uint64_t done;  // number of updates in the present learner's weights
  uint64_t lost;  // updates that were lost with earlier learners
};
static_assert(sizeof(UpdatePageContent) == 24);

// Owns the mapping. Only one thread may use the page, and only one learner in each run.
class UpdatePage {
 public:
  // Makes the run's page, or continues an existing page. `restored`: number of updates of the
  // checkpoint from which this learner starts; the previous learner's updates beyond this number
  // are counted as lost. Throws Error if the folder cannot be written or the file is not such a
  // page.
  UpdatePage(const std::filesystem::path& run, uint64_t restored);
  ~UpdatePage();
  UpdatePage(const UpdatePage&) = delete;
  UpdatePage& operator=(const UpdatePage&) = delete;

  // Call this function after each update.
  void SetDone(uint64_t updates);
  uint64_t lost() const { return content_->lost; }

 private:
  UpdatePageContent* content_ = nullptr;
};

// Replaces a damaged page by a page with these counts, which come from other files.
void RebuildUpdatePage(const std::filesystem::path& run, uint64_t done, uint64_t lost);

// Number of updates lost in a run so far; 0 before the first learner. Throws Error if the file is
// not such a page.
uint64_t ReadLostUpdates(const std::filesystem::path& run);

}  // namespace shoal
