// SPDX-License-Identifier: Apache-2.0
// Reads an HDF5 file with the HDF5 library.
#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shoal::launch {

class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {
    EXPECT_GE(file_, 0) << path;
  }
  ~Hdf5Reader() { H5Fclose(file_); }
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  bool Has(const std::string& name) const {
    return H5Oexists_by_name(file_, name.c_str(), H5P_DEFAULT) > 0;
  }
  // Names of the members of the file's root, in alphabetical order.
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    const auto take = [](hid_t, const char* name, const H5L_info_t*, void* kept) -> herr_t {
      static_cast<std::vector<std::string>*>(kept)->emplace_back(name);
      return 0;
    };
    H5Literate(file_, H5_INDEX_NAME, H5_ITER_INC, nullptr, take, &names);
    return names;
  }

  struct Array {
    std::vector<uint64_t> shape;
    H5T_class_t kind = H5T_NO_CLASS;  // H5T_FLOAT, H5T_INTEGER, H5T_ENUM
    size_t bytes = 0;                 // size of an element
  };
  Array Describe(const std::string& name) const {
    const hid_t array = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    EXPECT_GE(array, 0) << name;
    const hid_t space = H5Dget_space(array), type = H5Dget_type(array);
    Array result{.shape = std::vector<uint64_t>(size_t(H5Sget_simple_extent_ndims(space))),
                 .kind = H5Tget_class(type),
                 .bytes = H5Tget_size(type)};
    std::vector<hsize_t> extent(result.shape.size());
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    result.shape.assign(extent.begin(), extent.end());
    H5Tclose(type), H5Sclose(space), H5Dclose(array);
    return result;
  }

  std::vector<float> Floats(const std::string& name) const {
    return Read<float>(name, H5T_NATIVE_FLOAT);
  }
  std::vector<uint8_t> Bytes(const std::string& name) const {
    return Read<uint8_t>(name, H5T_NATIVE_UINT8);
  }
  // The names of an enumeration's values: "FALSE", "TRUE".
  std::vector<std::string> Flags(const std::string& name) const {
    const hid_t array = H5Dopen2(file_, name.c_str(), H5P_DEFAULT), type = H5Dget_type(array);
    std::vector<std::string> names;
    for (const int8_t& value : Read<int8_t>(name, type)) {
      char text[16] = "";
      H5Tenum_nameof(type, &value, text, sizeof(text));
      names.emplace_back(text);
    }
    H5Tclose(type), H5Dclose(array);
    return names;
  }
  int64_t Attribute(const std::string& group, const std::string& name) const {
    const hid_t attribute =
        H5Aopen_by_name(file_, group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(attribute, 0) << group << " " << name;
    int64_t value = 0;
    H5Aread(attribute, H5T_NATIVE_INT64, &value);
    H5Aclose(attribute);
    return value;
  }

 private:
  template <class T>
  std::vector<T> Read(const std::string& name, hid_t type) const {
    size_t count = 1;
    for (const uint64_t extent : Describe(name).shape) count *= extent;
    std::vector<T> values(count);
    const hid_t array = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    EXPECT_GE(H5Dread(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Dclose(array);
    return values;
  }

  const hid_t file_;
};

}  // namespace shoal::launch
