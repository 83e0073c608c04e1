// The same in C++: acts by a checkpoint on the observation of its standard input (the pixels'
// bytes, then the blocks' floats in the order of shoal_policy_block_name) and prints the action.
//
//   act_cpp CHECKPOINT < OBSERVATION
#include <shoal_policy.h>

#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <vector>

static void Check(shoal_policy_status status) {
  if (status != SHOAL_POLICY_OK) throw std::runtime_error(shoal_policy_error());
}

template <class T>
static std::vector<T> ReadInput(size_t count) {
  std::vector<T> values(count);
  std::cin.read(reinterpret_cast<char*>(values.data()), std::streamsize(count * sizeof(T)));
  if (!std::cin) throw std::runtime_error("too short an observation");
  return values;
}

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("expected one argument, a checkpoint folder");
  shoal_policy* loaded = nullptr;
  Check(shoal_policy_load(argv[1], &loaded));
  const std::unique_ptr<shoal_policy, decltype(&shoal_policy_free)> policy(loaded,
                                                                           shoal_policy_free);

  const auto [stack, channels, height, width] = shoal_policy_pixels(loaded);
  const auto pixels = ReadInput<uint8_t>(stack * channels * height * width);
  std::vector<std::vector<float>> values;
  std::vector<shoal_policy_block> blocks;
  for (size_t i = 0; i < shoal_policy_block_count(loaded); ++i) {
    values.push_back(ReadInput<float>(shoal_policy_block_size(loaded, i)));
    blocks.push_back({shoal_policy_block_name(loaded, i), values[i].data(), values[i].size()});
  }
  std::vector<float> action(shoal_policy_action_size(loaded));
  const shoal_policy_observations seen{1, pixels.data(), pixels.size(), blocks.data(),
                                       blocks.size()};
  Check(shoal_policy_act(loaded, &seen, action.data(), action.size()));
  for (const float a : action) std::printf("%.9g\n", a);
} catch (const std::exception& e) {
  std::cerr << "act_cpp: " << e.what() << "\n";
  return 1;
}
