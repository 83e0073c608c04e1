// SPDX-License-Identifier: Apache-2.0
#include "common/credentials/permission_documents.h"

#include <fmt/chrono.h>
#include <fmt/core.h>

namespace shoal::credentials {
namespace {

constexpr char kDomains[] = "<domains><id_range><min>0</min><max>99</max></id_range></domains>";

std::string Topics(const char* act, const std::vector<std::string>& topics) {
  if (topics.empty()) return "";
  std::string text = fmt::format("<{}><topics>", act);
  for (const std::string& topic : topics) text += fmt::format("<topic>{}</topic>", topic);
  return text + fmt::format("</topics></{}>\n", act);
}

std::string Time(std::time_t time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(time));
}

}  // namespace

std::string GovernanceDocument() {
  return fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xsi:noNamespaceSchemaLocation="https://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
<domain_access_rules><domain_rule>
{}
<allow_unauthenticated_participants>false</allow_unauthenticated_participants>
<enable_join_access_control>true</enable_join_access_control>
<discovery_protection_kind>ENCRYPT</discovery_protection_kind>
<liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
<rtps_protection_kind>SIGN</rtps_protection_kind>
<topic_access_rules><topic_rule>
<topic_expression>*</topic_expression>
<enable_discovery_protection>true</enable_discovery_protection>
<enable_liveliness_protection>true</enable_liveliness_protection>
<enable_read_access_control>true</enable_read_access_control>
<enable_write_access_control>true</enable_write_access_control>
<metadata_protection_kind>NONE</metadata_protection_kind>
<data_protection_kind>ENCRYPT</data_protection_kind>
</topic_rule></topic_access_rules>
</domain_rule></domain_access_rules>
</dds>
)",
                     kDomains);
}

std::string PermissionsDocument(const RoleRights& rights, const std::string& subject,
                                const Validity& validity) {
  return fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xsi:noNamespaceSchemaLocation="https://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
<permissions><grant name="{0}">
<subject_name>CN={0}</subject_name>
<validity><not_before>{1}</not_before><not_after>{2}</not_after></validity>
<allow_rule>
{3}
{4}{5}</allow_rule>
<default>DENY</default>
</grant></permissions>
</dds>
)",
                     subject, Time(validity.from), Time(validity.until), kDomains,
                     Topics("publish", rights.publishes), Topics("subscribe", rights.subscribes));
}

}  // namespace shoal::credentials
