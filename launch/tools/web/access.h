// SPDX-License-Identifier: Apache-2.0
// Access rights to the page. Pure, except for making a token.
//
// Read access: on loopback every user of this host, by a name of this host (after "DNS rebinding" a
// foreign page uses another name); at any other address every holder of the token. Write access
// (every method except GET and HEAD): a request that has the token in a header of its own, from a
// page of this server. A browser sends cookies by itself, so a cookie never gives write access.
#pragma once

#include <string>
#include <string_view>

#include "launch/watch/listen_address.h"

namespace shoal::launch {

inline constexpr char kTokenHeader[] = "X-Shoal-Token";
inline constexpr char kTokenCookie[] =
    "shoal_token";                              // followed by the port: cookies know no ports
inline constexpr char kTokenQuery[] = "token";  // of the printed address

// 128 random bits as 32 hexadecimal digits. Throws Error where the system has none.
std::string MakeToken();

// Whether they are equal, in a time that depends on their lengths alone.
bool EqualInConstantTime(std::string_view a, std::string_view b);

// The value of a cookie in a Cookie header; empty when there is none of that name.
std::string_view CookieValue(std::string_view header, std::string_view name);

// Identification of a caller in its request. Empty members are missing there.
struct Caller {
  bool acts = false;             // by another method than GET and HEAD
  std::string host{}, origin{};  // headers
  std::string fetch_site{};      // header Sec-Fetch-Site
  std::string header_token{};    // header kTokenHeader
  std::string cookie_token{}, query_token{};
};

enum class Access {
  kAllowed,
  kNoToken,  // none, or a wrong one
  kForeign,  // from a page of others, or under another name
};

class Gate {
 public:
  Gate(const ListenAddress& listen, const std::string& token) : listen_(listen), token_(token) {}

  Access Decide(const Caller& caller) const;

 private:
  bool OwnName(std::string_view host) const;

  const ListenAddress listen_;
  const std::string token_;
};

}  // namespace shoal::launch
