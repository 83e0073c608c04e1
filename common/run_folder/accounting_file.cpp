// SPDX-License-Identifier: Apache-2.0
#include "common/run_folder/accounting_file.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/json_members.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

SessionCounters SessionOf(const JsonMembers& session) {
  const uint64_t actor = session.Count("actor");
  if (actor > std::numeric_limits<uint32_t>::max()) {
    session.Refuse("actor", fmt::format("{}: expected 32 bits", actor));
  }
  const SessionCounters counters{
      .actor = static_cast<uint32_t>(actor),
      .session = session.Count("session"),
      .highest = session.Count("highest"),
      .rejected = session.Count("rejected"),
      .after_gap = session.Count("after_gap"),
      .lost = session.Count("lost"),
      .discarded = session.Has("discarded") ? session.Count("discarded") : 0,
      .duplicates = session.Count("duplicates")};
  if (const uint64_t stored = session.Count("stored"); stored != counters.stored()) {
    session.Refuse("stored", fmt::format("{} of actor {}: the other counts leave {} of {}", stored,
                                         actor, counters.stored(), counters.highest));
  }
  return counters;
}

RunAccount ParseAccount(const std::string& text, const fs::path& path) {
  const std::string file = fmt::format("'{}'", path.string());
  const nlohmann::ordered_json object = ParseSchemaObject(text, file, kAccountingSchema);
  const JsonMembers members(object, file);
  RunAccount account{
      .stored_steps = members.Count("stored_steps"),
      .stored_records = members.Count("stored_records"),
      .ring_replaced = members.Has("ring_replaced") && members.Flag("ring_replaced")};
  std::set<std::pair<uint32_t, uint64_t>> seen;
  for (size_t i = 0; i < members.List("sessions").size(); ++i) {
    const JsonMembers session = members.ObjectOf("sessions", i);
    const SessionCounters& counters = account.sessions.emplace_back(SessionOf(session));
    if (!seen.emplace(counters.actor, counters.session).second) {
      session.Refuse("session", fmt::format("{} of actor {} is listed twice: expected it once",
                                            counters.session, counters.actor));
    }
  }
  return account;
}

std::string AccountingJson(const RunAccount& account) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SessionCounters& counters : account.sessions) {
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
                                         {"stored_steps", account.stored_steps},
                                         {"stored_records", account.stored_records},
                                         {"ring_replaced", account.ring_replaced},
                                         {"sessions", list}};
  return object.dump(1) + "\n";
}

}  // namespace

RunAccount ReadAccount(const fs::path& run) {
  const fs::path path = run / kAccountingFile;
  return ParseAccount(ReadFile(path), path);
}

RunAccount ReadAccountBefore(const fs::path& run) {
  std::error_code error;
  if (!fs::exists(run / kAccountingFile, error)) return {};
  try {
    return ReadAccount(run);
  } catch (const Error& e) {
    throw UsageError("{}", e.what());  // a usage error, because a restart would read the same file
  }
}

void ReplaceAccount(const fs::path& run, const RunAccount& account) {
  ReplaceFile(run / kAccountingFile, AccountingJson(account));
}

void StoreAccount(const fs::path& run, const RunAccount& account) {
  WriteFileAtomically(run / kAccountingFile, AccountingJson(account));
}

}  // namespace shoal
