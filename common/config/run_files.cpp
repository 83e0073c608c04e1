// SPDX-License-Identifier: Apache-2.0
#include "common/config/run_files.h"

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

using nlohmann::json;

std::string HexHash(uint64_t hash) { return fmt::format("{:016x}", hash); }

json ReadObject(const std::filesystem::path& path, const char* schema) {
  json object = ParseStrictJson(ReadFile(path), path);
  if (!object.is_object() || !object.contains("schema") || object["schema"] != schema) {
    throw RuntimeError("{}: expected an object of schema '{}'", path.string(), schema);
  }
  return object;
}

// Returns the member, or throws Error that names it.
template <class T>
T Member(const json& object, const char* name, const std::filesystem::path& path) {
  try {
    return object.at(name).get<T>();
  } catch (const json::exception&) {
    throw RuntimeError("{}: '{}' is missing or ill-typed", path.string(), name);
  }
}

}  // namespace

std::string RunConfigText(const RunConfig& config) {
  nlohmann::ordered_json object;
  object["schema"] = kConfigSchema;
  object.update(ToJson(config.config));
  object["config_hash"] = HexHash(ConfigHash(config.config));
  object["spec"] = ToJson(config.spec);
  object["spec_hash"] = HexHash(config.spec.Hash());
  return object.dump(2) + "\n";
}

void WriteRunConfig(const std::filesystem::path& run, const RunConfig& config) {
  WriteFileAtomically(run / kConfigFile, RunConfigText(config));
}

RunConfig ReadRunConfig(const std::filesystem::path& run) {
  const std::filesystem::path path = run / kConfigFile;
  const json object = ReadObject(path, kConfigSchema);
  RunConfig result;
  ApplyFile(path, &result.config);
  Validate(result.config);
  result.spec = ObservationSpecFromJson(Member<json>(object, "spec", path));
  const auto stored = Member<std::string>(object, "spec_hash", path);
  if (stored != HexHash(result.spec.Hash())) {
    throw RuntimeError("{}: spec_hash is {}, but the spec '{}' has {}", path.string(), stored,
                       result.spec.Summary(), HexHash(result.spec.Hash()));
  }
  return result;
}

void WriteClusterAddress(const std::filesystem::path& run, const ClusterAddress& address) {
  nlohmann::ordered_json object{{"schema", kClusterSchema},
                                {"domain", address.domain},
                                {"tag", address.tag},
                                {"host", address.host}};
  if (!address.secure.empty()) object["secure"] = address.secure;
  WriteFileAtomically(run / kClusterFile, object.dump(2) + "\n");
}

ClusterAddress ReadClusterAddress(const std::filesystem::path& run) {
  const std::filesystem::path path = run / kClusterFile;
  const json object = ReadObject(path, kClusterSchema);
  ClusterAddress address;
  address.domain = Member<int>(object, "domain", path);
  address.tag = Member<std::string>(object, "tag", path);
  address.host = Member<std::string>(object, "host", path);
  if (object.contains("secure")) address.secure = Member<std::string>(object, "secure", path);
  if (address.domain < 0 || address.domain >= 100 || address.domain % 2 != 0) {
    throw RuntimeError("{}: domain = {}: expected an even number below 100", path.string(),
                       address.domain);
  }
  return address;
}

void KeepSecuredRunPrivate(const std::filesystem::path& run) {
  if (!std::filesystem::exists(run / kClusterFile)) return;
  if (!ReadClusterAddress(run).secure.empty()) KeepFilesPrivate();
}

}  // namespace shoal
