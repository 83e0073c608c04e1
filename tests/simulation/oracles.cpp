// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/oracles.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/config/on_policy.h"
#include "common/run_folder/accounting_file.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/run_leftovers.h"
#include "launch/record/evaluations.h"
#include "launch/record/run_meta.h"
#include "launch/run/live_settings.h"
#include "launch/run/run_account.h"
#include "replay_server/core/ring.h"
#include "tests/simulation/fake_environment.h"
#include "tests/simulation/hash_agent.h"
#include "tests/simulation/report_oracles.h"

namespace shoal::simulation {
namespace {

namespace fs = std::filesystem;

// More files than a run of this length leaves, by folder; what grows without bound exceeds them.
constexpr size_t kMostCheckpoints = 12;   // kept, best, candidates
constexpr uint64_t kMostBytes = 8 << 20;  // of everything but the ring

class Examination {
 public:
  Examination(const World& world, const Facts& facts)
      : run_(world.folder), config_(world.blueprint.run.config), world_(world), facts_(facts) {}

  std::vector<std::string> Run() {
    Try("meta.json", [this] { meta_ = launch::ReadRunMeta(run_); });
    Try("the account", [this] { CheckAccount(); });
    Try("the evaluations", [this] { CheckEvaluations(); });
    Try("the ring", [this] { CheckRing(); });
    Try("the reports", [this] { CheckReports(); });
    Try("the files", [this] { CheckFiles(); });
    return std::move(broken_);
  }

 private:
  // A file that cannot be read is a broken promise.
  void Try(const char* what, const std::function<void()>& look) {
    try {
      look();
    } catch (const std::exception& error) {
      Break(fmt::format("{}: {}", what, error.what()));
    }
  }
  void Break(std::string what) { broken_.push_back(std::move(what)); }

  void CheckAccount();
  void CheckEvaluations();
  void CheckRing();
  void CheckReports();
  void CheckFiles();

  const fs::path run_;
  const Config& config_;
  const World& world_;
  const Facts& facts_;
  launch::RunMeta meta_;
  std::vector<std::string> broken_;
};

void Examination::CheckAccount() {
  const auto sums =
      launch::AccountRun(run_, config_, launch::TopologyOf(config_, {}), meta_.resends);
  if (!sums) return Break("there is no account");
  for (const std::string& fault : sums->faults) Break("account: " + fault);
  if (sums->rejected > 0) Break(fmt::format("{} records were rejected", sums->rejected));
  const uint64_t gone = sums->lost_with_process + sums->lost_with_replay + sums->after_gap;
  if (!facts_.struck && gone + sums->duplicates + sums->discarded > 0) {
    Break("without a fault: " + sums->Line());
  }
  launch::LiveSettings settings(config_);
  settings.Restore(meta_.changes);
  const auto budget = static_cast<uint64_t>(settings.config().env_steps);
  if (meta_.exit == "budget" && meta_.env_steps < budget) {
    Break(fmt::format("{} env steps of a budget of {}", meta_.env_steps, budget));
  }
  for (const SessionCounters& session : ReadAccount(run_).sessions) {
    // The predecessor of a record is missing only if records were lost. A restarted learner has
    // none of the earlier records.
    if (LearnsOnPolicy(config_)) break;
    if (session.after_gap == 0 || session.lost > 0 || facts_.cut) continue;
    Break(fmt::format("actor {} session {}: {} records after a gap, and none lost", session.actor,
                      session.session, session.after_gap));
  }
  // A ring in memory is lost with its process. Without a ring, so are the records acknowledged
  // since the account was written (learner/rollouts/rollout_source.h). A replay server that is
  // killed while the run stops has no successor that counts the records in its ring.
  const bool has_ring = !LearnsOnPolicy(config_) && !facts_.lost && !facts_.cut;
  const bool counted = facts_.last_clean || !facts_.replay_struck;
  const bool remembers = (LearnsOnPolicy(config_) || config_.replay.storage == "file") &&
                         (has_ring ? counted : !facts_.unwritten && !facts_.replay_struck);
  if (!remembers) return;
  std::map<std::pair<uint32_t, uint64_t>, uint64_t> dealt_with;
  for (const SessionCounters& session : ReadAccount(run_).sessions) {
    dealt_with[{session.actor, session.session}] = session.highest;
  }
  for (const auto& [session, acknowledged] : facts_.acknowledged) {
    const auto found = dealt_with.find(session);
    if (found == dealt_with.end() && facts_.overwritten) continue;
    const uint64_t highest = found == dealt_with.end() ? 0 : found->second;
    if (highest >= acknowledged) continue;
    Break(fmt::format("actor {} session {}: {} records were acknowledged, {} are accounted for",
                      session.first, session.second, acknowledged, highest));
  }
}

void Examination::CheckEvaluations() {
  constexpr double kNear = 1e-3;  // of a return; that of one update is kEpisodeSteps / 10'000
  for (const launch::EvaluationPoint& point : launch::ReadEvaluations(run_)) {
    const double expected = FakeEnvironment::kEpisodeSteps * HashAgent::ActionAfter(point.updates);
    if (std::abs(point.mean_return - expected) < kNear / 2) continue;
    Break(fmt::format("the evaluation after {} updates has the return of {:.0f}", point.updates,
                      point.mean_return * 10'000 / FakeEnvironment::kEpisodeSteps));
  }
  std::set<std::string> said;
  bool unwritten = false;  // the disk keeps evaluations from their files
  for (const std::string& line : world_.story.lines()) {
    const bool begins = line.find("operator: shoal train") != std::string::npos;
    if (line.find("coordinator: eval: cannot write") != std::string::npos) unwritten = true;
    if (line.find("coordinator: eval: written again") != std::string::npos) unwritten = false;
    // Evaluations that a full disk kept from their files, to the end or to the coordinator's death,
    // are made again.
    const bool fresh = begins && line.find("--resume") == std::string::npos;
    if (fresh || (begins && unwritten)) said.clear();
    if (line.find("not completely written") != std::string::npos) said.clear();
    const size_t begin = line.find("coordinator: evaluation at ");
    const size_t end = line.find(" updates: ");
    if (begin == std::string::npos || end == std::string::npos) continue;
    const std::string which = line.substr(begin, end - begin);
    if (!said.insert(which).second) Break("counted twice: " + which);
  }
}

void Examination::CheckRing() {
  std::error_code error;
  if (LearnsOnPolicy(config_) || facts_.cut || !fs::exists(run_ / kRingFile, error)) return;
  const replay::Ring ring = replay::Ring::OpenSnapshot(world_.blueprint.run.spec, run_ / kRingFile);
  std::set<std::tuple<uint32_t, uint32_t, uint32_t, RecordKind>> seen;
  for (uint64_t id = ring.oldest_id(); id <= ring.last_id(); ++id) {
    if (!ring.Intact(id)) {
      Break(fmt::format("record {} is not whole", id));
      continue;
    }
    const RecordHeader& header = ring.Header(id);
    if (seen.insert({header.env, header.episode, header.index, header.kind}).second) continue;
    Break(fmt::format("record {} is stored twice: env {} episode {} index {}", id, header.env,
                      header.episode, header.index));
  }
}

void Examination::CheckReports() {
  for (std::string& line : BrokenInReports(world_, facts_)) Break(std::move(line));
}

void Examination::CheckFiles() {
  size_t checkpoints = 0;
  uint64_t bytes = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(run_)) {
    const std::string name = entry.path().filename();
    if (entry.is_directory()) {
      if (!fs::exists(entry.path() / kStateFile)) continue;
      ++checkpoints;
      Try("a checkpoint",
          [&] { ReadCheckpointFiles(entry.path(), world_.blueprint.run.spec.Hash()); });
      continue;
    }
    if (name != kRingFile) bytes += entry.file_size();
    if (!name.ends_with(".json")) continue;
    if (!nlohmann::json::accept(ReadFile(entry.path()))) {
      Break(fmt::format("'{}' is half written", entry.path().string()));
    }
  }
  if (checkpoints > kMostCheckpoints) Break(fmt::format("{} checkpoints are kept", checkpoints));
  if (bytes > kMostBytes) Break(fmt::format("the run has {} bytes", bytes));
  // A clean end leaves no file under a temporary name.
  const int unfinished = launch::RemoveUnfinishedFiles(run_);
  if (facts_.last_clean && unfinished > 0) Break(fmt::format("{} unfinished files", unfinished));
}

}  // namespace

void Witness::Hear(const CreditsMessage& message) {
  for (const Credit& credit : message.credits) {
    uint64_t& highest = acknowledged_[{credit.actor, credit.session}];
    highest = std::max(highest, credit.stored);
  }
}

std::vector<std::string> BrokenPromises(const World& world, const Facts& facts) {
  return Examination(world, facts).Run();
}

}  // namespace shoal::simulation
