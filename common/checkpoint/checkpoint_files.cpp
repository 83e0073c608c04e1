// SPDX-License-Identifier: Apache-2.0
#include "common/checkpoint/checkpoint_files.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "common/base/bounded_json.h"
#include "common/base/build_info.h"
#include "common/base/crc32.h"
#include "common/base/disk_steps.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/one_line.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr char kPrefix[] = "step_";
// The hint of every error, because damage cannot be repaired.
constexpr char kInstead[] = "take another checkpoint";

uint32_t Crc(std::string_view bytes) {
  return Crc32({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

// Hashes are hexadecimal strings, because many JSON readers read numbers as doubles.
std::string Hex64(uint64_t word) { return fmt::format("{:016x}", word); }

uint64_t ParseHex64(const ordered_json& value) {
  const auto& text = value.get_ref<const std::string&>();
  uint64_t word = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), word, 16);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw RuntimeError("'{}' is not a hexadecimal number", text);
  }
  return word;
}

ordered_json FileEntry(const std::string& bytes) {
  return {{"bytes", bytes.size()}, {"crc32", Crc(bytes)}};
}

ordered_json ToJson(const CheckpointState& state) {
  return {{"schema", kStateSchema},
          {"updates", state.updates},
          {"env_steps", state.env_steps},
          {"request", state.request},
          {"session", state.learner_session},
          {"config_hash", Hex64(state.config_hash)},
          {"spec_hash", Hex64(state.spec_hash)},
          {"precision", state.precision},
          {"algorithm", state.algorithm}};
}

CheckpointState StateFromJson(const ordered_json& json) {
  CheckpointState state;
  json.at("updates").get_to(state.updates);
  json.at("env_steps").get_to(state.env_steps);
  json.at("request").get_to(state.request);
  json.at("session").get_to(state.learner_session);
  state.config_hash = ParseHex64(json.at("config_hash"));
  state.spec_hash = ParseHex64(json.at("spec_hash"));
  json.at("precision").get_to(state.precision);
  // Checkpoints from before there was a choice lack this member.
  if (json.contains("algorithm")) json.at("algorithm").get_to(state.algorithm);
  return state;
}

// Reads the object of state.json and verifies its schema and its own checksum.
ordered_json ReadStateObject(const fs::path& path) {
  const std::string file = path.string();
  ordered_json json = ParseBoundedJson<ordered_json>(ReadFile(path));
  if (!json.is_object()) {
    throw RuntimeError("'{}': not a JSON object (truncated?), or nested too deep; {}", file,
                       kInstead);
  }
  const auto schema = json.find("schema");
  if (schema == json.end() || *schema != kStateSchema) {
    const bool newer = schema != json.end() && schema->is_string() &&
                       schema->get_ref<const std::string&>().starts_with("shoal-checkpoint-");
    throw RuntimeError("'{}': schema {}, this is Shoal {}, which reads \"{}\": {}", file,
                       schema == json.end() ? "missing" : Shortened(schema->dump(), 60),
                       BuildVersion(), kStateSchema,
                       newer ? "use the version that wrote it, or a newer one" : kInstead);
  }
  const auto stored = json.find("crc32");
  if (stored == json.end() || !stored->is_number_unsigned()) {
    throw RuntimeError("'{}': key 'crc32' missing; {}", file, kInstead);
  }
  const auto expected = stored->get<uint64_t>();
  json.erase("crc32");
  const uint32_t found = Crc(json.dump());
  if (found != expected) {
    throw RuntimeError("'{}': CRC-32 {:08x}, expected {:08x}: the file was altered; {}", file,
                       found, expected, kInstead);
  }
  return json;
}

// Reads FOLDER/NAME and verifies the size and checksum that state.json gives.
std::string ReadVerified(const fs::path& folder, const char* name, const ordered_json& entry) {
  const std::string file = (folder / name).string();
  std::string bytes = ReadFile(file);
  if (bytes.size() != entry.at("bytes").get<uint64_t>()) {
    throw RuntimeError("'{}': {} bytes, expected {}: truncated or replaced; {}", file, bytes.size(),
                       entry.at("bytes").get<uint64_t>(), kInstead);
  }
  const uint32_t found = Crc(bytes), expected = entry.at("crc32").get<uint32_t>();
  if (found != expected) {
    throw RuntimeError("'{}': CRC-32 {:08x}, expected {:08x}: the file was altered; {}", file,
                       found, expected, kInstead);
  }
  return bytes;
}

CheckpointFiles ReadFiles(const fs::path& folder, bool policy_alone) {
  const fs::path state_file = folder / kStateFile;
  const ordered_json json = ReadStateObject(state_file);
  CheckpointFiles checkpoint;
  try {
    checkpoint.state = StateFromJson(json);
    const ordered_json& files = json.at("files");
    if (!policy_alone) {
      checkpoint.learner = ReadVerified(folder, kLearnerFile, files.at(kLearnerFile));
    }
    checkpoint.policy = ReadVerified(folder, kPolicyFile, files.at(kPolicyFile));
    if (files.contains(kDescriptionFile)) {
      checkpoint.description = ReadVerified(folder, kDescriptionFile, files.at(kDescriptionFile));
    }
  } catch (const ordered_json::exception& e) {
    throw RuntimeError("'{}': {}", state_file.string(), e.what());
  }
  return checkpoint;
}

// Moves `from` to `to`. If `to` exists, the two are exchanged.
void MoveOver(const fs::path& from, const fs::path& to) {
  errno = DiskStep(to);
  if (errno == 0 && rename(from.c_str(), to.c_str()) == 0) return;
  if ((errno == ENOTEMPTY || errno == EEXIST) &&
      renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) {
    return;
  }
  throw RuntimeError("cannot rename '{}' to '{}': {}", from.string(), to.string(),
                     std::strerror(errno));
}

}  // namespace

std::string CheckpointName(uint64_t updates) { return fmt::format("{}{:09}", kPrefix, updates); }

std::optional<uint64_t> CheckpointUpdates(const std::string& name) {
  if (!name.starts_with(kPrefix)) return std::nullopt;
  const char* begin = name.data() + sizeof kPrefix - 1;
  const char* end = name.data() + name.size();
  uint64_t updates = 0;
  const auto [parsed, error] = std::from_chars(begin, end, updates);
  // Other spellings of the number are no names of checkpoints.
  if (error != std::errc() || parsed != end || CheckpointName(updates) != name) {
    return std::nullopt;
  }
  return updates;
}

void WriteCheckpointFiles(const fs::path& parent, const CheckpointFiles& files,
                          const ordered_json& meta) {
  const std::string name = CheckpointName(files.state.updates);
  const fs::path fresh = parent / fmt::format(".{}.tmp-{}", name, getpid());
  ordered_json json = ToJson(files.state);
  json["files"] = {{kLearnerFile, FileEntry(files.learner)},
                   {kPolicyFile, FileEntry(files.policy)}};
  if (!files.description.empty()) {
    json["files"][kDescriptionFile] = FileEntry(files.description);
  }
  json["crc32"] = Crc(json.dump());
  std::error_code ignored;
  fs::remove_all(fresh, ignored);
  try {
    MakeFolders(fresh);
    WriteFileAtomically(fresh / kLearnerFile, files.learner);
    WriteFileAtomically(fresh / kPolicyFile, files.policy);
    if (!files.description.empty()) {
      WriteFileAtomically(fresh / kDescriptionFile, files.description);
    }
    WriteFileAtomically(fresh / kStateFile, json.dump(2) + "\n");
    WriteFileAtomically(fresh / kCheckpointMetaFile, meta.dump(2) + "\n");
    MoveOver(fresh, parent / name);
    SyncFolder(parent);
  } catch (...) {
    fs::remove_all(fresh, ignored);
    throw;
  }
  fs::remove_all(fresh, ignored);  // an earlier checkpoint of the same name, if there was one
}

CheckpointFiles ReadCheckpointFiles(const fs::path& folder) {
  return ReadFiles(folder, /*policy_alone=*/false);
}

CheckpointFiles ReadPolicyFiles(const fs::path& folder) {
  return ReadFiles(folder, /*policy_alone=*/true);
}

CheckpointFiles ReadCheckpointFiles(const fs::path& folder, uint64_t spec_hash) {
  CheckpointFiles checkpoint = ReadCheckpointFiles(folder);
  if (checkpoint.state.spec_hash != spec_hash) {
    throw RuntimeError("'{}': observation spec {:016x}, expected this run's {:016x}",
                       (folder / kStateFile).string(), checkpoint.state.spec_hash, spec_hash);
  }
  return checkpoint;
}

}  // namespace shoal
