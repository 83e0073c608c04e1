// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/torch_file.h"

#include <gmock/gmock.h>

#include <string_view>

#include "launch/tools/export/zip_archive.h"
#include "tests/launch/tools/export/random_policy.h"

namespace shoal::launch {
namespace {

using std::string_view_literals::operator""sv;

// Output of python3 -m pickletools for a file of torch.save, without the memo.
TEST(TorchFile, IsAnArchiveOfAPickleAndItsStorages) {
  nn::TensorMap tensors;
  tensors["w"] = FloatTensor({1, 2, 3, 4, 5, 6});
  tensors["w"].shape = {3, 2};
  const std::string_view pickle =
      "\x80\2ccollections\nOrderedDict\n)R("
      "X\1\0\0\0w"
      "ctorch._utils\n_rebuild_tensor_v2\n("
      "(X\7\0\0\0storagectorch\nFloatStorage\nX\1\0\0\0"
      "0X\3\0\0\0cpuJ\6\0\0\0tQ"
      "J\0\0\0\0(J\3\0\0\0J\2\0\0\0t(J\2\0\0\0J\1\0\0\0t"
      "\x89"
      "ccollections\nOrderedDict\n)RtRu."sv;
  const std::vector<uint8_t>& data = tensors["w"].data;
  EXPECT_EQ(WriteTorchFile(tensors),
            WriteZip({{"archive/data.pkl", std::string(pickle)},
                      {"archive/version", "3\n"},
                      {"archive/byteorder", "little"},
                      {"archive/data/0", std::string(data.begin(), data.end())}}));
}

}  // namespace
}  // namespace shoal::launch
