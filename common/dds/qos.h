// SPDX-License-Identifier: Apache-2.0
// The DDS quality of service of a topic. Every topic is reliable. Internal.
#pragma once

#include <memory>

#include "common/link/topic.h"
// clang-format off
#include "dds/dds.h"
// clang-format on

namespace shoal::dds {

using QosHandle = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

// The settings apply to the topic, its writers and its readers.
QosHandle MakeQos(const link::TopicSettings& settings);

}  // namespace shoal::dds
