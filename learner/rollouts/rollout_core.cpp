// SPDX-License-Identifier: Apache-2.0
#include "learner/rollouts/rollout_core.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/base/check.h"
#include "common/config/sending_window.h"
#include "common/spec/frame_stack.h"

namespace shoal::learner {
namespace {

SessionLedger LedgerOf(const RunAccount& before) {
  SessionLedger ledger(RolloutCore::kMostSessions);
  for (const SessionCounters& counters : before.sessions) {
    if (const auto i = ledger.Add(counters.actor, counters.session)) ledger.Update(*i, counters);
  }
  return ledger;
}

template <class T>
void Append(std::span<const T> values, std::vector<T>* to) {
  to->insert(to->end(), values.begin(), values.end());
}

}  // namespace

SendingWindow WindowOf(const RunConfig& run) {
  return SendingWindowOf(run.config, RecordLayout(run.spec).record_bytes());
}

void RolloutCore::Rollout::Clear() {
  version = {};
  records = 0;
  rows = 0;
  for (std::vector<uint8_t>* bytes : {&frames, &next_frames}) bytes->clear();
  for (std::vector<float>* numbers : {&vectors, &actions, &drawn, &rewards, &bootstraps, &log_probs,
                                      &ends, &continues, &next_vectors}) {
    numbers->clear();
  }
}

RolloutCore::RolloutCore(const RunConfig& run, uint64_t receiver_session, const RunAccount& before)
    : run_(run),
      layout_(run.spec),
      observed_(BlockPicker::Observed(run.spec)),
      steps_(run.config.ppo.rollout_steps),
      envs_per_actor_(run.config.envs_per_actor),
      versions_ahead_(static_cast<uint64_t>(run.config.ppo.versions_ahead)),
      receiver_session_(receiver_session),
      stack_bytes_(static_cast<size_t>(run.spec.stack) * run.spec.FrameBytes()),
      sessions_(LedgerOf(before)),
      intake_(run.spec.Hash(), layout_, &sessions_, this),
      credits_(sessions_, run.spec.Hash(), receiver_session,
               static_cast<uint64_t>(WindowOf(run).records()),
               static_cast<uint64_t>(WindowOf(run).least_records)),
      stored_steps_(before.stored_steps),
      used_records_(sessions_.TotalStored()) {}

ChunkResult RolloutCore::TakeChunk(const TransitionChunk& chunk, uint64_t latest_session) {
  const ChunkResult result = intake_.Take(chunk, latest_session);
  if (result.stored > 0) {
    const int i = *sessions_.Find(chunk.actor, chunk.session);
    SessionCounters counters = sessions_.at(i);
    counters.discarded += result.stored;  // until an update uses them
    sessions_.Update(i, counters);
  }
  counters_.intake.Count(result);
  return result;
}

std::vector<Credit> RolloutCore::TakeCredits(bool changed_only) {
  // Missing weights hold actors back, so credit never has to.
  credits_.Refresh(/*may_insert=*/true, std::nullopt);
  return credits_.Take(changed_only);
}

Credit RolloutCore::RefusalOf(const TransitionChunk& chunk) const {
  return Refusal(chunk, sessions_, run_.spec.Hash(), receiver_session_);
}

RolloutCore::Lane* RolloutCore::FindLane(uint32_t actor, uint32_t env) {
  if (actor >= kMostActors || env / static_cast<uint32_t>(envs_per_actor_) != actor) return nullptr;
  Lane& lane = lanes_[env];
  if (lane.stack.empty() && lane.vector.empty()) {
    lane.stack.resize(stack_bytes_);
    lane.vector.resize(static_cast<size_t>(observed_.size()));
  }
  return &lane;
}

bool RolloutCore::Take(const SessionCounters& session, const uint8_t* record) {
  const RecordHeader& header = RecordLayout::Header(record);
  Lane* lane = FindLane(session.actor, header.env);
  if (lane == nullptr) return false;
  if (lane->actor_session != session.session) {  // the actor was restarted
    Drop(&lane->building);
    lane->open = false;
    lane->actor_session = session.session;
    lane->session = *sessions_.Find(session.actor, session.session);
  }
  if (header.kind == RecordKind::kReset) {
    TakeReset(record, lane);
    return true;
  }
  if (!TakeStep(record, lane)) {
    OnGap(session, header.env);
    return false;
  }
  ++stored_steps_;
  return true;
}

void RolloutCore::OnGap(const SessionCounters& session, uint32_t env) {
  Lane* lane = FindLane(session.actor, env);
  if (lane == nullptr) return;
  Drop(&lane->building);
  lane->open = false;
}

void RolloutCore::TakeReset(const uint8_t* record, Lane* lane) {
  if (lane->open) EndEpisode(lane);
  Observe(record, /*reset=*/true, lane);
  lane->episode = RecordLayout::Header(record).episode;
  lane->index = 0;
  lane->open = true;
  ++lane->building.records;
  lane->missed = 0;
}

// The actor began another episode although the preceding one has no end. The preceding one was
// faulty, so it is truncated at its last observation.
void RolloutCore::EndEpisode(Lane* lane) {
  Rollout& rollout = lane->building;
  if (rollout.rows == 0)
    return;  // the last step belongs to a complete rollout, which bootstraps there
  rollout.ends.back() = 1.f;
  rollout.continues.back() = 0.f;
  Append<uint8_t>(lane->stack, &rollout.next_frames);
  Append<float>(lane->vector, &rollout.next_vectors);
}

bool RolloutCore::TakeStep(const uint8_t* record, Lane* lane) {
  const RecordHeader& header = RecordLayout::Header(record);
  if (!lane->open || header.episode != lane->episode || header.index != lane->index + 1) {
    return false;
  }
  const WeightsVersion version{header.weights_session, header.weights_update};
  Rollout& building = lane->building;
  // A rollout has one version of the weights.
  if (building.rows > 0 && version != building.version) Drop(&building);
  building.version = version;
  AddRow(record, lane);
  ++building.records;
  ++lane->index;
  lane->missed = 0;
  if (building.rows < steps_) return true;
  building.session = lane->session;
  lane->whole.push_back(std::exchange(building, {}));
  if (!spare_.empty()) {
    building = std::move(spare_.back());
    spare_.pop_back();
  }
  DropOld(lane);
  return true;
}

void RolloutCore::Observe(const uint8_t* record, bool reset, Lane* lane) {
  if (stack_bytes_ > 0) {
    FrameStack stack(lane->stack, run_.spec.FrameBytes());
    if (reset) {
      stack.Reset(layout_.Frame(record));
    } else {
      stack.Push(layout_.Frame(record));
    }
  }
  observed_.Copy(layout_.Vector(record), lane->vector);
}

void RolloutCore::AddRow(const uint8_t* record, Lane* lane) {
  const RecordHeader& header = RecordLayout::Header(record);
  Rollout& rollout = lane->building;
  Append<uint8_t>(lane->stack, &rollout.frames);
  Append<float>(lane->vector, &rollout.vectors);
  Append<float>(layout_.Action(record), &rollout.actions);
  Append<float>(layout_.DrawnAction(record), &rollout.drawn);
  rollout.rewards.push_back(header.reward);
  rollout.log_probs.push_back(header.log_prob);
  const bool terminated = (header.flags & kTerminated) != 0;
  const bool ended = terminated || (header.flags & kTruncated) != 0;
  const bool continues = !ended && rollout.rows + 1 < steps_;
  rollout.bootstraps.push_back(terminated ? 0.f : 1.f);
  rollout.ends.push_back(ended ? 1.f : 0.f);
  rollout.continues.push_back(continues ? 1.f : 0.f);
  ++rollout.rows;
  Observe(record, /*reset=*/false, lane);
  lane->open = !ended;
  if (continues) return;
  Append<uint8_t>(lane->stack, &rollout.next_frames);
  Append<float>(lane->vector, &rollout.next_vectors);
}

void RolloutCore::Drop(Rollout* rollout) {
  if (rollout->rows > 0) ++counters_.dropped_rollouts;
  rollout->Clear();
}

bool RolloutCore::TooOld(const Rollout& rollout) const {
  return rollout.version.session != awaited_.session ||
         rollout.version.update + versions_ahead_ < awaited_.update;
}

// An actor in step has at most versions_ahead + 1 complete rollouts.
void RolloutCore::DropOld(Lane* lane) {
  while (!lane->whole.empty() &&
         (TooOld(lane->whole.front()) || lane->whole.size() > versions_ahead_ + 1)) {
    Drop(&lane->whole.front());
    spare_.push_back(std::move(lane->whole.front()));
    lane->whole.pop_front();
  }
}

void RolloutCore::Await(const WeightsVersion& version) {
  awaited_ = version;
  expected_actors_ = actors_;
  for (auto& [env, lane] : lanes_) DropOld(&lane);
}

void RolloutCore::SetActors(int actors) {
  actors_ = std::clamp(actors, 1, static_cast<int>(kMostActors));
  expected_actors_ = std::min(expected_actors_, actors_);
}

int RolloutCore::Ready() const {
  int ready = 0;
  for (const auto& [env, lane] : lanes_) {
    ready += env < static_cast<uint32_t>(Environments()) && !lane.whole.empty();
  }
  return ready;
}

int RolloutCore::Absent() const {
  int absent = 0;
  for (const auto& [env, lane] : lanes_) {
    absent += env < static_cast<uint32_t>(Environments()) && lane.missed >= kAbsentAfter &&
              lane.whole.empty();
  }
  return absent;
}

BatchSchema RolloutCore::ReadySchema() const {
  return {run_.spec,
          {.batch = Ready() * steps_, .discount = run_.config.learner.discount, .rollout = true}};
}

void RolloutCore::TakeReady(const BatchSchema& schema, uint8_t* data) {
  std::memset(data, 0, schema.total_bytes());
  const BatchView batch = schema.View(data);
  int row = 0;
  for (int i = 0; i < Environments(); ++i) {
    const auto env = static_cast<uint32_t>(i);
    Lane& lane = *FindLane(static_cast<uint32_t>(i / envs_per_actor_), env);
    if (lane.whole.empty()) {
      ++lane.missed;
      continue;
    }
    Rollout rollout = std::move(lane.whole.front());
    lane.whole.pop_front();
    CopyRows(batch, row, env, rollout);
    row += rollout.rows;
    SessionCounters counters = sessions_.at(rollout.session);
    counters.discarded -= rollout.records;
    sessions_.Update(rollout.session, counters);
    used_records_ += rollout.records;
    rollout.Clear();
    spare_.push_back(std::move(rollout));
  }
  CHECK(row == schema.batch()) << row << " rows of " << schema.batch();
}

void RolloutCore::CopyRows(const BatchView& batch, int first_row, uint32_t env,
                           const Rollout& rollout) {
  const auto first = static_cast<size_t>(first_row), rows = static_cast<size_t>(rollout.rows);
  const auto copy = [&](const auto& from, auto to) {
    std::ranges::copy(from, to.begin() + static_cast<ptrdiff_t>(first * (from.size() / rows)));
  };
  copy(rollout.frames, batch.obs_frames);
  copy(rollout.vectors, batch.obs_vector);
  copy(rollout.actions, batch.action);
  copy(rollout.drawn, batch.drawn_action);
  copy(rollout.rewards, batch.reward);
  copy(rollout.bootstraps, batch.bootstrap);
  copy(rollout.log_probs, batch.log_prob);
  copy(rollout.ends, batch.ends);
  copy(rollout.continues, batch.continues);
  const size_t width = static_cast<size_t>(observed_.size());
  size_t next = 0;
  for (size_t t = 0; t < rows; ++t) {
    batch.weights_update[first + t] = rollout.version.update;
    batch.id[first + t] = env;
    if (rollout.continues[t] != 0) continue;
    std::copy_n(rollout.next_frames.data() + next * stack_bytes_, stack_bytes_,
                batch.next_obs_frames.data() + (first + t) * stack_bytes_);
    std::copy_n(rollout.next_vectors.data() + next * width, width,
                batch.next_obs_vector.data() + (first + t) * width);
    ++next;
  }
}

}  // namespace shoal::learner
