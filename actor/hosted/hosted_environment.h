// SPDX-License-Identifier: Apache-2.0
// Adapter from a user's environment to Environment. Maps actions from [-1, 1] to the environment's
// bounds (action_mapping.h), images to frames and other arrays to blocks (observation_mapping.h).
// Reports numbers that are not finite.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "actor/hosted/observation_mapping.h"
#include "actor/hosted/raw_environment.h"
#include "actor/worlds/environment.h"
#include "common/config/config.h"
#include "common/tasks/environment_description.h"

namespace shoal::hosted {

class HostedEnvironment final : public worlds::Environment {
 public:
  // `raw` has the spaces of `description`. Throws the errors (kUsage) of SpecOf (hosted_spec.h).
  HostedEnvironment(tasks::EnvironmentDescription description, const Config& config,
                    std::unique_ptr<RawEnvironment> raw);

  const ObservationSpec& spec() const override { return spec_; }
  // Reset and Step throw EpisodeFault if a number of an observation or a reward is not finite.
  // Numbers outside their declared bounds are accepted; the first such number of each array is
  // logged as a warning.
  float Reset(uint64_t stream_key, worlds::ObservationOut out) override;
  worlds::StepResult Step(std::span<const float> action, worlds::ObservationOut out) override;
  // 0: the user's code renders its images within its step.
  double render_seconds() const override { return 0; }
  // Seconds spent in reset and step of the user's code.
  std::optional<double> user_seconds() const override {
    return call_seconds_ - raw_->binding_seconds();
  }
  std::span<const worlds::DrawnMass> drawn_masses() const override { return {}; }

  RawEnvironment& raw() { return *raw_; }

 private:
  void Observe(worlds::ObservationOut out);
  // Makes a control step with `action_`.
  RawStep TimedStep();
  // Distance of the achieved to the desired goal; NaN for environments without goals.
  double Distance() const;

  const tasks::EnvironmentDescription description_;
  const tasks::Task task_;
  const int action_repeat_;
  const bool end_on_success_;
  const std::unique_ptr<RawEnvironment> raw_;
  const ObservationSpec spec_;
  ObservationMapping mapping_;
  std::vector<float> vector_;   // (R), of the newest observation
  std::vector<double> action_;  // (A), in the environment's units
  double call_seconds_ = 0;     // spent in Reset and Step of `raw_`
  int64_t steps_ = 0;           // control steps since the reset
};

}  // namespace shoal::hosted
