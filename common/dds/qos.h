// SPDX-License-Identifier: Apache-2.0
// Quality of service of a topic in the terms that differ between ours. Internal.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "common/dds/bus.h"
// clang-format off
#include "dds/dds.h"
// clang-format on

namespace shoal::dds {

// Every topic is reliable.
struct TopicSettings {
  const char* name;
  Plane plane;
  // 0: every sample is kept until all readers have it, and Write blocks at most max_blocking.
  // n: the last n per key are kept, older ones are overwritten, and Write never blocks.
  int32_t keep_last;
  bool late_joiners;  // get the last keep_last samples (transient-local)
  bool bulk;          // a @final type in plain CDR; else @appendable
  std::chrono::milliseconds max_blocking;
};

using QosHandle = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

// For topic, writer and reader alike.
QosHandle MakeQos(const TopicSettings& settings);

}  // namespace shoal::dds
