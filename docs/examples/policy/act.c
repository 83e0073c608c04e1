/* Acts by a checkpoint on the observation of its standard input (the pixels' bytes, then the
 * blocks' floats in the order of shoal_policy_block_name) and prints the action, a number a line.
 *
 *   act_c CHECKPOINT < OBSERVATION */
#include <shoal_policy.h>
#include <stdio.h>
#include <stdlib.h>

static void fail(const char* what) {
  fprintf(stderr, "act_c: %s\n", what);
  exit(1);
}

static void* read_input(size_t count, size_t size) {
  void* memory = calloc(count + 1, size);
  if (memory == NULL || fread(memory, size, count, stdin) != count)
    fail("too short an observation");
  return memory;
}

int main(int argc, char** argv) {
  shoal_policy* policy;
  if (argc != 2) fail("expected one argument, a checkpoint folder");
  if (shoal_policy_load(argv[1], &policy) != SHOAL_POLICY_OK) fail(shoal_policy_error());

  shoal_policy_shape shape = shoal_policy_pixels(policy);
  shoal_policy_observations seen = {.count = 1, .block_count = shoal_policy_block_count(policy)};
  seen.pixel_count = shape.stack * shape.channels * shape.height * shape.width;
  seen.pixels = read_input(seen.pixel_count, 1);
  shoal_policy_block* blocks = calloc(seen.block_count + 1, sizeof *blocks);
  for (size_t i = 0; i < seen.block_count; ++i) {
    blocks[i].name = shoal_policy_block_name(policy, i);
    blocks[i].count = shoal_policy_block_size(policy, i);
    blocks[i].values = read_input(blocks[i].count, sizeof(float));
  }
  seen.blocks = blocks;

  size_t size = shoal_policy_action_size(policy);
  float* action = calloc(size, sizeof *action);
  if (shoal_policy_act(policy, &seen, action, size) != SHOAL_POLICY_OK) fail(shoal_policy_error());
  for (size_t i = 0; i < size; ++i) printf("%.9g\n", action[i]);
  shoal_policy_free(policy); /* what was read goes with the program */
}
