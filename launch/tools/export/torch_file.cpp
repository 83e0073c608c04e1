// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/torch_file.h"

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "launch/tools/export/zip_archive.h"

namespace shoal::launch {
namespace {

// Writes the few opcodes that a dictionary of tensors takes.
class Pickler {
 public:
  Pickler() { text_ = "\x80\x02"; }  // PROTO 2

  void Global(std::string_view module, std::string_view name) {
    text_ += 'c';
    text_.append(module).append("\n").append(name).append("\n");
  }
  void Text(std::string_view text) {
    text_ += 'X';  // BINUNICODE
    PutWord(uint32_t(text.size()));
    text_ += text;
  }
  void Integer(int64_t value) {
    if (value < int64_t{1} << 31) {
      text_ += 'J';  // BININT
      PutWord(uint32_t(value));
      return;
    }
    text_ += "\x8a\x08";  // LONG1 of 8 bytes
    PutWord(uint32_t(value & 0xffffffff));
    PutWord(uint32_t(value >> 32));
  }
  void False() { text_ += '\x89'; }
  void Mark() { text_ += '('; }
  void Tuple() { text_ += 't'; }  // of the values since the mark
  void Call() { text_ += 'R'; }   // calls the function below the tuple on top
  void CallWithout() { text_ += ")R"; }
  void Persistent() { text_ += 'Q'; }  // the object that the tuple on top names
  void SetItems() { text_ += 'u'; }
  std::string Finish() { return std::move(text_) + '.'; }

 private:
  void PutWord(uint32_t word) {
    for (int i = 0; i < 4; ++i) text_ += char(word >> (8 * i) & 0xff);
  }

  std::string text_;
};

void PutOrderedDict(Pickler* pickler) {
  pickler->Global("collections", "OrderedDict");
  pickler->CallWithout();
}

void PutShape(const std::vector<int64_t>& sizes, Pickler* pickler) {
  pickler->Mark();
  for (const int64_t size : sizes) pickler->Integer(size);
  pickler->Tuple();
}

// _rebuild_tensor_v2(storage, storage_offset, size, stride, requires_grad, backward_hooks)
void PutTensor(const nn::NamedTensor& tensor, const std::string& storage, Pickler* pickler) {
  std::vector<int64_t> strides(tensor.shape.size(), 1);
  for (size_t i = strides.size(); i-- > 1;) strides[i - 1] = strides[i] * tensor.shape[i];
  pickler->Global("torch._utils", "_rebuild_tensor_v2");
  pickler->Mark();
  pickler->Mark();
  pickler->Text("storage");
  pickler->Global("torch", "FloatStorage");
  pickler->Text(storage);
  pickler->Text("cpu");
  pickler->Integer(int64_t(tensor.data.size() / sizeof(float)));
  pickler->Tuple();
  pickler->Persistent();
  pickler->Integer(0);
  PutShape(tensor.shape, pickler);
  PutShape(strides, pickler);
  pickler->False();
  PutOrderedDict(pickler);
  pickler->Tuple();
  pickler->Call();
}

}  // namespace

std::string WriteTorchFile(const nn::TensorMap& tensors) {
  std::vector<std::pair<std::string, std::string>> files{
      {"archive/data.pkl", ""}, {"archive/version", "3\n"}, {"archive/byteorder", "little"}};
  Pickler pickler;
  PutOrderedDict(&pickler);
  pickler.Mark();
  int storages = 0;
  for (const auto& [name, tensor] : tensors) {
    CHECK(tensor.dtype == "F32") << name << " is " << tensor.dtype;
    const std::string storage = std::to_string(storages++);
    pickler.Text(name);
    PutTensor(tensor, storage, &pickler);
    files.emplace_back("archive/data/" + storage,
                       std::string(tensor.data.begin(), tensor.data.end()));
  }
  pickler.SetItems();
  files[0].second = pickler.Finish();
  return WriteZip(files);
}

}  // namespace shoal::launch
