// SPDX-License-Identifier: Apache-2.0
#include "common/dds/qos.h"

namespace shoal::dds {

QosHandle MakeQos(const link::TopicSettings& settings) {
  QosHandle qos(dds_create_qos(), &dds_delete_qos);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE,
                       DDS_MSECS(settings.max_blocking.count()));
  if (settings.keep_last == 0) {
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
  } else {
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, settings.keep_last);
  }
  if (settings.late_joiners) {
    dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    // Late joiners receive samples up to this depth; the depth of the history does not apply to
    // them.
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, settings.keep_last,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  } else {
    dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  }
  // @appendable types need the second version of CDR.
  const dds_data_representation_id_t representation =
      settings.bulk ? DDS_DATA_REPRESENTATION_XCDR1 : DDS_DATA_REPRESENTATION_XCDR2;
  dds_qset_data_representation(qos.get(), 1, &representation);
  return qos;
}

}  // namespace shoal::dds
