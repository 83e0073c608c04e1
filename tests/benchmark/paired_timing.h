// SPDX-License-Identifier: Apache-2.0
// Times two implementations in turn, A B A B …, so that a machine whose speed drifts does not
// favour one of them.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace shoal::bench {

// One row of schema shoal-bench-1. Figures are rates (per second), medians of the repetitions;
// ratio = median over the pairs of figure / against_figure; spread = (largest - smallest ratio) /
// ratio.
struct Row {
  std::string stage, unit, against;
  double figure = 0, against_figure = 0, ratio = 0, spread = 0;
  double target = 0;  // the ratio should be at least this; 0 = no target
  int repetitions = 0;
};

struct Pairing {
  std::string stage, unit, against;
  double units_per_call = 1;
  double target = 0;
  std::function<void()> ours, other;
  // Returns the units per call, if this number is known only after a call. Called after the first
  // call of `ours`.
  std::function<double()> units{};
  // A fixed limit in place of `other`, in units per second.
  double other_rate = 0;
  // Starts background work, which ends when the result is destroyed; empty = no background work.
  std::function<std::shared_ptr<void>()> meanwhile{};
  // The reason why this machine cannot measure the row (not an error); empty if it can.
  std::string skipped{};
};

// Each side runs for about `seconds` per repetition. The first call of each side is a warm-up and
// is not counted.
Row TimePair(const Pairing& pairing, int repetitions, double seconds);

// If the number of values is even, returns the mean of the two middle values. Needs at least one
// value.
double Median(std::vector<double> values);

nlohmann::ordered_json ToJson(const Row& row);
// One line of text: figure, ratio, spread and, if the row has a target, whether it is met.
std::string LineOf(const Row& row);

// The measured pairs, one function per group of measurements.
std::vector<Pairing> ReplayPairings();
std::vector<Pairing> GatherPairings();
std::vector<Pairing> NetworkPairings();
std::vector<Pairing> UpdatePairings();
std::vector<Pairing> LearnerPairings();
std::vector<Pairing> PolicyPairings();
std::vector<Pairing> ScalingPairings();
std::vector<Pairing> TransportPairings();
std::vector<Pairing> WorldPairings();
std::vector<Pairing> FramePairings();

}  // namespace shoal::bench
