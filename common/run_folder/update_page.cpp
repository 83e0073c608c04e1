// SPDX-License-Identifier: Apache-2.0
#include "common/run_folder/update_page.h"

#include <fcntl.h>
#include <sys/mman.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

constexpr char kMagic[9] = "SHOALUP1";

fs::path PageOf(const fs::path& run) { return run / kUpdatePageFile; }

UpdatePageContent ReadPage(const fs::path& path) {
  const std::string bytes = ReadFile(path);
  UpdatePageContent content{};
  if (bytes.size() != sizeof content || std::memcmp(bytes.data(), kMagic, 8) != 0) {
    throw UsageError("'{}' is damaged: it is not a page of a learner (expected {} and two u64)",
                     path.string(), kMagic);
  }
  std::memcpy(&content, bytes.data(), sizeof content);
  return content;
}

void WritePage(const fs::path& path, const UpdatePageContent& content) {
  WriteFileAtomically(path, std::string(reinterpret_cast<const char*>(&content), sizeof content));
}

}  // namespace

UpdatePage::UpdatePage(const fs::path& run, uint64_t restored) {
  const fs::path path = PageOf(run);
  UpdatePageContent content{};
  const bool exists = fs::exists(path);
  if (exists) {
    content = ReadPage(path);
  } else {
    std::memcpy(content.magic, kMagic, 8);
  }
  if (content.done > restored) content.lost += content.done - restored;
  content.done = restored;
  bool replaced = true;
  try {
    // The page is complete whenever its name exists.
    WritePage(path, content);
  } catch (const Error& e) {
    if (!exists) throw;
    replaced = false;  // the disk is full, but the existing page has its space
    log::Warning("{}; going on in the page that is there", e.what());
  }
  const Descriptor file = OpenRegular(path, O_RDWR);
  void* mapped = mmap(nullptr, sizeof content, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
  if (mapped == MAP_FAILED) {
    throw RuntimeError("cannot map '{}': {}", path.string(), std::strerror(errno));
  }
  content_ = static_cast<UpdatePageContent*>(mapped);
  if (!replaced) *content_ = content;
}

UpdatePage::~UpdatePage() { munmap(content_, sizeof *content_); }

void UpdatePage::SetDone(uint64_t updates) {
  std::atomic_ref(content_->done).store(updates, std::memory_order_release);
}

void RebuildUpdatePage(const fs::path& run, uint64_t done, uint64_t lost) {
  UpdatePageContent content{.magic = {}, .done = done, .lost = lost};
  std::memcpy(content.magic, kMagic, 8);
  WritePage(PageOf(run), content);
}

uint64_t ReadLostUpdates(const fs::path& run) {
  const fs::path path = PageOf(run);
  return fs::exists(path) ? ReadPage(path).lost : 0;
}

}  // namespace shoal
