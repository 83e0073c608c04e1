// SPDX-License-Identifier: Apache-2.0
// Access rights to the page. Pure, except for MakeToken.
//
// Read access on loopback: every user of this host whose request names this host. (A foreign page
// that uses "DNS rebinding" names another host.) Read access at other addresses: every holder of
// the token. Write access (every method except GET and HEAD): a request from a page of this server
// with the token in the header kTokenHeader. A browser sends cookies automatically, so a cookie
// never gives write access.
#pragma once

#include <string>
#include <string_view>

#include "launch/watch/listen_address.h"

namespace shoal::launch {

inline constexpr char kTokenHeader[] = "X-Shoal-Token";
inline constexpr char kTokenCookie[] =
    "shoal_token";                              // followed by the port, as cookies ignore ports
inline constexpr char kTokenQuery[] = "token";  // query parameter of the printed address

// 128 random bits as 32 hexadecimal digits. Throws Error if the system provides no random bits.
std::string MakeToken();

// Whether a and b are equal. The time of the comparison depends only on their lengths.
bool EqualInConstantTime(std::string_view a, std::string_view b);

// The value of cookie `name` in a Cookie header; empty if there is no cookie of that name.
std::string_view CookieValue(std::string_view header, std::string_view name);

// Identification of a caller in its request. An empty member is missing in the request.
struct Caller {
  bool acts = false;             // method other than GET and HEAD
  std::string host{}, origin{};  // headers
  std::string fetch_site{};      // header Sec-Fetch-Site
  std::string header_token{};    // header kTokenHeader
  std::string cookie_token{}, query_token{};
};

enum class Access {
  kAllowed,
  kNoToken,  // no token, or a wrong token
  kForeign,  // the request comes from another server's page, or names another host
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
