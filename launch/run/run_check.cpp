// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "actor/loop/rollout_state.h"
#include "actor/sending/sequence_log.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/config/on_policy.h"
#include "common/run_folder/accounting_file.h"
#include "common/run_folder/run_file_names.h"
#include "common/run_folder/update_page.h"
#include "common/wire/process_name.h"
#include "launch/record/evaluations.h"
#include "launch/record/run_folder.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/session_table.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

bool Exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool Throws(const std::function<void()>& read) {
  try {
    read();
    return false;
  } catch (const Error&) {
    return true;
  }
}

// Checks one run.
class Examination {
 public:
  Examination(const fs::path& run, const RunConfig& config, const RunMeta& meta,
              uint32_t own_actors)
      : run_(run), config_(config), meta_(meta), own_actors_(own_actors) {}

  RunCheck Run() {
    LookAtRing();
    LookAtAccount();
    LookAtSequenceLogs();
    LookAtUpdatePage();
    LookAtSessions();
    LookAtCheckpoints();
    LookAtEvaluations();
    for (uint32_t actor = 0; actor < own_actors_; ++actor) actor::ReadRolloutState(run_, actor);
    return std::move(check_);
  }

 private:
  bool OnPolicy() const { return LearnsOnPolicy(config_.config); }
  void Say(std::string line) { check_.lines.push_back(std::move(line)); }
  void Repair(std::function<void()> repair) { check_.repairs.push_back(std::move(repair)); }

  void LookAtRing();
  void LookAtAccount();
  RunAccount RebuiltAccount(std::string* what);
  void LookAtSequenceLogs();
  void LookAtUpdatePage();
  void LookAtSessions();
  void LookAtCheckpoints();
  void LookAtEvaluations();

  const fs::path run_;
  const RunConfig& config_;
  const RunMeta& meta_;
  const uint32_t own_actors_;
  bool has_ring_ = false;
  RunAccount account_;  // after repairs
  RunCheck check_;
};

void Examination::LookAtRing() {
  const ReplayConfig& replay = config_.config.replay;
  if (OnPolicy()) return;
  const std::string refill = fmt::format(
      "training continues once the replay has been refilled to {} sampleable transitions "
      "(replay.min_size)",
      replay.min_size);
  if (replay.storage == "memory") {
    if (meta_.env_steps > 0) {
      Say(fmt::format("replay.storage=memory: the stored records are lost; {}", refill));
    }
    return;
  }
  const fs::path file = run_ / kRingFile;
  has_ring_ = Exists(file);
  if (has_ring_) {
    replay::Ring::CheckFile(
        config_.spec,
        {.file = file, .capacity = static_cast<uint64_t>(replay.capacity), .run = {}});
  } else if (meta_.env_steps > 0) {
    Say(fmt::format("'{}' is missing: the replay starts empty, env steps continue from {}; {}",
                    file.string(), meta_.env_steps, refill));
  }
}

// The account rebuilt from the ring or, without a ring, from the actors' counters. `*what` names
// the source and the losses.
RunAccount Examination::RebuiltAccount(std::string* what) {
  RunAccount account{.stored_steps = meta_.env_steps, .ring_replaced = true};
  if (has_ring_) {
    const replay::Ring ring = replay::Ring::OpenSnapshot(config_.spec, run_ / kRingFile);
    account.stored_steps = std::max(account.stored_steps, ring.stored_steps());
    account.stored_records = ring.last_id();
    account.sessions = replay::SessionTable(ring.sessions()).all();
    *what = "from the replay's ring";
    return account;
  }
  std::vector<actor::MadeCount> pages;
  Throws([&] { pages = actor::ReadSequenceLogs(run_); });
  uint64_t made = 0;
  for (const actor::MadeCount& page : pages) {
    SessionCounters counters{.actor = page.actor, .session = page.session, .highest = page.made};
    (OnPolicy() ? counters.discarded : counters.lost) = page.made;
    account.sessions.push_back(counters);
    made += page.made;
  }
  *what = fmt::format(
      "from the actors' counters: what happened to {} records is unknown; they count as {}", made,
      OnPolicy() ? "discarded" : "lost with a replay");
  return account;
}

void Examination::LookAtAccount() {
  const fs::path file = run_ / kAccountingFile;
  const bool begun = meta_.env_steps > 0;
  const bool missing = !Exists(file);
  if (!missing && !Throws([&] { account_ = ReadAccount(run_); })) {
    // After a kill, the account on disk may be up to a second old.
    if (has_ring_ || OnPolicy() || account_.stored_steps >= meta_.env_steps) return;
    account_.stored_steps = meta_.env_steps;
  } else if (!missing || (begun && !has_ring_)) {
    std::string what;
    account_ = RebuiltAccount(&what);
    Say(fmt::format("'{}' is {}: rebuilt {}", file.string(), missing ? "missing" : "damaged",
                    what));
  } else {
    return;
  }
  Repair([this_run = run_, account = account_] { StoreAccount(this_run, account); });
}

void Examination::LookAtSequenceLogs() {
  std::map<std::pair<uint32_t, uint64_t>, uint64_t> seen;  // from the account
  for (const SessionCounters& counters : account_.sessions) {
    if (counters.actor < own_actors_) seen[{counters.actor, counters.session}] = counters.highest;
  }
  std::map<std::pair<uint32_t, uint64_t>, std::string> wanted;
  for (const actor::DamagedPage& page : actor::FindDamagedPages(run_)) {
    wanted[{page.actor, page.session}] = "damaged";
  }
  if (wanted.empty()) {
    for (const actor::MadeCount& page : actor::ReadSequenceLogs(run_)) {
      const auto it = seen.find({page.actor, page.session});
      if (it != seen.end() && page.made < it->second) wanted[it->first] = "damaged";
    }
  }
  for (const auto& [session, highest] : seen) {
    const fs::path page = actor::SequenceLogFile(run_, session.first, session.second);
    if (!Exists(page)) wanted[session] = "missing";
  }
  for (const auto& [session, state] : wanted) {
    const auto [actor, number] = session;
    const uint64_t made = seen.contains(session) ? seen[session] : 0;
    Say(
        fmt::format("'{}' is {}: rebuilt; actor {} made at least {} records in that session, "
                    "further ones are not counted, and its next episodes have higher numbers",
                    actor::SequenceLogFile(run_, actor, number).string(), state, actor, made));
    Repair([=, this_run = run_, envs = static_cast<uint32_t>(config_.config.envs_per_actor),
            actor_number = actor, session_number = number] {
      actor::RebuildSequenceLog(this_run, actor_number, session_number, envs, made);
    });
  }
}

void Examination::LookAtUpdatePage() {
  const fs::path file = run_ / kUpdatePageFile;
  const bool missing = !Exists(file);
  if (missing ? meta_.updates == 0 : !Throws([&] { ReadLostUpdates(run_); })) return;
  Say(fmt::format(
      "'{}' is {}: rebuilt from {}; updates lost in the last seconds before are no longer known",
      file.string(), missing ? "missing" : "damaged", kMetaFile));
  Repair([this_run = run_, updates = meta_.updates, lost = meta_.updates_lost] {
    RebuildUpdatePage(this_run, updates, lost);
  });
}

// A session number must exceed those of earlier processes. If the file is damaged, the clock gives
// a greater number unless it was set back; other files hold the last number of actors and learner.
void Examination::LookAtSessions() {
  std::error_code error;
  for (fs::directory_iterator it(run_ / kSessionFolder, error), end; !error && it != end;
       it.increment(error)) {
    const std::string text = ReadFile(it->path());
    uint64_t number = 0;
    const auto [parsed, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault == std::errc() && std::string_view(parsed, text.data() + text.size()) == "\n")
      continue;
    Say(fmt::format("'{}' is damaged: removed; the next session number is taken from the clock",
                    it->path().string()));
    Repair([path = it->path()] {
      std::error_code ignored;
      fs::remove(path, ignored);
    });
  }
}

void Examination::LookAtCheckpoints() {
  std::vector<std::pair<uint64_t, fs::path>> all;
  std::error_code error;
  for (fs::directory_iterator it(run_ / kCheckpointFolder, error), end; !error && it != end;
       it.increment(error)) {
    const auto updates = CheckpointUpdates(it->path().filename());
    if (updates) all.emplace_back(*updates, it->path());
  }
  std::ranges::sort(all, std::greater());
  std::string newest_fault;
  for (const auto& [updates, folder] : all) {
    try {
      ReadCheckpointFiles(folder, config_.spec.Hash());
      if (!newest_fault.empty()) {
        Say(fmt::format("checkpoint refused: {}: goes on from {}", newest_fault,
                        folder.filename().string()));
      }
      return;
    } catch (const Error& e) {
      if (newest_fault.empty()) newest_fault = e.what();
    }
  }
  if (all.empty()) return;
  throw UsageError(
      "none of {} checkpoint(s) can be used; the newest: {}; restore one, or move '{}' away to "
      "train from scratch with the existing replay",
      all.size(), newest_fault, (run_ / kCheckpointFolder).string());
}

void Examination::LookAtEvaluations() {
  Refusing("remove the file, and the curves lack its point", [this] { ReadEvaluations(run_); });
}

}  // namespace

void Refusing(const std::string& remedy, const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& e) {
    throw UsageError("{}; {}", e.what(), remedy);
  }
}

void CheckKindsOfFiles(const fs::path& run) {
  std::error_code error;
  for (fs::recursive_directory_iterator it(run, error), end; !error && it != end;
       it.increment(error)) {
    const fs::file_status status = it->status(error);
    if (fs::is_regular_file(status) || fs::is_directory(status) || !fs::exists(status)) continue;
    throw UsageError("'{}' is a pipe, a socket or a device: remove it", it->path().string());
  }
}

RunMeta ReadMetaToGoOn(const fs::path& run, std::vector<std::string>* lines) {
  RunMeta meta;
  Refusing(
      "remove it, and the run goes on without its times and the keys that were changed while it "
      "ran",
      [&] { meta = ReadRunMeta(run); });
  if (Exists(run / kMetaFile)) return meta;
  Throws([&] { meta.env_steps = ReadAccountBefore(run).stored_steps; });
  const fs::path newest = NewestCheckpoint(run);
  if (!newest.empty()) {
    Throws([&] {
      const CheckpointState state = ReadPolicyFiles(newest).state;
      meta.updates = state.updates;
      meta.env_steps = std::max(meta.env_steps, state.env_steps);
    });
  }
  if (meta.env_steps == 0) return meta;
  lines->push_back(fmt::format(
      "'{}' is missing: rebuilt from the account and the newest checkpoint, at {} env steps; times "
      "and the keys that were changed while it ran are no longer known",
      (run / kMetaFile).string(), meta.env_steps));
  return meta;
}

RunCheck CheckRunFiles(const fs::path& run, const RunConfig& config, const RunMeta& meta,
                       uint32_t own_actors) {
  return Examination(run, config, meta, own_actors).Run();
}

}  // namespace shoal::launch
