// SPDX-License-Identifier: Apache-2.0
#include "launch/run/coordinator.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "actor/worlds/episode_fault.h"
#include "common/base/error.h"
#include "common/base/saturating_cast.h"
#include "common/base/sleep.h"
#include "common/base/stop.h"
#include "common/base/usable_cores.h"
#include "common/config/learner_threads.h"
#include "common/config/on_policy.h"
#include "common/config/thread_limit.h"
#include "launch/processes/ordered_stop.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/suspension.h"
#include "launch/record/evaluations.h"
#include "launch/run/plan_text.h"
#include "launch/watch/run_totals.h"

namespace shoal::launch {
namespace {

using link::Role;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kTurn{50};
constexpr seconds kMetaPeriod{5};
constexpr seconds kSlowestImport{300};  // import of a Python environment, before the first report

const char* StateText(RunState state) {
  switch (state) {
    case RunState::kRunning:
      return "running";
    case RunState::kDraining:
      return "draining";
    case RunState::kStopping:
      return "stopping";
  }
  return "?";
}

std::optional<CoreSplit> SplitOf(const std::optional<SplitLimits>& limits, const Config& config) {
  if (!limits) return std::nullopt;
  return CoreSplit(*limits, {.actors = config.actors, .threads = config.learner.threads});
}

LiveSettings Restored(const Config& config, const std::vector<SettingChange>& changes) {
  LiveSettings settings(config);
  settings.Restore(changes);
  return settings;
}

// An actor reports only between calls of its environment. The hang limit must exceed
// env.step_timeout, after which the actor itself aborts a call.
HangLimits HangLimitsOf(const Config& config) {
  HangLimits limits;
  if (config.env.id.empty()) return limits;
  const seconds call{static_cast<int64_t>(std::ceil(config.env.step_timeout))};
  limits.report = std::max(limits.report, call + seconds(10));
  limits.start = std::max(limits.start, kSlowestImport);
  return limits;
}

}  // namespace

Coordinator::Coordinator(const Parts& parts)
    : run_(parts.run),
      config_(parts.config),
      hosts_(parts.hosts),
      server_(parts.server),
      progress_(parts.progress),
      before_(parts.before),
      settings_(Restored(config_, before_.changes)),
      topology_(TopologyOf(settings_.config(), hosts_)),
      handler_(settings_, Effects()),
      decisions_(settings_.config(), topology_, before_, Now()),
      split_(SplitOf(parts.split_limits, settings_.config())),
      evaluations_(config_.eval.episodes, decisions_.progress(),
                   [this](const std::string& line) { progress_.Say(line); }),
      record_(run_, config_, [this](const std::string& line) { progress_.Say(line); }),
      watch_(
          run_, parts.hub, [this](const std::string& line) { progress_.Say(line); },
          &record_.faults()),
      supervisor_(
          RestartLimits(), HangLimitsOf(config_),
          [this](const std::string& line) { progress_.Say(line); }, parts.start),
      control_(parts.hub, settings_),
      inbox_(parts.hub, topology_),
      start_(AwakeNow()),
      usable_cores_(UsableCores()),
      suspensions_said_(Suspensions()),
      refusals_said_(RefusedSuspensions()) {
  for (const EvaluationPoint& point : ReadEvaluations(run_)) {
    evaluations_.Recall(point);
    decisions_.Recall(point);
  }
}

CommandHandler::Effects Coordinator::Effects() {
  return {.running = [this] { return decisions_.TakesCommands(); },
          .env_steps = [this] { return decisions_.env_steps(); },
          .stop = [this] { decisions_.OnStopCommand(); },
          .scale = [this](int from, int to) { Scale(from, to); },
          .note = [this](const SettingChange& change) { Note(change); },
          .check =
              [](const Config& config) {
                CheckCores("learner.threads", config.learner.threads, ReadCoreLimits());
              }};
}

RunResult Coordinator::Run(const std::function<void()>& on_started) {
  for (const ProcessSpec& spec : PlanProcesses(topology_, settings_.config(), run_, hosts_)) {
    supervisor_.Start(spec);
  }
  record_.scalars().WriteConfig(config_);
  WriteMeta(Now());
  Stop(WaitForEnd(on_started));
  return Result();
}

RunEnd Coordinator::WaitForEnd(const std::function<void()>& on_started) {
  bool started = on_started == nullptr;
  const auto has_reported = [this](const ProcessName& name) {
    return watch_.view().Heard(name.role, name.index);
  };
  while (true) {
    Tick();
    if (!started && decisions_.Started(has_reported)) {
      on_started();
      started = true;
    }
    const SteadyTime now = Now();
    if (const auto failure = supervisor_.Poll(now)) Say(decisions_.Fail(*failure));
    if (supervisor_.Running(RoleName(Role::kLearner)) == 0) decisions_.OnLearnerDeath();
    Say(decisions_.OnStandings(supervisor_.Standing(RoleName(Role::kActor), now),
                               supervisor_.Standing(RoleName(Role::kEval), now), now));
    if (const auto end = decisions_.MustEnd(StopRequested())) return *end;
    SleepFor(kTurn);
  }
}

void Coordinator::Stop(RunEnd end) {
  Say(decisions_.BeginEnd(end));
  const int stops = StopRequests();  // Ctrl-C presses that were handled before
  StopDeadlines deadlines;
  if (!decisions_.CanDrain(supervisor_.Running(RoleName(Role::kReplay)))) {
    deadlines.drain = milliseconds(0);
  }
  StopInOrder(supervisor_, deadlines,
              {.announce =
                   [this](RunState state) {
                     control_.Order(state);
                     Tick();
                   },
               .tick = [this] { Tick(); },
               .at_once = [stops] { return StopRequests() > stops; },
               .say = [this](const std::string& line) { progress_.Say(line); },
               .settled = [this] { return decisions_.Settled(); },
               .work =
                   [this] {
                     const MetricsView& view = watch_.view();
                     return view.Total(RoleName(Role::kLearner), "updates") +
                            view.Total(RoleName(Role::kEval), "seconds_evaluating");
                   }});
  Tick(/*last=*/true);  // processes the last messages received
  Say(decisions_.OnEnded());
  evaluations_.End(Now());
}

RunResult Coordinator::Result() {
  energy_.Sample();
  RunMeta meta = Meta();
  meta.exit = ToString(decisions_.FinalEnd());
  record_.scalars().WriteEnd(decisions_.FinalEnd() != RunEnd::kFailed);
  record_.Retry();
  std::set<std::string> unwritten = record_.faults().failing();
  unwritten.merge(std::set<std::string>(supervisor_.unwritten_exits()));
  return {.meta = std::move(meta),
          .clean = supervisor_.unclean_exits().empty(),
          .deaths = supervisor_.DescribeDeaths(),
          .unwritten = std::move(unwritten),
          .bottleneck = FindBottleneck(TotalsOf(watch_.view()), Resources())};
}

void Coordinator::Tick(bool last) {
  const SteadyTime now = Now();
  control_.Beat(now);
  SaySuspensions();
  try {
    TakeMessages(now);
    const ProcessName learner = topology_.OnlyLearner().Name();
    record_.OnUnwrittenCheckpoints(watch_.view().Get(learner, "checkpoints_unwritten").value_or(0),
                                   learner.Text());
    TakeCommands();
  } catch (const Error& e) {
    Say(decisions_.Fail(e.what()));
  }
  WriteFiles(now);
  Show(last, now);
}

void Coordinator::SaySuspensions() {
  if (Suspensions() != suspensions_said_) {
    suspensions_said_ = Suspensions();
    watch_.Forget(Elapsed());
    progress_.Resume();
    progress_.Say("goes on after a pause (Ctrl-Z)");
  }
  if (RefusedSuspensions() == refusals_said_) return;
  refusals_said_ = RefusedSuspensions();
  progress_.Say(
      "a run on several hosts cannot pause, so it keeps running; Ctrl-C stops it, and shoal train "
      "--resume continues it");
}

void Coordinator::TakeMessages(SteadyTime now) {
  for (const MetricsMessage& message : inbox_.TakeReports()) {
    watch_.OnReport(message, now);
    supervisor_.Heard(message.role, static_cast<int>(message.id), message.pid, now);
    record_.scalars().WriteTraining(message, now);
  }
  for (const ReplayProgress& word : inbox_.TakeReplayProgress()) Say(decisions_.OnReplay(word));
  for (const LearnerProgress& word : inbox_.TakeLearnerProgress()) decisions_.OnLearner(word);
  for (const EvalMessage& message : evaluations_.Take(inbox_.TakeEvaluations(), now)) {
    TakeEvaluation(message);
  }
}

void Coordinator::TakeEvaluation(const EvalMessage& message) {
  EvaluationRecord record = RecordOf(message, Elapsed());
  const EvaluationPoint point = record.point;
  record_.WriteEvaluation(std::move(record));
  const RunDecisions::Verdict verdict = decisions_.OnEvaluation(point);
  progress_.Say(fmt::format("evaluation at {} env steps, {} updates: {}{}", point.env_steps,
                            point.updates, FormatScore(point), verdict.best ? " (best)" : ""));
  record_.scalars().WriteEvaluation(point);
  Say(verdict.warning);
  WriteMeta(Now());
  record_.KeepCheckpointsOf(decisions_.candidates());
}

void Coordinator::TakeCommands() {
  for (const CommandMessage& command : server_.TakeCommands()) {
    const ReplyMessage reply = handler_.Handle(command);
    if (reply.accepted && (reply.key == "actors" || reply.key == "learner.threads")) split_.reset();
    std::string line = "command: " + command.verb;
    for (const std::string& argument : command.arguments) line += " " + argument;
    progress_.Say(fmt::format("{}: {}{}", line, reply.accepted ? "" : "refused: ", reply.text));
    server_.Answer(reply);
  }
}

// The actors with the highest numbers leave first.
void Coordinator::Scale(int from, int to) {
  if (!hosts_.empty()) {
    throw RuntimeError(
        "a run on several hosts has a fixed number of actors, which its hosts file gives");
  }
  const char* actor = RoleName(Role::kActor);
  int id = from;
  try {
    for (; id < to; ++id) supervisor_.Start(ActorProcess(settings_.config(), run_, id));
  } catch (const Error&) {  // undo all: the next order begins at the same number
    while (--id >= from) supervisor_.Retire(actor, id, Now());
    throw;
  }
  for (id = from - 1; id >= to; --id) supervisor_.Retire(actor, id, Now());
  const std::string shared = SharedCoresText(to, usable_cores_);
  if (to > from && !shared.empty()) progress_.Say(shared);
}

// The actors are changed first: if one does not start, the threads are not changed either.
void Coordinator::DivideCores() {
  if (!split_ || decisions_.end() || !decisions_.TakesCommands()) return;
  const Config& config = settings_.config();
  const auto steps = decisions_.env_steps();
  const auto move = split_->Look(Elapsed() - before_.wall_seconds, CountsOf(watch_.view()),
                                 config.replay.samples_per_insert.At(steps) / config.learner.batch);
  if (!move) return;
  progress_.Say(move->line);
  try {
    Divide(move->to);
  } catch (const Error& e) {
    split_.reset();
    progress_.Say(fmt::format("the cores stay divided as they were: {}", e.what()));
  }
}

void Coordinator::Divide(const Split& to) {
  const Split from{.actors = settings_.config().actors,
                   .threads = settings_.config().learner.threads};
  LiveSettings changed = settings_;
  std::vector<SettingChange> changes;
  if (to.actors != from.actors) {
    changes.push_back(changed.SetActors(std::to_string(to.actors)));
    Scale(from.actors, to.actors);
  }
  if (to.threads != from.threads) {
    changes.push_back(
        changed.Assign(fmt::format("learner.threads={}", to.threads), decisions_.env_steps()));
  }
  settings_ = changed;
  for (const SettingChange& change : changes) Note(change);
}

void Coordinator::Note(SettingChange change) {
  change.time = UtcTimestamp();
  change.env_steps = decisions_.env_steps();
  change.updates = decisions_.updates();
  before_.changes.push_back(std::move(change));
  decisions_.Change(settings_.config());
  control_.Order(settings_);
  meta_due_ = true;
}

void Coordinator::WriteFiles(SteadyTime now) {
  const bool periodic = !meta_written_ || now - *meta_written_ > kMetaPeriod;
  if (periodic) record_.Retry();
  if (periodic || meta_due_) WriteMeta(now);
}

void Coordinator::WriteMeta(SteadyTime now) {
  meta_written_ = now;
  meta_due_ = false;
  energy_.Sample();
  record_.WriteMeta(Meta());
}

void Coordinator::Show(bool last, SteadyTime now) {
  const bool view_due = last || server_.Due(now);
  if (view_due && !last) DivideCores();
  if (view_due) watch_.LookBack(Elapsed(), decisions_.env_steps(), Resources());
  const ProgressFigures figures = Figures(now);
  record_.scalars().WriteRollouts(watch_.view(), figures, now);
  record_.FlushScalars();
  // The last view is always written to metrics.jsonl: only it may contain the last evaluation.
  if (view_due) {
    const CoordinatorCounts counts{.messages_dropped = inbox_.dropped(),
                                   .reports_refused = inbox_.refused(),
                                   .evaluations_repeated = evaluations_.repeated(),
                                   .evaluations_refused = evaluations_.refused()};
    RunViewMessage shown;
    shown.state = figures.state;
    shown.env_steps = figures.env_steps;
    shown.updates = decisions_.updates();
    shown.trouble = figures.trouble;
    shown.processes = watch_.Reports(figures, settings_.config(), Resources(), counts, now);
    server_.Show(std::move(shown), now);
  }
  progress_.Show(figures, now);
}

void Coordinator::Say(const std::optional<std::string>& line) {
  if (line) progress_.Say(*line);
}

double Coordinator::Elapsed() const {
  return before_.wall_seconds + std::chrono::duration<double>(AwakeNow() - start_).count();
}

RunResources Coordinator::Resources() const {
  const Config& config = settings_.config();
  return {.usable_cores = static_cast<double>(usable_cores_),
          .actors = config.actors,
          .actors_elsewhere = !hosts_.empty(),
          .learner_threads = config.learner.threads,
          // 0: no advice on the division. A run that divides the cores itself has measured it.
          .most_threads = split_ ? 0 : MostThreads(config),
          .may_play_ahead = LearnsOnPolicy(config) && config.ppo.versions_ahead == 0};
}

ProgressFigures Coordinator::Figures(SteadyTime now) const {
  ProgressFigures figures = watch_.Reported(now);
  figures.run = config_.run_name;
  figures.state = StateText(control_.state());
  figures.elapsed_seconds = Elapsed();
  figures.env_steps = decisions_.env_steps();
  figures.budget = static_cast<uint64_t>(settings_.config().env_steps);
  watch_.AddLately(&figures);
  figures.last_evaluation = decisions_.last_evaluation();
  figures.best = decisions_.best();
  figures.processes = supervisor_.Running("");
  figures.restarts = before_.restarts + supervisor_.restarts();
  figures.actors_working = decisions_.ActorsWorking();
  figures.trouble = decisions_.Trouble();
  for (const auto& [cause, count] : FaultyEpisodes()) figures.faulty_episodes += count;
  return figures;
}

std::map<std::string, uint64_t> Coordinator::FaultyEpisodes() const {
  std::map<std::string, uint64_t> counts = before_.faulty_episodes;
  for (const worlds::FaultCause cause : worlds::kFaultCauses) {
    const std::string name(worlds::NameOf(cause));
    const double count = watch_.view().Total(RoleName(Role::kActor), "faulty_episodes_" + name);
    if (count > 0) counts[name] += SaturatingCast<uint64_t>(count);
  }
  return counts;
}

RunMeta Coordinator::Meta() const {
  RunMeta meta = before_;
  // "running" until the end is reached, so that --resume accepts the run if the coordinator is
  // killed earlier.
  meta.exit = "running";
  meta.error = decisions_.error();
  meta.env_steps = decisions_.env_steps();
  meta.updates = decisions_.updates();
  meta.wall_seconds = Elapsed();
  meta.target = decisions_.target();
  meta.first_success = decisions_.first_success();
  meta.best = decisions_.best();
  meta.restarts += supervisor_.restarts();
  meta.resends += SaturatingCast<uint64_t>(watch_.view().Total(RoleName(Role::kActor), "resends"));
  meta.faulty_episodes = FaultyEpisodes();
  AddCost(&meta);
  return meta;
}

void Coordinator::AddCost(RunMeta* meta) const {
  const auto energy = energy_.WattHours();
  if (!energy) meta->energy_wh.reset();
  if (meta->energy_wh) *meta->energy_wh += *energy;
  if (!meta->cpu_seconds) return;
  for (const auto& [role, totals] : TotalsOf(watch_.view())) {
    *meta->cpu_seconds += totals.cpu_seconds;
  }
}

}  // namespace shoal::launch
