// accounting.json of a run (schema shoal-accounting-1): what became of every record, per actor
// session.
#pragma once

#include <filesystem>
#include <string>

#include "replay_server/core/session_table.h"

namespace shoal::replay {

inline constexpr char kAccountingFile[] = "accounting.json";

// {schema, stored_steps, stored_records, sessions: [{actor, session, highest, stored, rejected,
// after_gap, lost, duplicates}]} with highest = stored + rejected + after_gap + lost.
// `stored_records` is the ring's own count of what was ever put in, so a check on the sessions'.
std::string AccountingJson(const SessionTable& sessions, uint64_t stored_steps,
                           uint64_t stored_records);

// The stored_steps that an earlier server of the run left; 0 when there was none. Throws Error.
uint64_t StoredStepsBefore(const std::filesystem::path& run);

// Replaces the file: readers see the old one or the new one. Not synced, so that a busy disk does
// not hold up the caller; WriteFileAtomically (common/base/files.h) is for the last one. Throws
// Error.
void ReplaceFile(const std::filesystem::path& path, const std::string& content);

}  // namespace shoal::replay
