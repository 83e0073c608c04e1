// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/made_page.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/process_name.h"

namespace shoal::actor {
namespace {

constexpr char kMagic[9] = "SHOALMD1";

struct PageContent {
  MadePageHeader header;
  std::vector<uint32_t> next_episode;
};

PageContent ReadPage(const std::filesystem::path& path) {
  const std::string bytes = ReadFile(path);
  PageContent page{};
  const bool has_header = bytes.size() >= sizeof page.header;
  if (has_header) std::memcpy(&page.header, bytes.data(), sizeof page.header);
  if (!has_header || std::memcmp(page.header.magic, kMagic, 8) != 0 || page.header.env_count == 0 ||
      bytes.size() != sizeof page.header + 4 * size_t{page.header.env_count}) {
    throw RuntimeError(
        "'{}' is not a counter page of an actor (expected {}, one env or more and a u32 for each)",
        path.string(), kMagic);
  }
  page.next_episode.resize(page.header.env_count);
  std::memcpy(page.next_episode.data(), bytes.data() + sizeof page.header,
              bytes.size() - sizeof page.header);
  return page;
}

std::vector<PageContent> ReadPages(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(run / kMadeFolder, error)) {
    if (entry.path().extension() == ".page") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<PageContent> pages;
  pages.reserve(paths.size());
  for (const auto& path : paths) pages.push_back(ReadPage(path));
  return pages;
}

// A complete page appears under its name or none: written beside, then renamed.
void WritePage(const std::filesystem::path& path, const PageContent& page) {
  std::string bytes(reinterpret_cast<const char*>(&page.header), sizeof page.header);
  bytes.append(reinterpret_cast<const char*>(page.next_episode.data()),
               page.next_episode.size() * 4);
  WriteFileAtomically(path, bytes);
}

}  // namespace

MadePage::MadePage(const std::filesystem::path& run, uint32_t actor, uint64_t session,
                   uint32_t first_env, uint32_t env_count) {
  PageContent page{};
  std::memcpy(page.header.magic, kMagic, 8);
  page.header.actor = actor;
  page.header.env_count = env_count;
  page.header.first_env = first_env;
  page.header.session = session;
  page.next_episode.resize(env_count);
  for (const PageContent& old : ReadPages(run)) {
    for (uint32_t i = 0; i < old.header.env_count; ++i) {
      const uint32_t env = old.header.first_env + i;
      if (env < first_env || env >= first_env + env_count) continue;
      uint32_t& next = page.next_episode[env - first_env];
      next = std::max(next, old.next_episode[i]);
    }
  }
  MakeFolders(run / kMadeFolder);
  const std::filesystem::path path =
      run / kMadeFolder / fmt::format("{}-{}.page", ProcessName::Actor(actor).Text(), session);
  std::error_code error_code;
  if (!std::filesystem::exists(path, error_code)) WritePage(path, page);
  const Descriptor file(open(path.c_str(), O_RDWR | O_CLOEXEC));
  bytes_ = sizeof page.header + 4 * size_t{env_count};
  void* mapped = file.get() < 0
                     ? MAP_FAILED
                     : mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
  if (mapped == MAP_FAILED) {
    throw RuntimeError("cannot map '{}': {}", path.string(), std::strerror(errno));
  }
  header_ = static_cast<MadePageHeader*>(mapped);
  next_episode_ = reinterpret_cast<uint32_t*>(header_ + 1);
}

MadePage::~MadePage() { munmap(header_, bytes_); }

uint64_t MadePage::CountRecord() {
  return std::atomic_ref(header_->made).fetch_add(1, std::memory_order_release) + 1;
}

uint32_t MadePage::TakeEpisode(uint32_t e) {
  return std::atomic_ref(next_episode_[e]).fetch_add(1, std::memory_order_release);
}

std::vector<MadeCount> ReadMadePages(const std::filesystem::path& run) {
  std::vector<MadeCount> counts;
  for (const PageContent& page : ReadPages(run)) {
    counts.push_back({page.header.actor, page.header.session, page.header.made});
  }
  return counts;
}

}  // namespace shoal::actor
