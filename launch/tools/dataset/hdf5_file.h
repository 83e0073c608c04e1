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

// The file has a temporary name (PATH.tmp-PID) until Finish; without Finish the destructor removes
// the file. Messages of the HDF5 library are not printed; errors contain its reasons. One thread:
// Debian's build of HDF5 is not thread-safe.
//
// Names of arrays are paths, such as "episode_0/observations/grip"; missing groups are created. The
// first dimension of a shape counts the rows; values are row-major. CHECK: the number of values
// matches the shape. Every member throws Error naming the file and the reason.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path);
  ~Hdf5File();

  void Write(const std::string& name, const std::vector<uint64_t>& shape,
             std::span<const float> values);
  // Compresses the bytes row by row, because readers take pictures one at a time.
  void Write(const std::string& name, const std::vector<uint64_t>& shape,
             std::span<const uint8_t> values);
  // Writes a one-dimensional array of flags, 0 or 1 each, as h5py stores numpy's bool: an int8
  // enumeration FALSE, TRUE.
  void WriteFlags(const std::string& name, std::span<const uint8_t> values);
  void SetAttribute(const std::string& group, const std::string& name, int64_t value);

  // Completes the file and renames it to its final name. Call once.
  void Finish();

 private:
  struct Library;

  std::unique_ptr<Library> library_;
};

}  // namespace shoal::launch
