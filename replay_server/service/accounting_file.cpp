#include "replay_server/service/accounting_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/error.h"

namespace shoal::replay {

std::string AccountingJson(const SessionTable& sessions) {
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
  const nlohmann::ordered_json object = {{"schema", "shoal-accounting-1"}, {"sessions", list}};
  return object.dump(1) + "\n";
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
