// SPDX-License-Identifier: Apache-2.0
// Owning pointers to OpenSSL's objects. Internal to common/credentials.
#pragma once

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace shoal::credentials {

template <auto kFree>
struct Free {
  template <class T>
  void operator()(T* object) const {
    kFree(object);
  }
};

inline void FreeList(STACK_OF(X509) * list) { sk_X509_free(list); }

using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using Signed = std::unique_ptr<PKCS7, Free<PKCS7_free>>;
// Owns the list but not the certificates in the list.
using Signers = std::unique_ptr<STACK_OF(X509), Free<FreeList>>;
using Buffer = std::unique_ptr<BIO, Free<BIO_free_all>>;

// Returns the text of the oldest error in OpenSSL's queue for this thread. Clears the queue.
std::string OpensslReason();
// If `good` is false, throws Error "cannot WHAT: REASON" with OpenSSL's reason.
void Require(bool good, std::string_view what);

Buffer MakeBuffer(std::string_view content = "");
std::string Content(const Buffer& buffer);

// These functions read a certificate or a private key from a PEM file. They throw Error naming the
// file.
Certificate ReadCertificate(const std::filesystem::path& file);
Key ReadKey(const std::filesystem::path& file);

}  // namespace shoal::credentials
