// SPDX-License-Identifier: Apache-2.0
#include "launch/record/accounting.h"

#include <fmt/core.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

namespace shoal::launch {
namespace {

using Session = std::pair<uint32_t, uint64_t>;  // actor, session

void AddSession(const Session& name, uint64_t made, const SessionCounters& seen,
                bool outlives_replay, Accounting* sums) {
  sums->made += made;
  sums->stored += seen.stored();
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
    fault(
        fmt::format("{} records were acknowledged but are missing in the replay file", seen.lost));
  }
}

}  // namespace

Accounting Account(std::span<const MadeRecords> made, const RunAccount& seen,
                   const AccountTerms& terms) {
  struct Counts {
    std::optional<uint64_t> made;
    SessionCounters seen;
  };
  std::map<Session, Counts> sessions;
  std::set<Session> lost_pages;
  for (const MadeRecords& m : made) {
    auto& count = sessions[{m.actor, m.session}].made;
    count = count.value_or(0) + m.made;
    if (!m.known) lost_pages.insert({m.actor, m.session});
  }
  Accounting sums;
  for (const SessionCounters& s : seen.sessions) {
    SessionCounters& entry = sessions[{s.actor, s.session}].seen;
    if (entry.session != 0) {
      sums.faults.push_back(
          fmt::format("actor {} session {}: listed twice by the replay", s.actor, s.session));
    }
    entry = s;
  }
  for (const auto& [name, counts] : sessions) {
    const bool unknown =
        (!counts.made && name.first >= terms.own_actors) || lost_pages.contains(name);
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
          : fmt::format(
                "; {} session(s) without a counter page: their made count is taken from the replay",
                sessions_without_page);
  return fmt::format(
      "records: made {} {} stored {} + lost with a process {} + lost with a replay {} + rejected "
      "{} + "
      "after a gap {} + discarded {}; "
      "duplicates {}, resends {}{}",
      made, Balances() ? '=' : '?', stored, lost_with_process, lost_with_replay, rejected,
      after_gap, discarded, duplicates, resends, unknown);
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
