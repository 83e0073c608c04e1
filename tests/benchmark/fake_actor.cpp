// SPDX-License-Identifier: Apache-2.0
// shoal-fake-actor: the real training actor with environments that use no CPU time: frames are
// filled, not rendered, and each step sleeps for a fixed time. Used to measure the cost of many
// actors for other processes.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <thread>

#include "actor/loop/training_actor.h"
#include "common/base/clock.h"
#include "common/base/command_line.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/main_guard.h"
#include "common/base/random.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/config/run_membership.h"
#include "common/dds/bus.h"
#include "common/nn/precision.h"
#include "common/wire/process_name.h"

namespace {

constexpr int kEpisodeSteps = 50;

class FakeEnvironment final : public shoal::worlds::Environment {
 public:
  FakeEnvironment(const shoal::ObservationSpec& spec, std::chrono::microseconds step)
      : spec_(spec), step_(step), random_(0) {}

  const shoal::ObservationSpec& spec() const override { return spec_; }

  float Reset(uint64_t stream_key, shoal::worlds::ObservationOut out) override {
    random_ = shoal::Random(stream_key);
    steps_ = 0;
    due_ = shoal::Now();
    Observe(out);
    return 1;
  }

  shoal::worlds::StepResult Step(std::span<const float>,
                                 shoal::worlds::ObservationOut out) override {
    due_ += step_;
    std::this_thread::sleep_until(due_);  // the span of a step is what is being simulated
    Observe(out);
    return {.reward = -1, .truncated = ++steps_ == kEpisodeSteps, .distance = 1};
  }

  double render_seconds() const override { return 0; }
  std::span<const shoal::worlds::DrawnMass> drawn_masses() const override { return {}; }

 private:
  void Observe(shoal::worlds::ObservationOut out) {
    std::ranges::fill(out.frame, static_cast<uint8_t>(random_.Next()));
    for (float& value : out.vector) value = static_cast<float>(random_.Uniform(-1, 1));
  }

  const shoal::ObservationSpec spec_;
  const std::chrono::microseconds step_;
  shoal::Random random_;
  shoal::SteadyTime due_{};
  int steps_ = 0;
};

int Run(int argc, char** argv) {
  std::string run;
  uint32_t id = 0;
  int step_microseconds = 10'000;
  CLI::App app("A training actor over environments that cost nothing but time.",
               "shoal-fake-actor");
  shoal::AddVersion(&app);
  app.add_option("--run", run, "run folder")->required();
  app.add_option("--id", id, "number of this actor within the run");
  app.add_option("--step-us", step_microseconds, "span of a step")->check(CLI::PositiveNumber);
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  shoal::nn::SetThreads(1);
  shoal::InstallStopSignals();
  shoal::log::Start(shoal::ProcessName::Actor(id).Text(), "");
  const auto make = [&](const shoal::RunConfig& config, int count) {
    std::vector<std::unique_ptr<shoal::worlds::Environment>> environments;
    environments.reserve(count);
    for (int i = 0; i < count; ++i) {
      environments.push_back(std::make_unique<FakeEnvironment>(
          config.spec, std::chrono::microseconds(step_microseconds)));
    }
    return environments;
  };
  const shoal::RunMembership member(run);
  const shoal::TransportConfig transport = shoal::ReadRunConfig(run).config.transport;
  shoal::dds::Bus bus(shoal::dds::FindEndpoint(run, transport, {}), shoal::dds::Role::kActor);
  return shoal::actor::TrainingActor(run, id, bus, make).Run();
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-fake-actor", [&] { return Run(argc, argv); });
}
