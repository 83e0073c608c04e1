// SPDX-License-Identifier: Apache-2.0
// Modules: networks with parameters of their own, behind plain float arrays. What computes them is
// out of sight; which modules, targets and optimisers make an algorithm is said where the algorithm
// is (learner/agent).
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

// Statistics of batch normalisation: kBatch, those of the present batch, in a pass that a backward
// pass follows; kRunning, averages over former batches, in acting and in targets.
enum class Statistics { kBatch, kRunning };

// Context that modules of one computation are built with. Copies share the scratch memory, so their
// modules run one after another, on one thread at a time.
struct ModuleContext {
  ModuleContext(Precision precision, int batch, int threads);
  // Context of one replica: its rows of a batch of `batch` rows, its threads. Borrows the replica.
  ModuleContext(Precision precision, int batch, Replica* replica);

  Precision precision;
  int batch;    // B, or the rows of the replica
  int threads;  // that each pass of a module uses
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
  // Takes over the parameters' present values. Of replicas, all refresh and then meet
  // (LaidOutWeight::Refresh).
  virtual void Refresh() = 0;

 protected:
  ParameterSet parameters_;
  const ModuleContext context_;
};

// Parameters of `target`, a network of the same plan under another name, become those of `online`;
// statistics as well. The target is refreshed.
void CopyParameters(const Module& online, Module* target);

// A target and the module that it follows.
struct Following {
  const Module* online;
  Module* target;
};
// Each target's parameters move by the share `tau` of the way towards those of its online module
// (Eq. 9 of docs/algorithm.md); statistics are copied whole. The targets are refreshed. Replicas
// divide the work; they meet in between, and have to meet before anyone uses the targets.
void MoveTowards(float tau, std::span<const Following> targets, Replica* replica);

// The same for one target without replicas.
void MoveTowards(float tau, const Module& online, Module* target);

// The same for a plain set: a moving average that no module computes.
void CopyParameters(const ParameterSet& online, ParameterSet* average);
// This replica's share of it; another one may move its own meanwhile.
void MoveTowards(float tau, const ParameterSet& online, ParameterSet* average,
                 const Replica& replica);

}  // namespace shoal::nn
