// SPDX-License-Identifier: Apache-2.0
// Keeps the ratio of samples to inserts (SPI, samples per insert) by a bounded cursor.
//
//   cursor = (samples granted to steps that became sampleable) - (batch elements sampled);  0 when
//            min_size is first reached; kept in [-band/2, +band/2]
//   n steps that became sampleable when the run had stored x env steps are granted the integral of
//   SPI from x - n to x; this is SPI * n if SPI is constant
//   band  >= 2 * (SPI_most * W + credits * B),  SPI_most = the largest value of SPI,
//            W = steps that may become sampleable without new credit: the records in the windows of
//            all actor sessions, and stored steps that wait for a later record; B = batch
//
//   batch allowed if    cursor - B >= -band/2                  and min_size steps are sampleable
//   credit allowed if   cursor     <= band/2 - SPI_most * W    or fewer steps are sampleable
//
// Either the learner or the actors can always proceed. A batch is withheld only while cursor < B -
// band/2 <= -SPI_most * W, and credit only while cursor > band/2 - SPI_most * W >= credits * B. The
// two conditions are never true at the same time. Credit cannot be withdrawn, so up to W more steps
// become sampleable after credit stops. These steps raise the cursor at most SPI_most * W above the
// threshold, which is still within the band. Steps that do not become sampleable do not move the
// cursor, and no credit is withheld for them.
//
// If each step becomes sampleable when it is stored, the integrals of a run are adjacent. Steps
// that wait for a later record are granted the rate of the newest env steps, at most W steps too
// late.
//
// The limiter affects only credit and requests; records that have arrived are never refused. It
// reads no clock. Not thread-safe; one owner.
#pragma once

#include <cstdint>

#include "common/config/schedule.h"

namespace shoal::replay {

struct LimiterOptions {
  Schedule samples_per_insert;  // SPI, over the run's env steps; 0 = no limit except min_size
  uint64_t min_size = 1;        // sampleable steps before the first batch
  int batch = 1;                // B
  int credits = 1;              // batches that the learner requests in advance
  uint64_t window_records = 0;  // window of an actor session
  uint64_t waiting_steps = 0;   // stored steps of an actor session that wait for a later record
  double band = 0;              // if this is smaller than LeastBand, LeastBand is used
  bool lockstep = false;        // if true, there is no limit: actor and learner take turns
};

class RateLimiter {
 public:
  explicit RateLimiter(const LimiterOptions& options);

  // The smallest band for `sessions` actor sessions, in samples.
  static double LeastBand(const LimiterOptions& options, int sessions);

  // Each setter recomputes the band and moves the cursor back into the band.
  void SetSessions(int sessions);
  void SetSamplesPerInsert(const Schedule& samples_per_insert);
  // While draining, no credit and no batch is withheld. The actors then send their last records and
  // exit, and the learner finishes.
  void SetDraining(bool draining) { draining_ = draining; }

  // Call this function after `count` steps became sampleable. `sampleable`: number of sampleable
  // steps now. The first min_size steps do not count. `env_steps`: env steps stored over the whole
  // run, including earlier servers.
  void Inserted(uint64_t count, uint64_t sampleable, uint64_t env_steps);
  // Call this function after a batch was drawn.
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
