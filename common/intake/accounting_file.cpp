#include "common/intake/accounting_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

uint64_t Count(const nlohmann::json& object, const char* key) {
  const nlohmann::json& value = object.at(key);
  if (!value.is_number_unsigned())
    throw RuntimeError("'{}': '{}' is no count", kAccountingFile, key);
  return value.get<uint64_t>();
}

}  // namespace

std::string AccountingJson(const SessionLedger& sessions, const AccountTotals& totals) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (int i = 0; i < sessions.size(); ++i) {
    const SessionCounters& counters = sessions.at(i);
    list.push_back({{"actor", counters.actor},
                    {"session", counters.session},
                    {"highest", counters.highest},
                    {"stored", counters.stored()},
                    {"rejected", counters.rejected},
                    {"after_gap", counters.after_gap},
                    {"lost", counters.lost},
                    {"discarded", counters.discarded},
                    {"duplicates", counters.duplicates}});
  }
  const nlohmann::ordered_json object = {{"schema", kAccountingSchema},
                                         {"stored_steps", totals.stored_steps},
                                         {"stored_records", totals.stored_records},
                                         {"ring_replaced", totals.ring_replaced},
                                         {"sessions", list}};
  return object.dump(1) + "\n";
}

AccountBefore ReadAccountBefore(const std::filesystem::path& run) {
  const std::filesystem::path path = run / kAccountingFile;
  AccountBefore before;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return before;
  const auto object = ParseBoundedJson<nlohmann::json>(ReadFile(path));
  if (!object.is_object() || !object.contains("schema") || object["schema"] != kAccountingSchema) {
    throw RuntimeError("'{}': expected an object of schema '{}'", path.string(), kAccountingSchema);
  }
  try {
    before.stored_steps = Count(object, "stored_steps");
    before.ring_replaced = object.value("ring_replaced", false);
    for (const auto& session : object.at("sessions")) {
      const SessionCounters counters{
          .actor = session.at("actor").get<uint32_t>(),
          .session = Count(session, "session"),
          .highest = Count(session, "highest"),
          .rejected = Count(session, "rejected"),
          .after_gap = Count(session, "after_gap"),
          .lost = Count(session, "lost"),
          .discarded = session.contains("discarded") ? Count(session, "discarded") : 0,
          .duplicates = Count(session, "duplicates")};
      if (counters.stored() != Count(session, "stored")) {
        throw RuntimeError("'{}': the counts of actor {} do not add up", path.string(),
                           counters.actor);
      }
      before.sessions.push_back(counters);
    }
  } catch (const nlohmann::json::exception& e) {
    throw RuntimeError("'{}': {}", path.string(), e.what());
  }
  return before;
}

void ReplaceFile(const std::filesystem::path& path, const std::string& content) {
  const std::filesystem::path temporary = path.string() + ".new";
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out << content;
  out.close();
  std::error_code error;
  if (!out) {
    const int reason = errno;
    std::filesystem::remove(temporary, error);
    throw RuntimeError("cannot write '{}': {}", path.string(), std::strerror(reason));
  }
  std::filesystem::rename(temporary, path, error);
  if (error) throw RuntimeError("cannot write '{}': {}", path.string(), error.message());
}

}  // namespace shoal
