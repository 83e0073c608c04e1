// SPDX-License-Identifier: Apache-2.0
// SAC with DrQ: networks, targets, optimisers and one update. Equations are numbered in
// docs/algorithm.md.
#pragma once

#include <memory>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/agent/critic_rows.h"
#include "learner/agent/sample_figures.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

inline constexpr Figure kTemperatureLoss{
    "temperature_loss", "", "temperature times the excess of the entropy over its target", false,
    "ent_coef_loss"};

inline constexpr Figure kAuxError{
    "aux_error", "m", "root mean square error of the predicted sac.aux labels", false, ""};

// Metrics of an update, in the order of its report. The temperature is the value after the update;
// the learning rate is the value that the update used. The metrics of the actor, and the metrics
// after them, exist only if the update trains the actor. kAuxError exists only if the update trains
// the encoder and sac.aux is set, kImportanceWeight only if there are such weights.
inline constexpr const Figure* kSacFigures[] = {
    &kCriticLoss,      &kQMean,    &kTargetMean,       &kCriticGradNorm, &kActorLoss,
    &kTemperatureLoss, &kEntropy,  &kActionSaturation, &kActorGradNorm,  &kTemperature,
    &kLearningRate,    &kAuxError, &kQ1Mean,           &kQ1Std,          &kQ2Mean,
    &kQ2Std,           &kQMinMean, &kQMinStd,          &kQMinMin,        &kQMinMax,
    &kImportanceWeight};

// See Algorithm::make.
std::unique_ptr<Agent> MakeSacAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine);

}  // namespace shoal::learner
