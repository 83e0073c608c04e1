#include "replay_server/service/accounting_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal::replay {
namespace {

constexpr char kSchema[] = "shoal-accounting-1";

}  // namespace

std::string AccountingJson(const SessionTable& sessions, uint64_t stored_steps,
                           uint64_t stored_records) {
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
                    {"duplicates", counters.duplicates}});
  }
  const nlohmann::ordered_json object = {{"schema", kSchema},
                                         {"stored_steps", stored_steps},
                                         {"stored_records", stored_records},
                                         {"sessions", list}};
  return object.dump(1) + "\n";
}

uint64_t StoredStepsBefore(const std::filesystem::path& run) {
  const std::filesystem::path path = run / kAccountingFile;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return 0;
  const auto object = nlohmann::json::parse(ReadFile(path), nullptr, /*allow_exceptions=*/false);
  if (!object.is_object() || !object.contains("schema") || object["schema"] != kSchema) {
    throw RuntimeError("'{}': expected an object of schema '{}'", path.string(), kSchema);
  }
  const auto steps = object.find("stored_steps");
  if (steps == object.end() || !steps->is_number_unsigned()) {
    throw RuntimeError("'{}': 'stored_steps' is missing or not a count", path.string());
  }
  return steps->get<uint64_t>();
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

}  // namespace shoal::replay
