// SPDX-License-Identifier: Apache-2.0
#include "launch/run/coordinator.h"

#include <algorithm>
#include <set>
#include <thread>
#include <utility>

#include "actor/worlds/episode_fault.h"
#include "common/base/error.h"
#include "common/base/saturating_cast.h"
#include "common/base/stop.h"
#include "common/base/usable_cores.h"
#include "common/base/write_faults.h"
#include "common/config/on_policy.h"
#include "common/link/writer.h"
#include "common/run_folder/run_file_names.h"
#include "common/run_folder/update_page.h"
#include "common/wire/process_name.h"
#include "launch/processes/ordered_stop.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/suspension.h"
#include "launch/record/evaluations.h"
#include "launch/record/kept_checkpoints.h"
#include "launch/record/run_folder.h"
#include "launch/run/best_evaluation.h"
#include "launch/run/command_handler.h"
#include "launch/run/evaluation_intake.h"
#include "launch/run/flat_score.h"
#include "launch/run/live_settings.h"
#include "launch/run/plan_text.h"
#include "launch/run/run_inbox.h"
#include "launch/run/run_progress.h"
#include "launch/run/run_watch.h"
#include "launch/run/working_actors.h"
#include "launch/watch/scalar_log.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kPoll{50};
constexpr milliseconds kHeartbeat{300};
constexpr seconds kMetaPeriod{5};

const char* ToString(RunState state) {
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

LiveSettings RestoredSettings(const Config& config, const std::vector<SettingChange>& changes) {
  LiveSettings settings(config);
  settings.Restore(changes);
  return settings;
}

}  // namespace

struct Coordinator::Impl {
  Impl(const std::filesystem::path& folder, const RunConfig& run_config, link::Hub& hub,
       const RunMeta& before, const std::vector<RemoteHost>& remote_hosts, OperatorDesk& run_desk,
       Progress& shown)
      : run(folder),
        config(run_config.config),
        hosts(remote_hosts),
        settings(RestoredSettings(config, before.changes)),
        topology(TopologyOf(settings.config(), remote_hosts)),
        handler(settings, Effects()),
        desk(run_desk),
        progress(shown),
        meta(before),
        rule(config),
        evaluations(config.eval.episodes, run_progress,
                    [this](const std::string& line) { progress.Say(line); }),
        watch(
            folder, hub, [this](const std::string& line) { progress.Say(line); }, &faults),
        scalars(run),
        supervisor(RestartLimits(), HangLimits(),
                   [this](const std::string& line) { progress.Say(line); }),
        control(hub),
        inbox(hub, topology) {
    settings.AddTo(&order);
    rule.Change(settings.config());
    for (const EvaluationPoint& point : ReadEvaluations(run)) {
      evaluations.Recall(point);
      Count(point);
    }
    meta.target = rule.target();
  }

  CommandHandler::Effects Effects() {
    return {.running = [this] { return order.state == RunState::kRunning && !stop_asked; },
            .env_steps = [this] { return EnvSteps(); },
            .stop = [this] { stop_asked = true; },
            .scale = [this](int from, int to) { Scale(from, to); },
            .note = [this](const SettingChange& change) { Note(change); }};
  }

  double Elapsed() const {
    return meta.wall_seconds + std::chrono::duration<double>(AwakeNow() - start).count();
  }
  RunResources Resources() const {
    return {.usable_cores = static_cast<double>(usable_cores),
            .actors = settings.config().actors,
            .actors_elsewhere = !hosts.empty(),
            .learner_threads = settings.config().learner.threads,
            .may_play_ahead =
                LearnsOnPolicy(settings.config()) && settings.config().ppo.versions_ahead == 0};
  }
  uint64_t EnvSteps() const { return std::max(meta.env_steps, run_progress.stored_steps()); }

  // Since this coordinator's start.
  uint64_t Resends() const {
    return SaturatingCast<uint64_t>(watch.view().Total("actor", "resends"));
  }

  // Of the whole run, by cause.
  std::map<std::string, uint64_t> FaultyEpisodes() const {
    std::map<std::string, uint64_t> counts = meta.faulty_episodes;
    for (const worlds::FaultCause cause : worlds::kFaultCauses) {
      const std::string name(worlds::NameOf(cause));
      const double count = watch.view().Total("actor", "faulty_episodes_" + name);
      if (count > 0) counts[name] += SaturatingCast<uint64_t>(count);
    }
    return counts;
  }

  RunResult Run(const std::function<void()>& on_started);
  std::string WaitForEnd(const std::function<void()>& on_started);
  // Every process of the run has reported.
  bool Started() const;
  // Ends the run where it cannot go on without the actors that are down.
  void LookAtActors(SteadyTime now);
  void TakeCommands();
  void Scale(int from, int to);
  void Note(SettingChange change);
  void Stop();
  // Heartbeat, messages, display. What fails in it is remembered as the run's failure.
  void Tick(bool last = false);
  // Says that the learner cannot write its checkpoints, and that it can again.
  void SayUnwrittenCheckpoints();
  // Says that the run was suspended, or why it was not.
  void SaySuspensions();
  ProgressFigures Figures(SteadyTime now) const;
  void ShowView(const ProgressFigures& figures, SteadyTime now);
  void Heartbeat(SteadyTime now);
  void TakeMessages(SteadyTime now);
  void TakeEvaluation(const EvalMessage& message);
  void KeepCandidates();
  bool HasCheckpoint(const std::string& name) const;
  // Tries again what could not be written.
  void RetryWrites();
  // Returns a warning where the run gets no better.
  std::optional<std::string> Count(const EvaluationPoint& point);
  void Fail(const std::string& why);
  void StoreMeta();
  // Whether the learner may be told to stop: where the budget ended the run (and in lockstep, which
  // must end the same way each time), it finishes what the stored steps allow and its last
  // evaluation arrives.
  bool Settled() const;

  const std::filesystem::path run;
  const Config config;  // as the run was started
  const std::vector<RemoteHost> hosts;
  LiveSettings settings;
  const link::RunTopology topology;  // as started; `shoal scale` may have changed the actors since
  CommandHandler handler;
  OperatorDesk& desk;
  Progress& progress;
  WriteFaults faults{[this](const std::string& line) { progress.Say(line); }};
  EvaluationStore evaluation_store{run, &faults};
  RunMeta meta;  // wall_seconds: of the sessions before this one, until the end
  StopRule rule;
  RunProgress run_progress;
  EvaluationIntake evaluations;
  BestEvaluation bests;
  FlatScore flat;
  std::optional<EvaluationPoint> last_evaluation;
  RunWatch watch;
  ScalarLog scalars;
  Supervisor supervisor;
  WorkingActors working_actors{Now()};
  RoleStanding actors, evaluation_actor;  // as they were looked at last
  link::Writer<ControlMessage> control;
  RunInbox inbox;

  ControlMessage order{.epoch = 1};
  SteadyTime start = AwakeNow();
  std::optional<SteadyTime> heartbeat, meta_stored;
  bool stop_asked = false;        // by a command
  bool evaluated = false;         // an evaluation was delivered
  bool meta_due = false;          // something happened that it records
  bool checkpoints_fail = false;  // of the learner, by its last report
  bool candidates_due = false;    // not all of them could be kept
  std::set<std::string> gone{};   // checkpoints of candidates that were never written
  const int usable_cores = UsableCores();
  int suspensions_said = Suspensions(), refusals_said = RefusedSuspensions();
  int stops_before_end = 0;  // Ctrl-C's that had been answered when the ordered stop began
};

Coordinator::Coordinator(const std::filesystem::path& run, const RunConfig& config, link::Hub& hub,
                         const RunMeta& meta, const std::vector<RemoteHost>& hosts,
                         OperatorDesk& desk, Progress& progress)
    : impl_(std::make_unique<Impl>(run, config, hub, meta, hosts, desk, progress)) {}

Coordinator::~Coordinator() = default;

RunResult Coordinator::Run(const std::function<void()>& on_started) {
  return impl_->Run(on_started);
}

RunResult Coordinator::Impl::Run(const std::function<void()>& on_started) {
  for (const ProcessSpec& spec : PlanProcesses(topology, settings.config(), run, hosts)) {
    supervisor.Start(spec);
  }
  scalars.WriteConfig(config);
  meta.exit = "running";
  StoreMeta();
  meta.exit = WaitForEnd(on_started);
  Stop();
  meta.env_steps = EnvSteps();
  meta.wall_seconds = Elapsed();
  meta.restarts += supervisor.restarts();
  meta.resends += Resends();
  meta.faulty_episodes = FaultyEpisodes();
  if (!meta.error.empty()) meta.exit = "failed";
  scalars.WriteEnd(meta.exit != "failed");
  RetryWrites();
  std::set<std::string> unwritten = faults.failing();
  unwritten.merge(std::set<std::string>(supervisor.unwritten_exits()));
  return {.meta = meta,
          .clean = supervisor.unclean_exits().empty(),
          .deaths = supervisor.DescribeDeaths(),
          .unwritten = std::move(unwritten),
          .bottleneck = FindBottleneck(TotalsOf(watch.view()), Resources())};
}

std::string Coordinator::Impl::WaitForEnd(const std::function<void()>& on_started) {
  bool started = on_started == nullptr;
  while (true) {
    Tick();
    if (!started && Started()) {
      on_started();
      started = true;
    }
    if (const auto failure = supervisor.Poll(Now())) Fail(*failure);
    LookAtActors(Now());
    if (!meta.error.empty()) return "failed";
    if (StopRequested() || stop_asked) return "interrupted";
    if (rule.TargetReached()) return "target";
    if (rule.BudgetSpent(EnvSteps())) return "budget";
    std::this_thread::sleep_for(kPoll);
  }
}

bool Coordinator::Impl::Started() const {
  return std::ranges::all_of(topology.children(), [this](const link::RunProcess& child) {
    const ProcessName name = child.Name();
    if (watch.view().Heard(name.role, name.index)) return true;
    const bool retired = child.role == link::Role::kActor &&
                         std::cmp_greater_equal(child.index, settings.config().actors);
    // Others work, so that the run has started without it.
    const bool down =
        actors.working > 0 &&
        std::ranges::find(actors.down, name.Text(), &DownProcess::name) != actors.down.end();
    return retired || down;
  });
}

void Coordinator::Impl::LookAtActors(SteadyTime now) {
  actors = supervisor.Standing("actor", now);
  evaluation_actor = supervisor.Standing("eval", now);
  const std::chrono::seconds patience(config.stop.without_actors);
  if (const auto why = working_actors.Look(actors, patience, now)) Fail(*why);
  if (const auto why = MissingEvaluations(evaluation_actor, evaluated)) Fail(*why);
}

void Coordinator::Impl::TakeCommands() {
  for (const CommandMessage& command : desk.TakeCommands()) {
    const ReplyMessage reply = handler.Handle(command);
    std::string line = "command: " + command.verb;
    for (const std::string& argument : command.arguments) line += " " + argument;
    progress.Say(fmt::format("{}: {}{}", line, reply.accepted ? "" : "refused: ", reply.text));
    desk.Answer(reply);
  }
}

// The actors with the highest numbers go first.
void Coordinator::Impl::Scale(int from, int to) {
  if (!hosts.empty()) {
    throw RuntimeError("a run on several hosts has the actors that its hosts file says");
  }
  int id = from;
  try {
    for (; id < to; ++id) supervisor.Start(ActorProcess(run, id));
  } catch (const Error&) {  // refused as a whole: the next order begins at the same number
    while (--id >= from) supervisor.Retire("actor", id, Now());
    throw;
  }
  for (id = from - 1; id >= to; --id) supervisor.Retire("actor", id, Now());
  const std::string shared = SharedCoresText(to, usable_cores);
  if (to > from && !shared.empty()) progress.Say(shared);
}

void Coordinator::Impl::Note(SettingChange change) {
  change.time = UtcTimestamp();
  change.env_steps = EnvSteps();
  change.updates = meta.updates;
  meta.changes.push_back(std::move(change));
  rule.Change(settings.config());
  meta.target = rule.target();
  meta.first_success = rule.first_success();
  settings.AddTo(&order);
  ++order.epoch;
  heartbeat.reset();  // the next tick tells at once
  meta_due = true;
}

void Coordinator::Impl::Stop() {
  actors = evaluation_actor = {};  // whoever is down from now on is not missed
  if (stop_asked && meta.exit == "interrupted") {
    progress.Say("stopping the run, as commanded");
  } else if (meta.exit == "interrupted") {
    progress.Say("stopping the run; Ctrl-C again to stop at once");
  }
  if (meta.exit == "target")
    progress.Say("the success asked for (stop.success) is reached: stopping the run");
  if (meta.exit == "budget") progress.Say("the budget (env_steps) is spent: stopping the run");
  stops_before_end = StopRequests();
  StopDeadlines deadlines;
  // A run with a replay stores nothing without it.
  if (topology.Has(link::Role::kReplay) && supervisor.Running("replay") == 0)
    deadlines.drain = milliseconds(0);
  StopInOrder(supervisor, deadlines,
              {.announce =
                   [this](RunState state) {
                     order.state = state;
                     ++order.epoch;
                     heartbeat.reset();  // the next tick tells at once
                     Tick();
                   },
               .tick = [this] { Tick(); },
               .at_once = [this] { return StopRequests() > stops_before_end; },
               .say = [this](const std::string& line) { progress.Say(line); },
               .settled = [this] { return Settled(); }});
  Tick(/*last=*/true);  // what arrived last
  evaluations.End(Now());
}

void Coordinator::Impl::Tick(bool last) {
  const SteadyTime now = Now();
  Heartbeat(now);
  SaySuspensions();
  try {
    TakeMessages(now);
    SayUnwrittenCheckpoints();
    TakeCommands();
  } catch (const Error& e) {
    Fail(e.what());
  }
  const bool periodic = !meta_stored || now - *meta_stored > kMetaPeriod;
  if (periodic) RetryWrites();
  if (periodic || meta_due) StoreMeta();
  const bool view_due = last || desk.Due(now);
  if (view_due) {
    watch.LookBack(Elapsed(), EnvSteps(), Resources());
  }
  const ProgressFigures figures = Figures(now);
  scalars.WriteRollouts(watch.view(), figures, now);
  faults.Try(kTensorBoardFolder, [this] { scalars.Flush(); });
  // The last view is in metrics.jsonl whenever it comes: it alone may know the last evaluation.
  if (view_due) ShowView(figures, now);
  progress.Show(figures, now);
}

void Coordinator::Impl::SayUnwrittenCheckpoints() {
  const ProcessName learner = topology.OnlyLearner().Name();
  const double unwritten = watch.view().Get(learner, "checkpoints_unwritten").value_or(0);
  if ((unwritten > 0) == checkpoints_fail) return;
  checkpoints_fail = unwritten > 0;
  progress.Say(checkpoints_fail
                   ? fmt::format("{} cannot write its checkpoints: it keeps them and tries again; "
                                 "why: {}",
                                 learner.Text(), LogFile(run, learner.Text()).string())
                   : fmt::format("{} has written its checkpoints", learner.Text()));
}

void Coordinator::Impl::SaySuspensions() {
  if (Suspensions() != suspensions_said) {
    suspensions_said = Suspensions();
    watch.Forget(Elapsed());
    progress.Resume();
    progress.Say("goes on after a pause (Ctrl-Z)");
  }
  if (RefusedSuspensions() == refusals_said) return;
  refusals_said = RefusedSuspensions();
  progress.Say(
      "a run on several hosts does not pause: it goes on; end it with Ctrl-C, and shoal train "
      "--resume goes on with it");
}

ProgressFigures Coordinator::Impl::Figures(SteadyTime now) const {
  ProgressFigures figures = watch.Reported(now);
  figures.run = config.run_name;
  figures.state = ToString(order.state);
  figures.elapsed_seconds = Elapsed();
  figures.env_steps = EnvSteps();
  figures.budget = static_cast<uint64_t>(settings.config().env_steps);
  watch.AddLately(&figures);
  figures.last_evaluation = last_evaluation;
  figures.best = meta.best;
  figures.processes = supervisor.Running("");
  figures.restarts = meta.restarts + supervisor.restarts();
  figures.actors_working = settings.config().actors - static_cast<int>(actors.down.size());
  figures.trouble = DescribeTrouble(actors, evaluation_actor);
  for (const auto& [cause, count] : FaultyEpisodes()) figures.faulty_episodes += count;
  return figures;
}

void Coordinator::Impl::ShowView(const ProgressFigures& figures, SteadyTime now) {
  const CoordinatorCounts counts{.messages_dropped = inbox.dropped(),
                                 .reports_refused = inbox.refused(),
                                 .evaluations_repeated = evaluations.repeated(),
                                 .evaluations_refused = evaluations.refused()};
  RunViewMessage shown;
  shown.state = figures.state;
  shown.env_steps = figures.env_steps;
  shown.updates = meta.updates;
  shown.trouble = figures.trouble;
  shown.processes = watch.Reports(figures, settings.config(), Resources(), counts, now);
  desk.Show(std::move(shown), now);
}

void Coordinator::Impl::Heartbeat(SteadyTime now) {
  if (heartbeat && now - *heartbeat < kHeartbeat) return;
  order.time = WallTimeSeconds();
  if (control.Write(order)) heartbeat = now;  // else again at the next tick
}

void Coordinator::Impl::TakeMessages(SteadyTime now) {
  for (const MetricsMessage& message : inbox.TakeReports()) {
    watch.OnReport(message, now);
    supervisor.Heard(message.role, static_cast<int>(message.id), message.pid, now);
    scalars.WriteTraining(message, now);
  }
  for (const ReplayProgress& word : inbox.TakeReplayProgress()) {
    if (!run_progress.OnReplay(word)) continue;
    progress.Say(
        fmt::format("replay-{} starts empty, env steps go on from {}; training goes on once it "
                    "holds {} sampleable transitions again (replay.min_size)",
                    word.replay, EnvSteps(), config.replay.min_size));
  }
  for (const LearnerProgress& word : inbox.TakeLearnerProgress()) {
    run_progress.OnLearner(word);
    meta.updates = *run_progress.updates();
  }
  for (const EvalMessage& message : evaluations.Take(inbox.TakeEvaluations(), now)) {
    TakeEvaluation(message);
  }
}

void Coordinator::Impl::TakeEvaluation(const EvalMessage& message) {
  evaluated = true;
  EvaluationRecord record = RecordOf(message, Elapsed());
  const EvaluationPoint point = record.point;
  evaluation_store.Write(std::move(record));
  const auto warning = Count(point);
  const bool best = bests.newest_is_best();
  progress.Say(fmt::format("evaluation at {} env steps, {} updates: {}{}", point.env_steps,
                           point.updates, FormatScore(point), best ? " (best)" : ""));
  scalars.WriteEvaluation(point);
  if (warning) progress.Say(*warning);
  StoreMeta();
  KeepCandidates();
}

void Coordinator::Impl::KeepCandidates() {
  std::vector<EvaluationPoint> candidates = bests.candidates();
  const auto unnamed = [](const EvaluationPoint& point) { return point.checkpoint.empty(); };
  if (std::ranges::any_of(candidates, unnamed)) return;
  // The learner gives up older checkpoints that it cannot write. Once it can write again, one that
  // is missing stays missing, and the best is chosen among the others.
  if (!checkpoints_fail) {
    std::erase_if(candidates, [this](const EvaluationPoint& point) {
      if (HasCheckpoint(point.checkpoint)) return false;
      if (gone.insert(point.checkpoint).second) {
        progress.Say(fmt::format("checkpoint {} was never written: the best is chosen without it",
                                 point.checkpoint));
      }
      return true;
    });
  }
  const std::string what = fmt::format("{}/{}", kCheckpointFolder, kBestCheckpoint);
  candidates_due = !faults.Try(what, [&] {
    if (candidates.empty()) return;
    std::vector<std::string> names;
    for (const EvaluationPoint& candidate : candidates) names.push_back(candidate.checkpoint);
    // If this fails, the best of before is still whole.
    KeepCheckpoints(
        run, names,
        std::ranges::max_element(candidates, {}, &EvaluationPoint::mean_return)->checkpoint);
  });
}

bool Coordinator::Impl::HasCheckpoint(const std::string& name) const {
  std::error_code error;
  const std::filesystem::path folder = run / kCheckpointFolder;
  return std::filesystem::exists(folder / name, error) ||
         std::filesystem::exists(folder / kCandidateFolder / name, error);
}

void Coordinator::Impl::RetryWrites() {
  evaluation_store.Retry();
  if (candidates_due) KeepCandidates();
  faults.Try(kTensorBoardFolder, [this] { scalars.Flush(); });
}

std::optional<std::string> Coordinator::Impl::Count(const EvaluationPoint& point) {
  rule.OnEvaluation(point);
  meta.first_success = rule.first_success();
  last_evaluation = point;
  bests.OnEvaluation(point);
  meta.best = *bests.best();
  return flat.OnEvaluation(point, rule.target());
}

void Coordinator::Impl::Fail(const std::string& why) {
  if (!meta.error.empty()) return;  // the first one is the reason; a full disk would repeat itself
  meta.error = why;
  progress.Say("error: " + why);
}

void Coordinator::Impl::StoreMeta() {
  meta_stored = Now();
  meta_due = false;
  RunMeta now = meta;
  now.env_steps = EnvSteps();
  now.wall_seconds = Elapsed();
  now.restarts += supervisor.restarts();
  now.resends += Resends();
  now.faulty_episodes = FaultyEpisodes();
  faults.Try(kMetaFile, [&] {
    now.updates_lost = ReadLostUpdates(run);
    WriteRunMeta(run, config, now);
  });
}

bool Coordinator::Impl::Settled() const {
  if (meta.exit != "budget" && !(config.lockstep && meta.exit == "target")) return true;
  if (!run_progress.drained()) return false;
  return (last_evaluation ? last_evaluation->updates : 0) >= run_progress.evaluation_due();
}

}  // namespace shoal::launch
