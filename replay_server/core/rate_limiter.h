// SPDX-License-Identifier: Apache-2.0
// Keeps the ratio of samples to inserts by a bounded cursor.
//
//   cursor = (samples granted to steps that became sampleable) - (batch elements sampled),  0 when
//            min_size is first reached; kept in [-band/2, +band/2]
//   n steps that became sampleable when the run had stored x env steps are granted the integral of
//   SPI from x - n to x: SPI * n if SPI is constant
//   band  >= 2 * (SPI_most * W + credits * B),  SPI_most = the largest value of SPI,
//            W = steps that may become sampleable without new credit: the records in the windows of
//            all actor sessions, and stored steps that wait for a later record; B = batch
//
//   sample iff  cursor - B >= -band/2                  and min_size steps are sampleable
//   insert iff  cursor     <= band/2 - SPI_most * W    or  min_size steps are not
//
// One side can always proceed. A batch is held back only while cursor < B - band/2 <= -SPI_most *
// W, and credit only while cursor > band/2 - SPI_most * W >= credits * B. The two conditions never
// hold together. Credit cannot be withdrawn, so up to W more steps become sampleable after credit
// stops. These steps raise the cursor at most SPI_most * W above the threshold, still within the
// band. Inserts that do not become sampleable do not move the cursor, and no credit is withheld for
// them.
//
// If each step becomes sampleable as it is stored, the integrals of a run are adjacent. Steps that
// wait for a later record are granted the rate of the newest env steps, at most W steps too late.
//
// The limiter acts on credit and on requests only; records that have arrived are never refused. It
// reads no clock. One owner.
#pragma once

#include <cstdint>

#include "common/config/schedule.h"

namespace shoal::replay {

struct LimiterOptions {
  Schedule samples_per_insert;  // SPI, over the run's env steps; 0 = no limit but min_size
  uint64_t min_size = 1;        // sampleable steps before the first batch
  int batch = 1;                // B
  int credits = 1;              // batches the learner asks for ahead
  uint64_t window_records = 0;  // per actor session
  uint64_t waiting_steps = 0;   // per actor session: stored steps that wait for a later record
  double band = 0;              // 0, or less than the least band = the least band
  bool lockstep = false;        // actor and learner take turns by themselves: no limit
};

class RateLimiter {
 public:
  explicit RateLimiter(const LimiterOptions& options);

  // The least band for `sessions` actor sessions, in samples.
  static double LeastBand(const LimiterOptions& options, int sessions);

  // Each setter recomputes the band and moves the cursor back into the band.
  void SetSessions(int sessions);
  void SetSamplesPerInsert(const Schedule& samples_per_insert);
  // Draining: the actors flush and exit, the learner finishes; no credit or batch is held back.
  void SetDraining(bool draining) { draining_ = draining; }

  // `count` steps became sampleable; `sampleable` is the number of sampleable steps now. The first
  // min_size steps do not count. `env_steps`: env steps stored over the whole run, including
  // earlier servers.
  void Inserted(uint64_t count, uint64_t sampleable, uint64_t env_steps);
  // A batch was drawn.
  void Sampled();

  bool MayInsert(uint64_t sampleable) const;
  bool MaySample(uint64_t sampleable) const;

  double cursor() const { return cursor_; }
  double band() const { return band_; }
  const Schedule& samples_per_insert() const { return options_.samples_per_insert; }

 private:
  // SPI_most * W for `sessions` actor sessions.
  static double Unasked(const LimiterOptions& options, int sessions) {
    return options.samples_per_insert.Most() *
           static_cast<double>(options.window_records + options.waiting_steps) * sessions;
  }
  bool Limits() const { return options_.samples_per_insert.Most() > 0 && !options_.lockstep; }
  void Rebuild();

  LimiterOptions options_;
  int sessions_ = 0;
  double band_ = 0;
  double cursor_ = 0;
  bool draining_ = false;
};

}  // namespace shoal::replay
