// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <openssl/err.h>
#include <openssl/pem.h>

#include <utility>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/credentials/credentials.h"
#include "common/credentials/openssl_objects.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using credentials::Buffer;
using credentials::Certificate;
using credentials::Key;
using credentials::Signed;
using credentials::Signers;

std::string Date(const ASN1_TIME* time) {
  std::tm parts{};
  if (ASN1_TIME_to_tm(time, &parts) != 1) return "an unreadable date";
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", parts);
}

void CheckValidity(const X509* certificate, const fs::path& file, std::time_t now) {
  const ASN1_TIME* from = X509_get0_notBefore(certificate);
  const ASN1_TIME* until = X509_get0_notAfter(certificate);
  if (ASN1_TIME_cmp_time_t(until, now) < 0) {
    throw RuntimeError("certificate '{}' has expired on {}: make others with shoal secure init",
                       file.string(), Date(until));
  }
  if (ASN1_TIME_cmp_time_t(from, now) > 0) {
    throw RuntimeError("certificate '{}' is valid from {} only: is this clock right?",
                       file.string(), Date(from));
  }
}

// Checks as the DDS library does: the signature must be the authority's own and cover exactly this
// text.
void CheckSigned(const fs::path& file, const Certificate& ca, const fs::path& ca_file) {
  const std::string bytes = ReadFile(file);
  if (bytes.empty()) throw RuntimeError("'{}' is empty", file.string());
  const Buffer text = credentials::MakeBuffer(bytes);
  BIO* content = nullptr;
  const Signed signature(SMIME_read_PKCS7(text.get(), &content));
  const Buffer signed_text(content);
  const Signers signers(sk_X509_new_null());
  const Buffer plain = credentials::MakeBuffer();  // receives the text without its heading
  constexpr int kFlags = PKCS7_TEXT | PKCS7_NOVERIFY | PKCS7_NOINTERN;
  if (signature != nullptr && signers != nullptr && sk_X509_push(signers.get(), ca.get()) > 0 &&
      PKCS7_verify(signature.get(), signers.get(), nullptr, content, plain.get(), kFlags) == 1) {
    return;
  }
  ERR_clear_error();
  throw RuntimeError("'{}' was altered, or not signed by the authority of '{}'", file.string(),
                     ca_file.string());
}

}  // namespace

std::array<fs::path, 5> CredentialFiles(const fs::path& folder, const std::string& role) {
  return {folder / "ca.pem", folder / "governance.p7s", folder / (role + ".pem"),
          folder / (role + ".key"), folder / (role + ".p7s")};
}

void CheckCredentials(const fs::path& folder, const std::string& role, std::time_t now) {
  const auto [ca_file, governance, file, key_file, permissions] = CredentialFiles(folder, role);
  const Certificate ca = credentials::ReadCertificate(ca_file);
  const Certificate certificate = credentials::ReadCertificate(file);
  const Key key = credentials::ReadKey(key_file);
  CheckValidity(ca.get(), ca_file, now);
  CheckValidity(certificate.get(), file, now);
  const Key ca_key(X509_get_pubkey(ca.get()));
  if (ca_key == nullptr || X509_verify(certificate.get(), ca_key.get()) != 1) {
    ERR_clear_error();
    throw RuntimeError("certificate '{}' was not made by the authority of '{}'", file.string(),
                       ca_file.string());
  }
  if (X509_check_private_key(certificate.get(), key.get()) != 1) {
    ERR_clear_error();
    throw RuntimeError("'{}' is not the key of certificate '{}'", key_file.string(), file.string());
  }
  for (const fs::path& document : {governance, permissions}) CheckSigned(document, ca, ca_file);
}

void CheckRights(const fs::path& folder, const RoleRights& rights) {
  const fs::path file = folder / (rights.role + ".p7s");
  const std::string permissions = ReadFile(file);
  for (const auto& [verb, topics] : {std::pair(std::string("publish"), rights.publishes),
                                     std::pair(std::string("subscribe"), rights.subscribes)}) {
    const size_t begin = permissions.find("<" + verb + ">");
    const size_t end = permissions.find("</" + verb + ">");
    const std::string part =
        begin < end && end != std::string::npos ? permissions.substr(begin, end - begin) : "";
    for (const std::string& topic : topics) {
      if (part.find("<topic>" + topic + "</topic>") != std::string::npos) continue;
      throw RuntimeError(
          "'{}' does not let the role {} topic '{}', another version made it: make others with "
          "shoal secure init",
          file.string(), verb, topic);
    }
  }
}

}  // namespace shoal
