// SAC with DrQ: networks, targets, optimisers and one update. Equations are numbered in
// docs/algorithm.md.
#pragma once

#include <memory>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

inline constexpr Figure kTemperatureLoss{
    "temperature_loss", "", "temperature times entropy above the target", false, "ent_coef_loss"};

// In the order of an update. Temperature: after it; the actor's and those after it only where the
// update moves the actor.
inline constexpr const Figure* kSacFigures[] = {
    &kCriticLoss,      &kQMean,   &kTargetMean,       &kCriticGradNorm, &kActorLoss,
    &kTemperatureLoss, &kEntropy, &kActionSaturation, &kActorGradNorm,  &kTemperature};

// As MakeAgent.
std::unique_ptr<Agent> MakeSacAgent(const Config& config, const ObservationSpec& spec,
                                    nn::Precision precision);

}  // namespace shoal::learner
