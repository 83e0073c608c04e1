// SPDX-License-Identifier: Apache-2.0
// Functions that writers and readers share: they create a topic, and log an error if a peer's
// quality of service does not match. Internal.
#pragma once

#include <memory>
#include <string>

#include "common/base/check.h"
#include "common/base/log.h"
#include "common/dds/bus_impl.h"
#include "common/dds/qos.h"
#include "common/dds/wire_type.h"

namespace shoal::dds {

using ListenerHandle = std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)>;

template <class M>
Entity CreateTopic(Bus& bus) {
  const link::TopicSettings& settings = link::Topic<M>::kSettings;
  const dds_entity_t participant = bus.impl().Participant(settings.plane);
  CHECK(participant > 0) << "topic " << settings.name << ": this role is not in the batch domain";
  return Entity(dds_create_topic(participant, WireType<M>::kDescriptor, settings.name,
                                 MakeQos(settings).get(), nullptr),
                std::string("topic ") + settings.name);
}

// `argument`: passed to the data callback, if the caller sets a data callback.
template <class M>
ListenerHandle MakeListener(void* argument) {
  ListenerHandle listener(dds_create_listener(argument), &dds_delete_listener);
  dds_lset_offered_incompatible_qos(
      listener.get(), [](dds_entity_t, dds_offered_incompatible_qos_status_t status, void*) {
        log::Failure(
            "dds: a reader of topic {} asks for quality of service (policy {}) that this "
            "process does not offer: another version of Shoal?",
            link::Topic<M>::kSettings.name, static_cast<int>(status.last_policy_id));
      });
  dds_lset_requested_incompatible_qos(
      listener.get(), [](dds_entity_t, dds_requested_incompatible_qos_status_t status, void*) {
        log::Failure(
            "dds: a writer of topic {} does not offer the quality of service (policy {}) "
            "that this process asks for: another version of Shoal?",
            link::Topic<M>::kSettings.name, static_cast<int>(status.last_policy_id));
      });
  return listener;
}

}  // namespace shoal::dds
