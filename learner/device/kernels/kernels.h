// SPDX-License-Identifier: Apache-2.0
// All kernels, and a type that holds the arguments of any of them.
#pragma once

#include <type_traits>
#include <variant>

#include "learner/device/kernels/batch_norm.h"
#include "learner/device/kernels/clipped_policy.h"
#include "learner/device/kernels/critic_loss.h"
#include "learner/device/kernels/flags.h"
#include "learner/device/kernels/gaussian.h"
#include "learner/device/kernels/inputs.h"
#include "learner/device/kernels/layer_norm.h"
#include "learner/device/kernels/layers.h"
#include "learner/device/kernels/losses.h"
#include "learner/device/kernels/moments.h"
#include "learner/device/kernels/optimiser.h"
#include "learner/device/kernels/parameter_sets.h"
#include "learner/device/kernels/policy_heads.h"
#include "learner/device/kernels/pooling.h"
#include "learner/device/kernels/spatial_softmax.h"
#include "learner/device/kernels/temperature.h"

namespace shoal::learner::kernels {

// A launch of one kernel: its arguments. The members' meanings are in the kernels' headers.
using Kernel =
    std::variant<PoolFrames, CopyColumns, SumColumns, GatherLabels, Standardise, AddToMoments,
                 GaussianHead, GaussianHeadBackward, TanhHead, TanhHeadBackward,
                 SampleSquashedGaussian, SquashedGaussianBackward, SquashedGaussianFigures,
                 AddClippedNoise, Targets, AverageCopies, CriticLoss, EntropyActorLoss,
                 DeterministicActorLoss, LabelLoss, PrepareClippedPolicy, ClippedPolicyRows,
                 LogStdGradient, GaussianFigures, Mean, BiasActivation, LayerNormForward,
                 LayerNormBackward, LayerNormBackwardWeights, ReluBackward, ActivationBackward,
                 SpatialSoftmaxForward, SpatialSoftmaxBackward, MaxPoolForward, MaxPoolBackward,
                 AveragePoolForward, AveragePoolBackward, ChannelMeans, ChannelVariances,
                 BatchNormForward, BatchNormWeights, BatchNormBackward, AddMap, BeginUpdate,
                 RequireFinite, HoldSteps, SumOfSquares, Adam, EndUpdate, MoveTowards, RoundToBf16,
                 Temperature, TemperatureLoss, StepTemperature>;
static_assert(std::is_trivially_copyable_v<Kernel>, "a launch copies its arguments");

// The arguments of a card's kernel are at most 4 KiB.
static_assert(sizeof(Kernel) <= 4096);

}  // namespace shoal::learner::kernels
