// SPDX-License-Identifier: Apache-2.0
// The part of each module that computes, and the interface of its makers. A module
// (encoder_module.h, critic_module.h, actor_module.h, readout_module.h) owns its parameters and one
// of these networks. Without a maker in the ModuleContext, the network computes on the CPU.
//
// The functions of a network have the meaning of the module's functions of the same name. A network
// reads its parameters' values only after Refresh.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/array.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {

enum class Statistics;

// Result of an actor; all arrays are (B, A). mean: before tanh. log_std: empty for a deterministic
// actor. action: tanh(mean) of a deterministic actor, empty for a Gaussian actor.
struct ActorArrays {
  Array mean, log_std, action;
};

// Output of an encoder or a trunk, which heads or readouts read, in the memory of the engine. Every
// maker has its own class of features, which only its own networks read.
class Features {
 public:
  virtual ~Features() = default;

  virtual int columns() const = 0;  // numbers of a row
};

class EncoderNetwork {
 public:
  virtual ~EncoderNetwork() = default;

  virtual const Features& features() const = 0;
  virtual void Refresh() = 0;
  virtual void Forward(Frames frames, Statistics statistics) = 0;
  virtual void Backward() = 0;
};

class CriticNetwork {
 public:
  virtual ~CriticNetwork() = default;

  virtual int count() const = 0;
  virtual Array q(int i) const = 0;
  virtual const Features* trunk_features() const = 0;
  virtual void Refresh() = 0;
  virtual void ForwardObservation(Array vector) = 0;
  virtual void ForwardAction(Array action) = 0;
  virtual void Backward(std::span<const Array> q_gradients) = 0;
  virtual void BackwardAction(std::span<const Array> q_gradients, Array action_gradient) = 0;
};

class ActorNetwork {
 public:
  virtual ~ActorNetwork() = default;

  virtual const Features* trunk_features() const = 0;
  virtual void Refresh() = 0;
  virtual ActorArrays Forward(Array vector) = 0;
  virtual void Backward(Array mean_gradient, Array log_std_gradient) = 0;
  virtual void BackwardAction(Array action_gradient, double mean_penalty) = 0;
};

class ReadoutNetwork {
 public:
  virtual ~ReadoutNetwork() = default;

  virtual void Refresh() = 0;
  virtual Array Forward() = 0;
  virtual void Backward(Array gradient) = 0;
};

// Makes the networks of an engine that does not compute on the CPU. Arguments have the meaning of
// those of the modules' constructors. `parameters` is borrowed and outlives the network.
class NetworkMaker {
 public:
  virtual ~NetworkMaker() = default;

  virtual std::unique_ptr<EncoderNetwork> MakeEncoder(const NetworkPlan& plan,
                                                      ParameterSet::Use use,
                                                      ParameterSet* parameters) = 0;
  virtual std::unique_ptr<CriticNetwork> MakeCritic(const HeadPlan& plan, const Features* features,
                                                    bool trains_encoder, ParameterSet::Use use,
                                                    ParameterSet* parameters) = 0;
  virtual std::unique_ptr<ActorNetwork> MakeActor(const ActorPlan& plan, const Features* features,
                                                  bool trains_encoder, ParameterSet::Use use,
                                                  ParameterSet* parameters) = 0;
  virtual std::unique_ptr<ReadoutNetwork> MakeReadout(const std::string& name,
                                                      const Features& trunk,
                                                      ParameterSet* parameters) = 0;
};

}  // namespace shoal::nn
