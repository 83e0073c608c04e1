// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/dataset/hdf5_file.h"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <numeric>
#include <string_view>
#include <utility>

#include "common/base/check.h"
#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal::launch {
namespace {

constexpr unsigned kCompression = 1;  // deflate level, 1 to 9: level 1 shrinks pictures tenfold

// Reason of a failed call: the system's, if there is one ("No space left on device"), else the
// message of the library's innermost function.
std::string Reason() {
  std::string reason;
  const auto take = [](unsigned, const H5E_error2_t* error, void* kept) -> herr_t {
    *static_cast<std::string*>(kept) = error->desc == nullptr ? "" : error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, take, &reason);
  constexpr std::string_view kSystem = "error message = '";
  if (const size_t at = reason.find(kSystem); at != std::string::npos) {
    reason = reason.substr(at + kSystem.size());
    reason = reason.substr(0, reason.find('\''));
  }
  return reason.empty() ? "the HDF5 library gives no reason" : reason;
}

// An identifier of the library and the function that closes it.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept { *this = std::move(other); }
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { Close(); }

  hid_t get() const { return id_; }
  bool Close() {
    const hid_t id = std::exchange(id_, H5I_INVALID_HID);
    return id < 0 || close_(id) >= 0;
  }

 private:
  hid_t id_ = H5I_INVALID_HID;
  herr_t (*close_)(hid_t) = nullptr;
};

}  // namespace

struct Hdf5File::Library {
  explicit Library(std::filesystem::path final_path)
      : path(std::move(final_path)), temporary(path.string() + ".tmp-" + std::to_string(getpid())) {
    // Otherwise the library would try to write to a full disk once more at the program's end.
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    links = Own(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    Require(H5Pset_create_intermediate_group(links.get(), 1));
    flag = Own(H5Tenum_create(H5T_NATIVE_INT8), H5Tclose);
    for (const auto& [name, value] :
         {std::pair("FALSE", int8_t{0}), std::pair("TRUE", int8_t{1})}) {
      Require(H5Tenum_insert(flag.get(), name, &value));
    }
    const Handle access = Own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    // Groups of a few names need a tenth of the bytes that they need in older formats.
    Require(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V18, H5F_LIBVER_LATEST));
    file = Own(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  }
  ~Library() {
    file.Close();
    if (!finished) std::remove(temporary.c_str());
  }

  [[noreturn]] void Fail(const std::string& reason) const {
    throw RuntimeError("cannot write '{}': {}", path.string(), reason);
  }
  void Require(herr_t result) const {
    if (result < 0) Fail(Reason());
  }
  Handle Own(hid_t id, herr_t (*close)(hid_t)) const {
    if (id < 0) Fail(Reason());
    return {id, close};
  }

  void Write(const std::string& name, const std::vector<uint64_t>& shape, hid_t type,
             const Handle& creation, const void* values) const {
    const std::vector<hsize_t> extent(shape.begin(), shape.end());
    const Handle space =
        Own(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
    Handle array = Own(H5Dcreate2(file.get(), name.c_str(), type, space.get(), links.get(),
                                  creation.get(), H5P_DEFAULT),
                       H5Dclose);
    Require(H5Dwrite(array.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
    if (!array.Close()) Fail(Reason());  // closing writes the compressed bytes
  }

  const std::filesystem::path path, temporary;
  Handle links, flag, file;
  bool finished = false;
};

namespace {

void CheckCount(const std::vector<uint64_t>& shape, size_t values) {
  CHECK(!shape.empty());
  CHECK(std::accumulate(shape.begin(), shape.end(), uint64_t{1}, std::multiplies()) == values);
}

}  // namespace

Hdf5File::Hdf5File(const std::filesystem::path& path) : library_(std::make_unique<Library>(path)) {}

Hdf5File::~Hdf5File() = default;

void Hdf5File::Write(const std::string& name, const std::vector<uint64_t>& shape,
                     std::span<const float> values) {
  CheckCount(shape, values.size());
  const Handle creation = library_->Own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  library_->Write(name, shape, H5T_NATIVE_FLOAT, creation, values.data());
}

void Hdf5File::Write(const std::string& name, const std::vector<uint64_t>& shape,
                     std::span<const uint8_t> values) {
  CheckCount(shape, values.size());
  std::vector<hsize_t> row(shape.begin(), shape.end());
  row[0] = 1;
  const Handle creation = library_->Own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  library_->Require(H5Pset_chunk(creation.get(), static_cast<int>(row.size()), row.data()));
  library_->Require(H5Pset_deflate(creation.get(), kCompression));
  library_->Write(name, shape, H5T_NATIVE_UINT8, creation, values.data());
}

void Hdf5File::WriteFlags(const std::string& name, std::span<const uint8_t> values) {
  const Handle creation = library_->Own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  library_->Write(name, {values.size()}, library_->flag.get(), creation, values.data());
}

void Hdf5File::SetAttribute(const std::string& group, const std::string& name, int64_t value) {
  const Handle owner =
      library_->Own(H5Oopen(library_->file.get(), group.c_str(), H5P_DEFAULT), H5Oclose);
  const Handle space = library_->Own(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute = library_->Own(H5Acreate2(owner.get(), name.c_str(), H5T_NATIVE_INT64,
                                                    space.get(), H5P_DEFAULT, H5P_DEFAULT),
                                         H5Aclose);
  library_->Require(H5Awrite(attribute.get(), H5T_NATIVE_INT64, &value));
}

void Hdf5File::Finish() {
  if (!library_->file.Close()) library_->Fail(Reason());
  const auto check = [&](bool done) {
    if (!done) library_->Fail(std::strerror(errno));
  };
  const Descriptor descriptor(open(library_->temporary.c_str(), O_RDONLY | O_CLOEXEC));
  check(descriptor.get() >= 0 && fsync(descriptor.get()) == 0);
  OpenToOthers(library_->temporary);
  check(std::rename(library_->temporary.c_str(), library_->path.c_str()) == 0);
  library_->finished = true;
  SyncFolder(library_->path.has_parent_path() ? library_->path.parent_path() : ".");
}

}  // namespace shoal::launch
