// The one list of algorithms: what learner.algorithm chooses from.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

struct Algorithm {
  std::string_view name;  // of learner.algorithm
  // What its updates report, in this order; each in at least every update that computes it.
  std::span<const Figure* const> figures;
  // Initialises the networks from config.seed. Throws Error where the configuration does not fit.
  std::unique_ptr<Agent> (*make)(const Config& config, const ObservationSpec& spec,
                                 nn::Precision precision);
};

std::span<const Algorithm> Algorithms();

// The agent of config.learner.algorithm. Throws Error (kUsage) naming the algorithms there are when
// there is none of that name.
std::unique_ptr<Agent> MakeAgent(const Config& config, const ObservationSpec& spec,
                                 nn::Precision precision);

// Every figure that the updates of a run may have, by algorithm, each name once.
std::span<const Figure* const> AllFigures();
// The figure of that name; nullptr: no update reports one.
const Figure* FindFigure(std::string_view name);

}  // namespace shoal::learner
