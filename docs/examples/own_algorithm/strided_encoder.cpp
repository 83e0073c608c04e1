#include "strided_encoder.h"

namespace shoal::nn {

void AddStrided(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan) {
  plan->AddPixels(/*pool=*/1, "network.encoder");
  for (int i = 0; i < 3; ++i) {
    plan->Add(NetworkPlan::Convolution{.name = prefix + ".conv" + std::to_string(i),
                                       .key = "network.encoder",
                                       .filters = 32,
                                       .kernel = 5,
                                       .stride = 2,
                                       .padding = 2,
                                       .initialisation = InitialisationOf(network)});
  }
}

}  // namespace shoal::nn
