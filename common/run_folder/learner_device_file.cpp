// SPDX-License-Identifier: Apache-2.0
#include "common/run_folder/learner_device_file.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "common/run_folder/json_members.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

nlohmann::ordered_json TextOrNull(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

}  // namespace

std::string Describe(const LearnerDeviceRecord& record) {
  if (record.device == "cpu") {
    return "the CPU" + (record.reason.empty() ? "" : ": " + record.reason);
  }
  return fmt::format("{} ({:.0f} GB, driver {})", record.card,
                     static_cast<double>(record.memory_bytes) / 1e9, record.driver);
}

std::optional<LearnerDeviceRecord> ReadLearnerDevice(const std::filesystem::path& run) {
  const std::filesystem::path path = run / kLearnerDeviceFile;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::nullopt;
  const std::string file = fmt::format("'{}'", path.string());
  const nlohmann::ordered_json object =
      ParseSchemaObject(ReadFile(path), file, kLearnerDeviceSchema);
  const JsonMembers members(object, file);
  return LearnerDeviceRecord{.device = members.Text("device"),
                             .card = members.TextIfAny("card").value_or(""),
                             .driver = members.TextIfAny("driver").value_or(""),
                             .memory_bytes = members.Count("memory_bytes"),
                             .precision = members.Text("precision"),
                             .reason = members.TextIfAny("reason").value_or(""),
                             .losses = members.Count("losses")};
}

void WriteLearnerDevice(const std::filesystem::path& run, const LearnerDeviceRecord& record) {
  const nlohmann::ordered_json object{
      {"schema", kLearnerDeviceSchema},      {"device", record.device},
      {"card", TextOrNull(record.card)},     {"driver", TextOrNull(record.driver)},
      {"memory_bytes", record.memory_bytes}, {"precision", record.precision},
      {"reason", TextOrNull(record.reason)}, {"losses", record.losses}};
  // `reason` may quote a library's message, which need not be UTF-8.
  ReplaceFile(run / kLearnerDeviceFile,
              object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace shoal
