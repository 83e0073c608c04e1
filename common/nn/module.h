// SPDX-License-Identifier: Apache-2.0
// Modules: networks with parameters of their own, behind plain float arrays. The interface hides
// the library that computes the networks. Each algorithm (learner/agent) chooses its modules,
// targets and optimisers.
//
// Dimensions: B batch, A actions, V vector size. Arrays are row-major f32; a result is valid until
// the function that returned it is called again.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/nn/network_plan.h"
#include "common/nn/parameter_set.h"
#include "common/nn/precision.h"
#include "common/nn/replica.h"

namespace shoal::nn {

class Scratchpad;

// Statistics of batch normalisation. kBatch: statistics of the current batch, for a pass that a
// backward pass follows. kRunning: averages over earlier batches, for acting and for targets.
enum class Statistics { kBatch, kRunning };

// Context with which the modules of one computation are built. Copies share the scratch memory, so
// their modules run one after another, on one thread at a time.
struct ModuleContext {
  ModuleContext(Precision precision, int batch, int threads);
  // Context of one replica, with its share of a batch of `batch` rows and its number of threads.
  // Borrows the replica.
  ModuleContext(Precision precision, int batch, Replica* replica);

  Precision precision;
  int batch;    // B, or the rows of the replica
  int threads;  // threads of each pass of a module
  Replica* replica = nullptr;
  std::shared_ptr<Scratchpad> scratchpad;
};

// kTraining: has gradients and can be stepped by an optimiser; kInference: a target, or a policy.
class Module {
 public:
  using Use = ParameterSet::Use;

  Module(const std::vector<ParameterSpec>& parameters, Use use, const ModuleContext& context);
  virtual ~Module() = default;

  // Owned by the module. Refresh() follows any change of values.
  ParameterSet& parameters() { return parameters_; }
  const ParameterSet& parameters() const { return parameters_; }
  // Copies the parameters' current values into the layers. With replicas, all refresh and then meet
  // (LaidOutWeight::Refresh).
  virtual void Refresh() = 0;

 protected:
  ParameterSet parameters_;
  const ModuleContext context_;
};

// Copies the parameters and statistics of `online` to `target`, a network of the same plan under
// another name, and refreshes the target.
void CopyParameters(const Module& online, Module* target);

// A target network and the online module that it follows.
struct Following {
  const Module* online;
  Module* target;
};
// Computes target += tau * (online - target) for the parameters of each target (Eq. 9 of
// docs/algorithm.md), copies statistics whole, and refreshes the targets. Replicas divide the work.
// They meet inside this function, and must meet again before one of them uses the targets.
void MoveTowards(float tau, std::span<const Following> targets, Replica* replica);

// The same for one target without replicas.
void MoveTowards(float tau, const Module& online, Module* target);

// The same for a plain parameter set: a moving average that belongs to no module.
void CopyParameters(const ParameterSet& online, ParameterSet* average);
// Moves only this replica's share of the average; other replicas may move theirs at the same time.
void MoveTowards(float tau, const ParameterSet& online, ParameterSet* average,
                 const Replica& replica);

}  // namespace shoal::nn
