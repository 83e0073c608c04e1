// SPDX-License-Identifier: Apache-2.0
#include "common/credentials/openssl_objects.h"

#include <openssl/err.h>
#include <openssl/pem.h>

#include <array>

#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal::credentials {

std::string OpensslReason() {
  const unsigned long code = ERR_get_error();
  ERR_clear_error();
  if (code == 0) return "no reason given";
  const char* reason = ERR_reason_error_string(code);
  return reason != nullptr ? reason : fmt::format("OpenSSL error {:x}", code);
}

void Require(bool good, std::string_view what) {
  if (!good) throw RuntimeError("cannot {}: {}", what, OpensslReason());
}

Buffer MakeBuffer(std::string_view content) {
  Buffer buffer(BIO_new(BIO_s_mem()));
  Require(buffer != nullptr, "make a buffer");
  if (!content.empty()) {
    const int size = static_cast<int>(content.size());
    Require(BIO_write(buffer.get(), content.data(), size) == size, "fill a buffer");
  }
  return buffer;
}

std::string Content(const Buffer& buffer) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(buffer.get(), &data);
  return size > 0 ? std::string(data, static_cast<size_t>(size)) : std::string();
}

Certificate ReadCertificate(const std::filesystem::path& file) {
  const Buffer text = MakeBuffer(ReadFile(file));
  Certificate certificate(PEM_read_bio_X509(text.get(), nullptr, nullptr, nullptr));
  if (certificate == nullptr) {
    throw RuntimeError("'{}' is not a certificate in PEM: {}", file.string(), OpensslReason());
  }
  return certificate;
}

Key ReadKey(const std::filesystem::path& file) {
  const Buffer text = MakeBuffer(ReadFile(file));
  // Never asks for a pass phrase, because no terminal may be attached.
  const auto no_phrase = [](char*, int, int, void*) { return -1; };
  Key key(PEM_read_bio_PrivateKey(text.get(), nullptr, no_phrase, nullptr));
  if (key == nullptr) {
    throw RuntimeError("'{}' is not a private key in PEM without a pass phrase: {}", file.string(),
                       OpensslReason());
  }
  return key;
}

}  // namespace shoal::credentials
