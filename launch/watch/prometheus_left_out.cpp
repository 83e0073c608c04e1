// SPDX-License-Identifier: Apache-2.0
// PrometheusEndpoint in a build with SHOAL_TOOLS=OFF: no address can be served.
#include "common/base/error.h"
#include "launch/watch/prometheus_endpoint.h"

namespace shoal::launch {

struct PrometheusEndpoint::Impl {};

PrometheusEndpoint::PrometheusEndpoint(const std::string& where) { Check(where); }
PrometheusEndpoint::~PrometheusEndpoint() = default;

void PrometheusEndpoint::Check(const std::string& where) {
  throw UsageError(
      "--prometheus {}: not part of this build; configure Shoal with -DSHOAL_TOOLS=ON to have it",
      where);
}
std::string PrometheusEndpoint::Url() const { return ""; }
void PrometheusEndpoint::Update(const RunViewMessage& /*view*/) {}

}  // namespace shoal::launch
