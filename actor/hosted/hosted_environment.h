// SPDX-License-Identifier: Apache-2.0
// Makes an Environment of a user's environment: maps actions from [-1, 1] to its bounds
// (action_mapping.h), images to frames, other arrays to blocks (observation_mapping.h), and refuses
// numbers that are not finite.
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
  // `raw` observes what `description` says. Throws Error (kUsage): hosted_spec.h.
  HostedEnvironment(tasks::EnvironmentDescription description, const Config& config,
                    std::unique_ptr<RawEnvironment> raw);

  const ObservationSpec& spec() const override { return spec_; }
  // A number of an observation or a reward that is not finite is an EpisodeFault. Numbers outside
  // of their declared bounds pass, with a warning for the first of each array.
  float Reset(uint64_t stream_key, worlds::ObservationOut out) override;
  worlds::StepResult Step(std::span<const float> action, worlds::ObservationOut out) override;
  // The user's code draws what it observes within its step.
  double render_seconds() const override { return 0; }
  // Reset and step of the user's code.
  std::optional<double> user_seconds() const override {
    return call_seconds_ - raw_->binding_seconds();
  }
  std::span<const worlds::DrawnMass> drawn_masses() const override { return {}; }

  RawEnvironment& raw() { return *raw_; }

 private:
  void Observe(worlds::ObservationOut out);
  // A control step of `action_`.
  RawStep TimedStep();
  // NaN without goals.
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
  double call_seconds_ = 0;     // in Reset and Step of `raw_`
  int64_t steps_ = 0;           // control steps since the reset
};

}  // namespace shoal::hosted
