// SPDX-License-Identifier: Apache-2.0
#include "common/policy/policy_description.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <vector>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/one_line.h"
#include "common/config/config_io.h"
#include "common/nn/plan_text.h"

namespace shoal::policy {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr char kSchema[] = "shoal-policy-1";

std::string HexHash(uint64_t hash) { return fmt::format("{:016x}", hash); }

// The keys network.*, without the file that training started from.
ordered_json NetworkKeys(const NetworkConfig& network) {
  Config config;
  config.network = network;
  config.network.encoder_weights.clear();
  return ToJson(config).at("network");
}

NetworkConfig NetworkFrom(const json& keys, const std::string& source) {
  Config config;
  ApplyJson({{"network", keys}}, source, &config);
  return config.network;
}

nn::ActorOutput OutputFrom(const std::string& word) {
  for (const auto output : {nn::ActorOutput::kGaussian, nn::ActorOutput::kDeterministic,
                            nn::ActorOutput::kUnsquashed}) {
    if (word == nn::ToString(output)) return output;
  }
  throw RuntimeError("output = '{}', expected gaussian, deterministic or unsquashed",
                     Shortened(word, 40));
}

// Limits far above those of any task, so that sizes computed from the spec stay reasonable.
constexpr int kMostPixels = 1024, kMostChannels = 256, kMostStack = 256;
constexpr int kMostNumbers = 1 << 20;

void CheckRange(const char* name, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw RuntimeError("spec.{} = {}, expected {} to {}", name, value, low, high);
}

void CheckSpec(const ObservationSpec& spec) {
  const int least = spec.HasPixels() ? 1 : 0;
  CheckRange("channels", spec.channels, 0, kMostChannels);
  CheckRange("height", spec.height, least, kMostPixels);
  CheckRange("width", spec.width, least, kMostPixels);
  CheckRange("stack", spec.stack, 1, kMostStack);
  CheckRange("action_size", spec.action_size, 1, kMostNumbers);
  std::set<std::string> names;
  int64_t numbers = 0;
  for (const BlockSpec& block : spec.blocks) {
    CheckRange(("blocks." + Shortened(block.name, 40)).c_str(), block.size, 1, kMostNumbers);
    numbers += block.size;
    if (!names.insert(block.name).second) {
      throw RuntimeError("spec.blocks has '{}' twice", Shortened(block.name, 40));
    }
  }
  if (numbers > kMostNumbers) {
    throw RuntimeError("spec.blocks hold {} numbers, expected at most {}", numbers, kMostNumbers);
  }
  if (!spec.HasPixels() && spec.VectorSize() == 0) {
    throw RuntimeError("spec has neither pixels nor an observed block");
  }
}

void CheckSchema(const json& object) {
  const auto schema = object.find("schema");
  if (schema == object.end() || !schema->is_string()) {
    throw RuntimeError("key 'schema' is missing, expected \"{}\"", kSchema);
  }
  if (*schema == kSchema) return;
  const bool newer = schema->get_ref<const std::string&>().starts_with("shoal-policy-");
  throw RuntimeError("schema {}, this is Shoal {}, which reads \"{}\"{}",
                     Shortened(schema->dump(), 60), BuildVersion(), kSchema,
                     newer ? ": use the version that wrote it, or a newer one" : "");
}

void CheckLayers(const PolicyDescription& description, const std::vector<std::string>& stored) {
  const std::vector<std::string> here = nn::PlanLines(description.Encoder(), description.Actor());
  const auto [theirs, ours] = std::ranges::mismatch(stored, here);
  if (theirs == stored.end() && ours == here.end()) return;
  const auto line = [](auto at, const std::vector<std::string>& lines) {
    return at == lines.end() ? std::string("nothing") : "'" + Shortened(*at, 200) + "'";
  };
  throw RuntimeError("layers: it was trained with {}, this program computes {}",
                     line(theirs, stored), line(ours, here));
}

PolicyDescription FromJson(const json& object) {
  CheckSchema(object);
  PolicyDescription description;
  object.at("version").get_to(description.version);
  object.at("algorithm").get_to(description.algorithm);
  description.output = OutputFrom(object.at("output").get<std::string>());
  description.spec = ObservationSpecFromJson(object.at("spec"));
  CheckSpec(description.spec);
  if (object.at("spec_hash") != HexHash(description.spec.Hash())) {
    throw RuntimeError("spec_hash is {}, but the spec has {}", object.at("spec_hash").dump(),
                       HexHash(description.spec.Hash()));
  }
  try {
    description.network = NetworkFrom(object.at("network"), "network");
    CheckLayers(description, object.at("layers").get<std::vector<std::string>>());
  } catch (const Error& e) {
    throw RuntimeError("{} (written by Shoal {}, this is {}: use the version that wrote it)",
                       e.what(), Shortened(description.version, 40), BuildVersion());
  }
  return description;
}

}  // namespace

PolicyDescription Describe(const Config& config, const ObservationSpec& spec,
                           nn::ActorOutput output) {
  return {.version = BuildVersion(),
          .algorithm = config.learner.algorithm,
          .output = output,
          .network = config.network,
          .spec = spec};
}

std::string WriteDescription(const PolicyDescription& description) {
  const ordered_json object{{"schema", kSchema},
                            {"version", description.version},
                            {"algorithm", description.algorithm},
                            {"output", nn::ToString(description.output)},
                            {"network", NetworkKeys(description.network)},
                            {"spec", ToJson(description.spec)},
                            {"spec_hash", HexHash(description.spec.Hash())},
                            {"layers", nn::PlanLines(description.Encoder(), description.Actor())}};
  return object.dump(2) + "\n";
}

PolicyDescription ReadDescription(const std::string& text, const std::string& source) {
  const json object = ParseStrictJson(text, source);
  if (!object.is_object()) throw RuntimeError("'{}': expected one JSON object", source);
  try {
    return FromJson(object);
  } catch (const json::exception& e) {
    throw RuntimeError("'{}': {}", source, e.what());
  } catch (const Error& e) {
    throw RuntimeError("'{}': {}", source, e.what());
  }
}

}  // namespace shoal::policy
