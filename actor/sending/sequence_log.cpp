// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/sequence_log.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/saturating_cast.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/process_name.h"

namespace shoal::actor {
namespace {

constexpr char kMagic[9] = "SHOALMD1";

// Value of SequenceLogHeader::rebuilt if the counters are not the actor's own count.
constexpr uint32_t kRebuilt = 1;
// More episodes than an actor can have begun after the last one that the receiver of its records
// has seen.
constexpr uint32_t kUnseenEpisodes = 100'000;

struct PageContent {
  SequenceLogHeader header;
  std::vector<uint32_t> next_episode;
};

PageContent ReadPage(const std::filesystem::path& path) {
  const std::string bytes = ReadFile(path);
  PageContent page{};
  const bool has_header = bytes.size() >= sizeof page.header;
  if (has_header) std::memcpy(&page.header, bytes.data(), sizeof page.header);
  if (!has_header || std::memcmp(page.header.magic, kMagic, 8) != 0 || page.header.env_count == 0 ||
      bytes.size() != sizeof page.header + 4 * size_t{page.header.env_count}) {
    throw UsageError(
        "'{}' is damaged: it is not a counter page of an actor (expected {}, one env or more and a "
        "u32 for each)",
        path.string(), kMagic);
  }
  page.next_episode.resize(page.header.env_count);
  std::memcpy(page.next_episode.data(), bytes.data() + sizeof page.header,
              bytes.size() - sizeof page.header);
  return page;
}

std::vector<std::filesystem::path> PagesOf(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (std::filesystem::directory_iterator it(run / kMadeFolder, error), end; !error && it != end;
       it.increment(error)) {
    if (it->path().extension() == ".page") paths.push_back(it->path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::vector<PageContent> ReadPages(const std::filesystem::path& run) {
  std::vector<PageContent> pages;
  for (const auto& path : PagesOf(run)) pages.push_back(ReadPage(path));
  return pages;
}

// Makes the episodes of `page` follow those of another session with the same environments.
void GoOnAfter(const PageContent& old, PageContent* page) {
  const uint32_t first = page->header.first_env, count = page->header.env_count;
  for (uint32_t i = 0; i < old.header.env_count; ++i) {
    const uint32_t env = old.header.first_env + i;
    if (env < first || env >= first + count) continue;
    uint32_t& next = page->next_episode[env - first];
    next = std::max(next, old.next_episode[i]);
  }
}

// Writes beside and renames, so that a page is complete whenever its name exists.
void WritePage(const std::filesystem::path& path, const PageContent& page) {
  std::string bytes(reinterpret_cast<const char*>(&page.header), sizeof page.header);
  bytes.append(reinterpret_cast<const char*>(page.next_episode.data()),
               page.next_episode.size() * 4);
  WriteFileAtomically(path, bytes);
}

}  // namespace

std::filesystem::path SequenceLogFile(const std::filesystem::path& run, uint32_t actor,
                                      uint64_t session) {
  return run / kMadeFolder / fmt::format("{}-{}.page", ProcessName::Actor(actor).Text(), session);
}

SequenceLog::SequenceLog(const std::filesystem::path& run, uint32_t actor, uint64_t session,
                         uint32_t first_env, uint32_t env_count) {
  PageContent page{};
  std::memcpy(page.header.magic, kMagic, 8);
  page.header.actor = actor;
  page.header.env_count = env_count;
  page.header.first_env = first_env;
  page.header.session = session;
  page.next_episode.resize(env_count);
  for (const PageContent& old : ReadPages(run)) GoOnAfter(old, &page);
  MakeFolders(run / kMadeFolder);
  const std::filesystem::path path = SequenceLogFile(run, actor, session);
  std::error_code error_code;
  if (!std::filesystem::exists(path, error_code)) WritePage(path, page);
  const Descriptor file = OpenRegular(path, O_RDWR);
  bytes_ = sizeof page.header + 4 * size_t{env_count};
  void* mapped = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
  if (mapped == MAP_FAILED) {
    throw RuntimeError("cannot map '{}': {}", path.string(), std::strerror(errno));
  }
  header_ = static_cast<SequenceLogHeader*>(mapped);
  next_episode_ = reinterpret_cast<uint32_t*>(header_ + 1);
}

SequenceLog::~SequenceLog() { munmap(header_, bytes_); }

uint64_t SequenceLog::CountRecord() {
  return std::atomic_ref(header_->made).fetch_add(1, std::memory_order_release) + 1;
}

uint32_t SequenceLog::TakeEpisode(uint32_t e) {
  return std::atomic_ref(next_episode_[e]).fetch_add(1, std::memory_order_release);
}

std::vector<MadeCount> ReadSequenceLogs(const std::filesystem::path& run) {
  std::vector<MadeCount> counts;
  for (const PageContent& page : ReadPages(run)) {
    counts.push_back({page.header.actor, page.header.session, page.header.made,
                      page.header.rebuilt == kRebuilt});
  }
  return counts;
}

std::vector<DamagedPage> FindDamagedPages(const std::filesystem::path& run) {
  std::vector<DamagedPage> damaged;
  for (const auto& path : PagesOf(run)) {
    DamagedPage page{.path = path};
    const std::string name = path.filename();
    const bool named =
        std::sscanf(name.c_str(), "actor-%u-%lu.page", &page.actor, &page.session) == 2 &&
        SequenceLogFile(run, page.actor, page.session) == path;
    try {
      const SequenceLogHeader header = ReadPage(path).header;
      if (named && header.actor == page.actor && header.session == page.session) continue;
    } catch (const Error&) {  // an unreadable page is damaged
    }
    if (!named) {
      throw UsageError("'{}' is no counter page of an actor of this run: remove it", path.string());
    }
    damaged.push_back(page);
  }
  return damaged;
}

void RebuildSequenceLog(const std::filesystem::path& run, uint32_t actor, uint64_t session,
                        uint32_t env_count, uint64_t made) {
  PageContent page{};
  std::memcpy(page.header.magic, kMagic, 8);
  page.header.actor = actor;
  page.header.env_count = env_count;
  page.header.first_env = actor * env_count;
  page.header.rebuilt = kRebuilt;
  page.header.session = session;
  page.header.made = made;
  page.next_episode.resize(env_count);
  for (const auto& path : PagesOf(run)) {
    try {
      GoOnAfter(ReadPage(path), &page);
    } catch (const Error&) {  // another damaged page, which is rebuilt as well
    }
  }
  // Each episode has at least one record, so episode numbers from here on are unused.
  const double begun = static_cast<double>(made) + kUnseenEpisodes;
  for (uint32_t& next : page.next_episode) next = SaturatingCast<uint32_t>(next + begun);
  WritePage(SequenceLogFile(run, actor, session), page);
}

}  // namespace shoal::actor
