// SPDX-License-Identifier: Apache-2.0
// The faults of a simulated run and their times, drawn from a seed.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "common/config/config.h"

namespace shoal::simulation {

struct Fault {
  enum class Kind {
    kKill,         // SIGKILL; if to the coordinator, the run is resumed after `span`
    kPause,        // SIGSTOP, and SIGCONT after `span`
    kStall,        // one thread of the process does not run for the time `span`
    kSlow,         // for the time `span`, each turn of a thread of the process takes 20 ms
    kPartition,    // the process is disconnected from all other processes for the time `span`
    kFullDisk,     // for the time `span`, all writes fail
    kFailingDisk,  // for the time `span`, one step in three of a process's writes fails
    kClock,        // the wall clock jumps by `span`, which may be negative
    kCommand,      // a user runs `shoal` with `text`: "scale 3"
    kAttach,       // `shoal attach`, and Ctrl-C to it after `span`
    kSecond,       // a second coordinator tries to open the run
    kInterrupt,    // Ctrl-C
  };

  Kind kind = Kind::kKill;
  std::chrono::milliseconds at{0};    // simulated time after the start
  std::string process{};              // "actor-1", "coordinator"; empty for other faults
  std::chrono::milliseconds span{0};  // see Kind
  std::string text{};                 // kCommand: its words; coordinator's kKill: the next event
  uint64_t number = 0;                // kStall: selects the thread

  // "12.345 s: pause actor-1 for 3.000 s"
  std::string Text() const;
};

// Events after a coordinator was killed (Fault::text).
inline constexpr char kThenResume[] = "resume";
inline constexpr char kThenOverwrite[] = "overwrite";     // train --overwrite in place of a resume
inline constexpr char kThenLoseRing[] = "lose the ring";  // removes the ring, then resumes
inline constexpr char kThenCutRing[] = "cut the ring off";  // truncates the ring, then resumes

// Draws the faults of a seed, sorted by time.
std::vector<Fault> DrawFaults(uint64_t seed, const Config& config);

}  // namespace shoal::simulation
