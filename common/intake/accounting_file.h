// accounting.json of a run (schema shoal-accounting-1): what became of every record, per actor
// session.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/intake/session_ledger.h"

namespace shoal {

struct AccountTotals {
  uint64_t stored_steps = 0;
  uint64_t stored_records = 0;  // the receiver's own count of what was ever put in, or learned from
  // At some time in the run a ring was gone with what it held, and another one begun.
  bool ring_replaced = false;
};

// {schema, stored_steps, stored_records, ring_replaced, sessions: [{actor, session, highest,
// stored, rejected, after_gap, lost, discarded, duplicates}]} with highest = stored + rejected +
// after_gap + lost + discarded.
std::string AccountingJson(const SessionLedger& sessions, const AccountTotals& totals);

struct AccountBefore {
  uint64_t stored_steps = 0;
  std::vector<SessionCounters> sessions;
  bool ring_replaced = false;
};

// What an earlier receiver of the run left; zeros when there was none. Throws Error.
AccountBefore ReadAccountBefore(const std::filesystem::path& run);

// Replaces the file: readers see the old one or the new one. Not synced, so that a busy disk does
// not hold up the caller; WriteFileAtomically (common/base/files.h) is for the last one. Throws
// Error.
void ReplaceFile(const std::filesystem::path& path, const std::string& content);

}  // namespace shoal
