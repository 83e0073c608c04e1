// SPDX-License-Identifier: Apache-2.0
#include "common/policy/checkpoint_writer.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/policy/policy_description.h"

namespace shoal::policy {
namespace {

nlohmann::ordered_json KeysOf(const NetworkConfig& network) {
  Config config;
  config.network = network;
  return ToJson(config).at("network");
}

// None if the text is not a description that this version reads.
std::optional<NetworkConfig> NetworkOf(const std::string& description) {
  try {
    return ReadDescription(description, kDescriptionFile).network;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

std::string NetworkDifference(const NetworkConfig& there, const NetworkConfig& here) {
  const nlohmann::ordered_json theirs = KeysOf(there), ours = KeysOf(here);
  std::string text;
  for (const auto& [key, value] : theirs.items()) {
    if (key == "encoder_weights" || value == ours.at(key)) continue;
    text += fmt::format("{}network.{} = {} there, {} here", text.empty() ? "" : "; ", key,
                        value.dump(), ours.at(key).dump());
  }
  return text;
}

std::string DifferenceFromWriter(const std::filesystem::path& weights, const NetworkConfig& here) {
  const std::filesystem::path file = weights.parent_path() / kDescriptionFile;
  if (!std::filesystem::exists(file)) return "";
  const auto there = NetworkOf(ReadFile(file));
  return there ? NetworkDifference(*there, here) : "";
}

void CheckWriter(const std::filesystem::path& folder, const CheckpointState& state,
                 const std::string& description, const Config& config) {
  if (state.algorithm != config.learner.algorithm) {
    throw UsageError(
        "'{}' was written by learner.algorithm = \"{}\", the run is configured with \"{}\": "
        "expected the same, or a new run",
        folder.string(), state.algorithm, config.learner.algorithm);
  }
  const auto network = description.empty() ? std::nullopt : NetworkOf(description);
  const std::string difference = network ? NetworkDifference(*network, config.network) : "";
  if (difference.empty()) return;
  throw UsageError("'{}' is of another network than the run's: {}; expected the same, or a new run",
                   folder.string(), difference);
}

}  // namespace shoal::policy
