// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/rollout_state.h"

#include <bit>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "common/base/bounded_json.h"
#include "common/base/crc32.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/process_name.h"

namespace shoal::actor {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

fs::path FileOf(const fs::path& run, uint32_t actor) {
  return run / kMadeFolder / (ProcessName::Actor(actor).Text() + ".rollout");
}

uint32_t Crc(const std::string& text) {
  return Crc32({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

// Floats are written as their bits, because a decimal number in JSON need not be read back exactly.
ordered_json ToJson(const EpisodeState& state) {
  ordered_json actions = ordered_json::array();
  for (const float action : state.actions) actions.push_back(std::bit_cast<uint32_t>(action));
  ordered_json carried = ordered_json::array();
  for (const double noise : state.noise.carried) carried.push_back(std::bit_cast<uint64_t>(noise));
  ordered_json json{{"episode", state.episode},      {"running", state.running},
                    {"cut_after", state.cut_after},  {"noise", state.noise.stream},
                    {"carried_noise_bits", carried}, {"action_bits", actions}};
  if (state.owes) json["owes"] = true;
  return json;
}

EpisodeState EpisodeFromJson(const ordered_json& json) {
  EpisodeState state;
  json.at("episode").get_to(state.episode);
  json.at("running").get_to(state.running);
  json.at("cut_after").get_to(state.cut_after);
  state.owes = json.value("owes", false);
  json.at("noise").get_to(state.noise.stream);
  for (const ordered_json& bits : json.at("carried_noise_bits")) {
    state.noise.carried.push_back(std::bit_cast<double>(bits.get<uint64_t>()));
  }
  for (const ordered_json& bits : json.at("action_bits")) {
    state.actions.push_back(std::bit_cast<float>(bits.get<uint32_t>()));
  }
  return state;
}

RolloutState Parse(const std::string& text, const std::string& source) {
  ordered_json json = ParseBoundedJson<ordered_json>(text);
  try {
    if (!json.is_object() || json.at("schema") != kRolloutSchema) {
      throw RuntimeError("'{}': expected an object of schema '{}'", source, kRolloutSchema);
    }
    const auto crc = json.at("crc32").get<uint32_t>();
    json.erase("crc32");
    if (Crc(json.dump()) != crc) throw RuntimeError("'{}': the file was altered", source);
    RolloutState state;
    json.at("session").get_to(state.session);
    json.at("made").get_to(state.made);
    json.at("env_steps").get_to(state.env_steps);
    for (const ordered_json& episode : json.at("episodes")) {
      state.episodes.push_back(EpisodeFromJson(episode));
    }
    return state;
  } catch (const ordered_json::exception& e) {
    throw RuntimeError("'{}': {}", source, e.what());
  }
}

}  // namespace

void WriteRolloutState(const fs::path& run, uint32_t actor, const RolloutState& state) {
  ordered_json episodes = ordered_json::array();
  for (const EpisodeState& episode : state.episodes) episodes.push_back(ToJson(episode));
  ordered_json json{{"schema", kRolloutSchema},
                    {"session", state.session},
                    {"made", state.made},
                    {"env_steps", state.env_steps},
                    {"episodes", episodes}};
  json["crc32"] = Crc(json.dump());
  WriteFileAtomically(FileOf(run, actor), json.dump() + "\n");
}

std::optional<RolloutState> ReadRolloutState(const fs::path& run, uint32_t actor) {
  const fs::path file = FileOf(run, actor);
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  try {
    return Parse(ReadFile(file), file.string());
  } catch (const Error& e) {
    throw UsageError("{}; remove it, and the run goes on, but does not repeat bit for bit",
                     e.what());
  }
}

std::optional<RolloutState> TakeRolloutState(const fs::path& run, uint32_t actor) {
  std::optional<RolloutState> state = ReadRolloutState(run, actor);
  const fs::path file = FileOf(run, actor);
  std::error_code error;
  if (state && !fs::remove(file, error)) {
    throw RuntimeError("cannot remove '{}': {}", file.string(), error.message());
  }
  return state;
}

}  // namespace shoal::actor
