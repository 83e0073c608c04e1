#include "launch/record/accounting.h"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::launch {
namespace {

using Session = std::pair<uint32_t, uint64_t>;  // actor, session

void AddSession(const Session& name, uint64_t made, const SeenRecords& seen, bool outlives_replay,
                Accounting* sums) {
  sums->made += made;
  sums->stored += seen.stored;
  sums->lost_with_replay += seen.lost;
  sums->rejected += seen.rejected;
  sums->after_gap += seen.after_gap;
  sums->discarded += seen.discarded;
  sums->duplicates += seen.duplicates;
  const auto fault = [&](const std::string& what) {
    sums->faults.push_back(fmt::format("actor {} session {}: {}", name.first, name.second, what));
  };
  if (seen.highest > made) {
    fault(fmt::format("the replay saw sequence {}, but {} were made", seen.highest, made));
  } else {
    sums->lost_with_process += made - seen.highest;
  }
  if (outlives_replay && seen.lost > 0) {
    fault(fmt::format("{} records were reported stored in the replay file, but are not there",
                      seen.lost));
  }
  const uint64_t dealt = seen.stored + seen.rejected + seen.after_gap + seen.lost + seen.discarded;
  if (dealt != seen.highest) {
    fault(
        fmt::format("stored {} + rejected {} + after a gap {} + lost {} + discarded {} = {}, but "
                    "sequences up to {} were dealt with",
                    seen.stored, seen.rejected, seen.after_gap, seen.lost, seen.discarded, dealt,
                    seen.highest));
  }
}

}  // namespace

Accounting Account(std::span<const MadeRecords> made, const SeenByReplay& seen,
                   const AccountTerms& terms) {
  struct Counts {
    std::optional<uint64_t> made;
    SeenRecords seen;
  };
  std::map<Session, Counts> sessions;
  for (const MadeRecords& m : made) {
    auto& count = sessions[{m.actor, m.session}].made;
    count = count.value_or(0) + m.made;
  }
  Accounting sums;
  for (const SeenRecords& s : seen.sessions) {
    SeenRecords& entry = sessions[{s.actor, s.session}].seen;
    if (entry.session != 0) {
      sums.faults.push_back(
          fmt::format("actor {} session {}: listed twice by the replay", s.actor, s.session));
    }
    entry = s;
  }
  for (const auto& [name, counts] : sessions) {
    const bool unknown = !counts.made && name.first >= terms.own_actors;
    if (unknown) ++sums.sessions_without_page;
    AddSession(name, unknown ? counts.seen.highest : counts.made.value_or(0), counts.seen,
               terms.outlives_replay && !seen.ring_replaced, &sums);
  }
  if (sums.stored != seen.stored_records) {
    sums.faults.push_back(
        fmt::format("the sessions stored {} records, but {} were put into the ring", sums.stored,
                    seen.stored_records));
  }
  sums.resends = terms.resends;
  return sums;
}

std::string Accounting::Line() const {
  const std::string unknown =
      sessions_without_page == 0
          ? ""
          : fmt::format("; {} session(s) without a counter page: made as far as the replay saw",
                        sessions_without_page);
  return fmt::format(
      "records: made {} {} stored {} + lost with a process {} + lost with a replay {} + rejected "
      "{} + "
      "after a gap {} + discarded {}; "
      "duplicates {}, resends {}{}",
      made, Balances() ? '=' : '?', stored, lost_with_process, lost_with_replay, rejected,
      after_gap, discarded, duplicates, resends, unknown);
}

SeenByReplay ReadSeenByReplay(const std::filesystem::path& run) {
  const std::filesystem::path path = run / kAccountingFile;
  const nlohmann::json object = ParseStrictJson(ReadFile(path), path);
  SeenByReplay seen;
  try {
    if (object.at("schema") != kAccountingSchema) {
      throw RuntimeError("{}: expected schema '{}'", path.string(), kAccountingSchema);
    }
    object.at("stored_records").get_to(seen.stored_records);
    seen.ring_replaced = object.value("ring_replaced", false);
    for (const auto& session : object.at("sessions")) {
      SeenRecords s;
      session.at("actor").get_to(s.actor);
      session.at("session").get_to(s.session);
      session.at("highest").get_to(s.highest);
      session.at("stored").get_to(s.stored);
      session.at("rejected").get_to(s.rejected);
      session.at("after_gap").get_to(s.after_gap);
      session.at("lost").get_to(s.lost);
      s.discarded = session.value("discarded", uint64_t{0});  // runs of earlier versions lack it
      session.at("duplicates").get_to(s.duplicates);
      seen.sessions.push_back(s);
    }
  } catch (const nlohmann::json::exception& e) {
    throw RuntimeError("{}: {}", path.string(), e.what());
  }
  return seen;
}

nlohmann::ordered_json ToJson(const Accounting& a) {
  return {{"made", a.made},
          {"stored", a.stored},
          {"lost_with_process", a.lost_with_process},
          {"lost_with_replay", a.lost_with_replay},
          {"rejected", a.rejected},
          {"after_gap", a.after_gap},
          {"discarded", a.discarded},
          {"duplicates", a.duplicates},
          {"resends", a.resends},
          {"sessions_without_page", a.sessions_without_page},
          {"balances", a.Balances()}};
}

}  // namespace shoal::launch
