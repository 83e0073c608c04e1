// SPDX-License-Identifier: Apache-2.0
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/credentials/credentials.h"
#include "common/credentials/openssl_objects.h"
#include "common/credentials/permission_documents.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using credentials::Buffer;
using credentials::Certificate;
using credentials::Content;
using credentials::Key;
using credentials::MakeBuffer;
using credentials::Require;

struct Identity {
  Key key;
  Certificate certificate;
};

Key MakeKey() {
  Key key(EVP_EC_gen("P-256"));
  Require(key != nullptr, "make a key");
  return key;
}

void AddExtension(X509* certificate, X509* issuer, int name, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, name, value);
  Require(extension != nullptr && X509_add_ext(certificate, extension, -1) == 1,
          "add an extension to a certificate");
  X509_EXTENSION_free(extension);
}

void SetSerialNumber(X509* certificate) {
  uint64_t number = 0;
  Require(RAND_bytes(reinterpret_cast<unsigned char*>(&number), sizeof number) == 1,
          "draw a serial number");
  Require(ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate), number >> 1) == 1,
          "set a serial number");
}

// Makes a certificate for CN=`name`, signed by `authority`, or by its own key if that is null.
Identity MakeIdentity(const std::string& name, const Identity* authority,
                      const Validity& validity) {
  Identity made{MakeKey(), Certificate(X509_new())};
  X509* certificate = made.certificate.get();
  Require(certificate != nullptr && X509_set_version(certificate, X509_VERSION_3) == 1,
          "make a certificate");
  SetSerialNumber(certificate);
  X509_NAME* subject = X509_get_subject_name(certificate);
  Require(X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                                     reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1,
                                     0) == 1,
          "name a certificate");
  X509* issuer = authority != nullptr ? authority->certificate.get() : certificate;
  Require(X509_set_issuer_name(certificate, X509_get_subject_name(issuer)) == 1 &&
              ASN1_TIME_set(X509_getm_notBefore(certificate), validity.from) != nullptr &&
              ASN1_TIME_set(X509_getm_notAfter(certificate), validity.until) != nullptr &&
              X509_set_pubkey(certificate, made.key.get()) == 1,
          "fill a certificate");
  AddExtension(certificate, issuer, NID_basic_constraints,
               authority != nullptr ? "critical,CA:FALSE" : "critical,CA:TRUE");
  EVP_PKEY* signer = authority != nullptr ? authority->key.get() : made.key.get();
  Require(X509_sign(certificate, signer, EVP_sha256()) > 0, "sign a certificate");
  return made;
}

void WriteIdentity(const Identity& identity, const fs::path& folder, const std::string& name) {
  const Buffer certificate = MakeBuffer(), key = MakeBuffer();
  Require(PEM_write_bio_X509(certificate.get(), identity.certificate.get()) == 1 &&
              PEM_write_bio_PrivateKey(key.get(), identity.key.get(), nullptr, nullptr, 0, nullptr,
                                       nullptr) == 1,
          "write a key and its certificate");
  WriteFilePrivately(folder / (name + ".pem"), Content(certificate));
  WriteFilePrivately(folder / (name + ".key"), Content(key));
}

// Writes the document in S/MIME, signed by the authority.
void WriteSigned(const std::string& document, const Identity& authority, const fs::path& file) {
  const int flags = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM;
  const Buffer text = MakeBuffer(document), result = MakeBuffer();
  const credentials::Signed signature(
      PKCS7_sign(authority.certificate.get(), authority.key.get(), nullptr, text.get(), flags));
  Require(signature != nullptr, "sign a document");
  Require(SMIME_write_PKCS7(result.get(), signature.get(), text.get(), flags) == 1,
          "write a signed document");
  WriteFilePrivately(file, Content(result));
}

// A folder that is filled under a temporary name and gets its own name when it is complete.
class NewFolder {
 public:
  explicit NewFolder(fs::path path) : path_(std::move(path)), made_(path_.string() + ".new") {
    if (fs::exists(path_)) {
      throw UsageError("'{}' exists: it is not overwritten; choose another folder", path_.string());
    }
    if (path_.has_parent_path()) MakeFolders(path_.parent_path());
    if (mkdir(made_.c_str(), 0700) != 0) {
      throw RuntimeError("cannot create folder '{}': {}", made_.string(), std::strerror(errno));
    }
  }
  ~NewFolder() {
    std::error_code error;
    if (!complete_) fs::remove_all(made_, error);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  const fs::path& path() const { return made_; }
  void Complete() {
    std::error_code error;
    fs::rename(made_, path_, error);
    if (error) throw RuntimeError("cannot create '{}': {}", path_.string(), error.message());
    complete_ = true;
  }

 private:
  const fs::path path_, made_;
  bool complete_ = false;
};

}  // namespace

Validity ValidForDays(int days) {
  constexpr std::time_t kDay = 24 * 60 * 60;
  const std::time_t now = std::time(nullptr);
  return {.from = now - kDay, .until = now + days * kDay};
}

void CreateCredentials(const fs::path& folder, std::span<const RoleRights> roles,
                       const Validity& validity) {
  NewFolder made(folder);
  const Identity authority = MakeIdentity("shoal-ca", nullptr, validity);
  WriteIdentity(authority, made.path(), "ca");
  WriteSigned(credentials::GovernanceDocument(), authority, made.path() / "governance.p7s");
  for (const RoleRights& rights : roles) {
    const std::string name = "shoal-" + rights.role;
    WriteIdentity(MakeIdentity(name, &authority, validity), made.path(), rights.role);
    WriteSigned(credentials::PermissionsDocument(rights, name, validity), authority,
                made.path() / (rights.role + ".p7s"));
  }
  made.Complete();
}

}  // namespace shoal
