// SPDX-License-Identifier: Apache-2.0
#include "common/nn/module.h"

#include <algorithm>
#include <array>

#include "common/base/check.h"
#include "common/nn/adam.h"
#include "common/nn/op.h"
#include "common/nn/parallel.h"

namespace shoal::nn {

ModuleContext::ModuleContext(Precision compute_precision, int batch_size, int thread_count)
    : precision(compute_precision),
      batch(batch_size),
      threads(thread_count),
      scratchpad(std::make_shared<Scratchpad>()) {
  CHECK(batch > 0 && threads > 0) << "batch of " << batch << ", " << threads << " threads";
}

ModuleContext::ModuleContext(Precision compute_precision, int batch_size, Replica* of)
    : ModuleContext(compute_precision, of->RowsOf(batch_size).count, of->threads()) {
  replica = of;
}

Module::Module(const std::vector<ParameterSpec>& parameters, Use use, const ModuleContext& context)
    : parameters_(parameters, use, context.replica), context_(context) {}

void CopyParameters(const ParameterSet& online, ParameterSet* average) {
  CHECK(online.size() == average->size()) << online.size() << " and " << average->size();
  std::copy_n(online.values(), online.size(), average->values());
}

// Statistics belong to the first replica's share. With several replicas there are none.
void MoveTowards(float tau, const ParameterSet& online, ParameterSet* average,
                 const Replica& replica) {
  CHECK(online.size() == average->size()) << online.size() << " and " << average->size();
  const int64_t trained = online.trained_size();
  const Replica::Share share = replica.ShareOf(trained);
  MoveTowards(tau, online.values() + share.begin, share.end - share.begin,
              average->values() + share.begin);
  if (replica.rank() > 0) return;
  std::copy_n(online.values() + trained, online.size() - trained, average->values() + trained);
}

void CopyParameters(const Module& online, Module* target) {
  CopyParameters(online.parameters(), &target->parameters());
  target->Refresh();
}

void MoveTowards(float tau, std::span<const Following> targets, Replica* replica) {
  for (const Following& following : targets) {
    MoveTowards(tau, following.online->parameters(), &following.target->parameters(), *replica);
  }
  replica->Meet();
  for (const Following& following : targets) following.target->Refresh();
}

void MoveTowards(float tau, const Module& online, Module* target) {
  Replica alone;
  MoveTowards(tau, std::array{Following{&online, target}}, &alone);
}

}  // namespace shoal::nn
