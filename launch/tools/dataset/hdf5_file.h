// SPDX-License-Identifier: Apache-2.0
// Writes an HDF5 file: arrays in groups, whole numbers as attributes of groups.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace shoal::launch {

// The file has another name (PATH.tmp-PID) until Finish, and goes away where that is not called.
// The library's own messages are not shown: its reasons are in the errors. One thread: HDF5 as
// Debian builds it knows no others.
//
// Names of arrays are paths, "episode_0/observations/grip", whose groups are made where they are
// missing. Shapes are in rows, the first dimension counts them; values row-major. CHECK: shape and
// number of values agree. All of it throws Error naming the file and the reason.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path);
  ~Hdf5File();

  void Write(const std::string& name, const std::vector<uint64_t>& shape,
             std::span<const float> values);
  // Bytes are compressed, a row at a time: pictures that a reader takes one by one.
  void Write(const std::string& name, const std::vector<uint64_t>& shape,
             std::span<const uint8_t> values);
  // One-dimensional; 0 or 1 each. As h5py stores numpy's bool: an enumeration FALSE, TRUE of int8.
  void WriteFlags(const std::string& name, std::span<const uint8_t> values);
  void SetAttribute(const std::string& group, const std::string& name, int64_t value);

  // Completes the file and gives it its name. Once.
  void Finish();

 private:
  struct Library;

  std::unique_ptr<Library> library_;
};

}  // namespace shoal::launch
