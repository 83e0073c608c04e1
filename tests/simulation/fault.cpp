// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/fault.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "common/base/random.h"

namespace shoal::simulation {
namespace {

using std::chrono::milliseconds;
using Kind = Fault::Kind;

constexpr int kMostFaults = 6;
constexpr int kWindow = 25'000;                   // ms in which they begin
constexpr int kAtOnce = 1000;                     // most ms between two simultaneous faults
constexpr uint64_t kBusyUsers = 5;                // one seed in so many has further commands
constexpr uint64_t kMostCommands = 3;             // further commands
constexpr uint64_t kLongest = 9, kFarthest = 20;  // doublings: 51 s, 29 hours

struct Weight {
  Kind kind;
  uint64_t share;
};
constexpr Weight kWeights[] = {
    {Kind::kKill, 20},     {Kind::kPause, 12},   {Kind::kStall, 6},       {Kind::kSlow, 4},
    {Kind::kPartition, 4}, {Kind::kFullDisk, 3}, {Kind::kFailingDisk, 3}, {Kind::kClock, 4},
    {Kind::kCommand, 8},   {Kind::kAttach, 2},   {Kind::kSecond, 3},      {Kind::kInterrupt, 2}};

Kind DrawKind(Random& random) {
  uint64_t sum = 0;
  for (const Weight& weight : kWeights) sum += weight.share;
  uint64_t at = random.Below(sum);
  for (const Weight& weight : kWeights) {
    if (at < weight.share) return weight.kind;
    at -= weight.share;
  }
  return Kind::kKill;
}

template <size_t n>
std::string OneOf(const std::array<const char*, n>& texts, Random& random) {
  return texts[random.Below(n)];
}

// From 100 ms to that times 2^doublings, short ones as often as long ones. In whole numbers, which
// are the same on every machine.
milliseconds DrawSpan(uint64_t doublings, Random& random) {
  const uint64_t low = uint64_t{100} << random.Below(doublings);
  return milliseconds(low + random.Below(low));
}

std::string DrawCommand(Random& random) {
  static constexpr std::array kCommands{"stop",
                                        "scale 1",
                                        "scale 2",
                                        "scale 3",
                                        "set env_steps=300",
                                        "set env_steps=500",
                                        "set eval.interval=50",
                                        "set replay.samples_per_insert=2",
                                        "set replay.samples_per_insert=8",
                                        "set learner.weights_period=5",
                                        "set stop.evaluations=3",
                                        "set seed=1"};
  return OneOf(kCommands, random);
}

std::string DrawWhatFollows(Random& random) {
  static constexpr std::array kFollow{kThenResume,    kThenResume,   kThenResume,
                                      kThenOverwrite, kThenLoseRing, kThenCutRing};
  return OneOf(kFollow, random);
}

std::string DrawProcess(const Config& config, Random& random) {
  std::vector<std::string> names{"learner-0", "eval-0", "coordinator"};
  if (config.learner.algorithm != "ppo") names.push_back("replay-0");
  for (int i = 0; i < config.actors; ++i) names.push_back(fmt::format("actor-{}", i));
  return names[random.Below(names.size())];
}

bool StrikesAProcess(Kind kind) {
  return kind == Kind::kKill || kind == Kind::kPause || kind == Kind::kStall ||
         kind == Kind::kSlow || kind == Kind::kPartition || kind == Kind::kFailingDisk;
}

Fault DrawFault(const Config& config, Random& random) {
  Fault fault{.kind = DrawKind(random)};
  fault.at = milliseconds(random.Below(kWindow));
  fault.span = DrawSpan(kLongest, random);
  fault.number = random.Next();
  if (StrikesAProcess(fault.kind)) fault.process = DrawProcess(config, random);
  switch (fault.kind) {
    case Kind::kKill:
      if (fault.process == "coordinator") fault.text = DrawWhatFollows(random);
      break;
    case Kind::kPartition:  // a shorter one only delays: that is a stall
      fault.span = std::max(fault.span, milliseconds(6000));
      break;
    case Kind::kClock:
      fault.span = DrawSpan(kFarthest, random) * (random.Below(2) == 0 ? 1 : -1);
      break;
    case Kind::kCommand:
      fault.text = DrawCommand(random);
      break;
    default:
      break;
  }
  return fault;
}

// Commands within a second of other faults, before or after them.
void AddCommands(uint64_t seed, std::vector<Fault>* faults) {
  Random random(HashWords({seed, 3}));
  const size_t others = faults->size();
  for (uint64_t left = 1 + random.Below(kMostCommands); left > 0; --left) {
    Fault fault{.kind = Kind::kCommand, .text = DrawCommand(random)};
    fault.at = milliseconds(random.Below(kWindow));
    if (others > 0) {
      fault.at = (*faults)[random.Below(others)].at + milliseconds(random.Below(2 * kAtOnce)) -
                 milliseconds(kAtOnce);
    }
    fault.at = std::max(fault.at, milliseconds(0));
    faults->push_back(std::move(fault));
  }
}

double Seconds(milliseconds span) { return static_cast<double>(span.count()) / 1000; }

std::string What(const Fault& fault) {
  const double span = Seconds(fault.span);
  switch (fault.kind) {
    case Kind::kKill:
      if (fault.text.empty()) return fmt::format("kill {}", fault.process);
      return fmt::format("kill {}, {} after {:.3f} s", fault.process, fault.text, span);
    case Kind::kPause:
      return fmt::format("pause {} for {:.3f} s", fault.process, span);
    case Kind::kStall:
      return fmt::format("stall a thread of {} for {:.3f} s", fault.process, span);
    case Kind::kSlow:
      return fmt::format("slow {} down for {:.3f} s", fault.process, span);
    case Kind::kPartition:
      return fmt::format("cut {} off for {:.3f} s", fault.process, span);
    case Kind::kFullDisk:
      return fmt::format("the disk is full for {:.3f} s", span);
    case Kind::kFailingDisk:
      return fmt::format("writes of {} fail for {:.3f} s", fault.process, span);
    case Kind::kClock:
      return fmt::format("the wall clock jumps by {:.3f} s", span);
    case Kind::kCommand:
      return fmt::format("shoal {}", fault.text);
    case Kind::kAttach:
      return fmt::format("shoal attach for {:.3f} s", span);
    case Kind::kSecond:
      return "a second coordinator asks for the run";
    case Kind::kInterrupt:
      return "Ctrl-C";
  }
  return "?";
}

}  // namespace

std::string Fault::Text() const { return fmt::format("{:.3f} s: {}", Seconds(at), What(*this)); }

std::vector<Fault> DrawFaults(uint64_t seed, const Config& config) {
  Random random(HashWords({seed, 1}));
  std::vector<Fault> faults;
  const size_t count = random.Below(kMostFaults + 1);
  for (size_t i = 0; i < count; ++i) {
    Fault fault = DrawFault(config, random);
    // One in three directly follows another: a run may survive each fault but not both.
    if (i > 0 && random.Below(3) == 0) {
      fault.at = faults[random.Below(i)].at + milliseconds(random.Below(kAtOnce));
    }
    faults.push_back(std::move(fault));
  }
  if (seed % kBusyUsers == 1) AddCommands(seed, &faults);
  std::ranges::sort(faults, {}, &Fault::at);
  return faults;
}

}  // namespace shoal::simulation
