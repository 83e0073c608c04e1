// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/real_actors.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>
#include <string_view>
#include <thread>

#include "actor/worlds/environment.h"
#include "common/base/clock.h"
#include "common/base/usable_cores.h"
#include "launch/processes/scratch_folder.h"
#include "tests/benchmark/acting_cost.h"

namespace shoal::bench {
namespace {

constexpr double kPartsTarget = 0.9, kCoresTarget = 0.85;
constexpr double kFlatOut = 1e6;  // steps a second of an actor whose environment costs nothing

RunConfig ReachRun(const char* quality) {
  RunConfig run = UnlearnedRun(1);
  run.config.task = "FetchReach";
  run.config.observation.cameras = {"front"};
  run.config.observation.quality = quality;
  run.spec = worlds::MakeEnvironment(run.config, worlds::MakeRenderContext(run.config.observation))
                 ->spec();
  return run;
}

struct Played {
  std::unique_ptr<worlds::Environment> environment;
  bool running = false;
};

// Physics and rendering of an env step, resets included; nothing else. As many environments as an
// actor has are stepped in turn, because together they exceed a core's caches. The actions are
// those of the actor's policy, because the cost of physics depends on the actions.
double StepSeconds(const RunConfig& run, const std::string& weights, double seconds) {
  const auto render = worlds::MakeRenderContext(run.config.observation);
  const auto selector = MakeSelector(run, weights);
  std::vector<Played> all(static_cast<size_t>(run.config.envs_per_actor));
  for (Played& played : all) played.environment = worlds::MakeEnvironment(run.config, render);
  std::vector<uint8_t> frame(static_cast<size_t>(run.spec.FrameBytes()));
  std::vector<float> vector(static_cast<size_t>(run.spec.RecordedVectorSize()));
  uint64_t episode = 0, steps = 0;
  SteadyTime::duration stepping{};
  while (stepping < std::chrono::duration<double>(seconds)) {
    selector->Select(actor::Acting::kExplore);
    const SteadyTime start = Now();
    for (size_t e = 0; e < all.size(); ++e) {
      Played& played = all[e];
      if (!played.running) played.environment->Reset(++episode, {frame, vector});
      const worlds::StepResult result =
          played.environment->Step(selector->ActionOf(static_cast<int>(e)), {frame, vector});
      played.running = !result.truncated && !result.terminated;
    }
    stepping += Now() - start;
    steps += all.size();
  }
  return std::chrono::duration<double>(stepping).count() / static_cast<double>(steps);
}

ManyActorsFigures Measure(ManyActorsOptions options, int actors) {
  const launch::ScratchFolder folder;
  options.folder = folder.path();
  options.actors = actors;
  return MeasureManyActors(options);
}

// The figure and its limit, for each repetition.
struct Pairs {
  std::vector<double> figures, against;

  void Add(double figure, double held_to) {
    figures.push_back(figure);
    against.push_back(held_to);
  }

  Row Summary(const std::string& stage, const std::string& of, double target) const {
    std::vector<double> ratios;
    ratios.reserve(figures.size());
    for (size_t i = 0; i < figures.size(); ++i) ratios.push_back(figures[i] / against[i]);
    const auto [least, most] = std::ranges::minmax(ratios);
    const double ratio = Median(ratios);
    return {.stage = stage,
            .unit = "env steps/s",
            .against = of,
            .figure = Median(figures),
            .against_figure = Median(against),
            .ratio = ratio,
            .spread = (most - least) / ratio,
            .target = target,
            .repetitions = static_cast<int>(figures.size())};
  }
};

// Env steps per second of a number of threads that act, step and render but do not send: the
// capacity of cores, caches and memory under common load.
double UnsentStepsPerSecond(const RunConfig& run, const std::string& weights, double seconds,
                            int count) {
  std::vector<double> each(static_cast<size_t>(count));
  {
    std::vector<std::jthread> threads;
    threads.reserve(each.size());
    for (double& rate : each) {
      threads.emplace_back([&] { rate = 1 / StepSeconds(run, weights, seconds); });
    }
  }
  return std::accumulate(each.begin(), each.end(), 0.0);
}

std::string Actors(int count, std::string_view quality) {
  return fmt::format("{} actor{} of FetchReach with one 84x84 camera, {}", count,
                     count == 1 ? "" : "s", quality);
}

// Rows of one quality of pictures, repetition by repetition.
class QualityRows {
 public:
  QualityRows(const ManyActorsOptions& options, const char* quality)
      : quality_(quality), cores_(UsableCores()), real_(options), sending_(options) {
    real_.run = ReachRun(quality);
    real_.weights = FirstWeights(*real_.run);
    sending_.run.reset();
    sending_.steps_per_second = kFlatOut;
  }

  void Repeat() {
    const double seconds = real_.seconds / 2;
    const double step = StepSeconds(*real_.run, real_.weights, seconds);
    const double infer = InferSeconds(*real_.run, real_.weights, seconds);
    const double send = 1e-6 * Measure(sending_, 1).actor_us_per_transition;
    const ManyActorsFigures alone = Measure(real_, 1);
    const double one = alone.env_steps_per_second;
    // CPU time below wall time means waiting; CPU time above that of the parts is additional work.
    fmt::print(stderr,
               "one actor, {}: {:.0f} us an env step, {:.0f} us of CPU a transition; alone: step "
               "and render {:.0f} us, infer {:.0f} us, send {:.0f} us\n",
               quality_, 1e6 / one, alone.actor_us_per_transition, 1e6 * step, 1e6 * infer,
               1e6 * send);
    parts_.Add(one, 1 / (step + infer + send));
    all_.Add(Measure(real_, cores_).env_steps_per_second, cores_ * one);
    unsent_.Add(UnsentStepsPerSecond(*real_.run, real_.weights, seconds, cores_), cores_ / step);
  }

  // Env steps a second of actors on all cores, in the last repetition.
  double newest() const { return all_.figures.back(); }

  void AddTo(std::vector<Row>* rows) const {
    rows->push_back(parts_.Summary(Actors(1, quality_),
                                   "1 / (step + render + infer + send, each alone)", kPartsTarget));
    const std::string many = fmt::format("{} times one", cores_);
    const std::string place = fmt::format(", on {} cores", cores_);
    rows->push_back(all_.Summary(Actors(cores_, quality_) + place, many, kCoresTarget));
    rows->push_back(unsent_.Summary(
        Actors(cores_, quality_) + place + ", as threads that send nothing", many, 0));
  }

 private:
  const char* quality_;
  int cores_;
  ManyActorsOptions real_, sending_;
  Pairs parts_, all_, unsent_;
};

}  // namespace

std::vector<Row> RealActorRows(const ManyActorsOptions& options, int repetitions) {
  QualityRows fast(options, "fast"), native(options, "native");
  ManyActorsOptions reference = options;
  reference.run = ReachRun("reference");
  reference.weights = FirstWeights(*reference.run);
  const int cores = UsableCores();
  Pairs slow;
  for (int i = 0; i < repetitions; ++i) {
    fast.Repeat();
    native.Repeat();
    slow.Add(Measure(reference, cores).env_steps_per_second, fast.newest());
  }
  std::vector<Row> rows;
  fast.AddTo(&rows);
  native.AddTo(&rows);
  rows.push_back(slow.Summary(Actors(cores, "reference") + fmt::format(", on {} cores", cores),
                              "quality fast", 0));
  return rows;
}

}  // namespace shoal::bench
