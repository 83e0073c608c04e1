// SPDX-License-Identifier: Apache-2.0
/* Acts by a policy that Shoal has trained: a C library without DDS, MuJoCo or OSMesa.
 *
 *   shoal_policy* policy;
 *   if (shoal_policy_load("runs/NAME/checkpoints/best", &policy) != SHOAL_POLICY_OK) {
 *     fprintf(stderr, "%s\n", shoal_policy_error());
 *   }
 *
 * Actions are those of an evaluation, without exploration: the same observation gives the same
 * action. Everything is computed in f32 on the calling thread.
 *
 * Dimensions: N observations of a batch, K frames of a stack, C channels of a frame (3 for each
 * colour camera, 1 for each grey camera, camera after camera), (H, W) height and width of a frame,
 * A actions. Arrays are row-major and without gaps.
 *
 * Ownership: the caller that loaded a policy owns the policy and must call shoal_policy_free.
 * Arrays and names that are passed to a function are borrowed for the call; strings that a function
 * returns belong to the policy.
 *
 * Threads: only one thread at a time may use a policy; policies are independent of each other.
 *
 * Errors: a function that fails returns a status other than SHOAL_POLICY_OK, and
 * shoal_policy_error() returns one line with the error and the expectation. The library does not
 * print and does not end the process, and no C++ exception leaves the library. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SHOAL_POLICY_API __attribute__((visibility("default")))

typedef enum shoal_policy_status {
  SHOAL_POLICY_OK = 0,
  SHOAL_POLICY_BAD_CHECKPOINT = 1, /* missing, damaged, of another version or too new */
  SHOAL_POLICY_BAD_ARGUMENT = 2,   /* NULL, or an observation that does not fit the policy */
  SHOAL_POLICY_NOT_FINITE = 3,     /* a NaN or an infinity, in a block or in the policy's output */
  SHOAL_POLICY_FAILED = 4          /* no memory, or an internal error */
} shoal_policy_status;

typedef struct shoal_policy shoal_policy;

/* Message of the latest failed call of this thread; "" before the first failure. Valid until the
 * next failed call of this thread. */
SHOAL_POLICY_API const char* shoal_policy_error(void);

/* Version of the library: "0.1.0". */
SHOAL_POLICY_API const char* shoal_policy_version(void);

/* Loads a checkpoint folder, which need not be in a run's folder: reads and verifies its
 * state.json, policy.json and policy.safetensors. On success, the caller must free *policy;
 * otherwise *policy is NULL. The first shoal_policy_act takes no longer than later calls. */
SHOAL_POLICY_API shoal_policy_status shoal_policy_load(const char* checkpoint,
                                                       shoal_policy** policy);

/* Frees a policy. NULL is allowed. */
SHOAL_POLICY_API void shoal_policy_free(shoal_policy* policy);

/* In the functions below, `policy` must not be NULL. */

/* Task and algorithm of the policy's training: "FetchReachDense", "sac". */
SHOAL_POLICY_API const char* shoal_policy_task(const shoal_policy* policy);
SHOAL_POLICY_API const char* shoal_policy_algorithm(const shoal_policy* policy);

/* Number of actions, A. */
SHOAL_POLICY_API size_t shoal_policy_action_size(const shoal_policy* policy);

/* Shape of the pixels of one observation; all 0 for a policy without pixels. */
typedef struct shoal_policy_shape {
  size_t stack;    /* K */
  size_t channels; /* C of one frame */
  size_t height, width;
} shoal_policy_shape;
SHOAL_POLICY_API shoal_policy_shape shoal_policy_pixels(const shoal_policy* policy);

/* G: 1 if the policy observes a goal picture, which is one more frame after the stack; else 0. */
SHOAL_POLICY_API size_t shoal_policy_goal_pictures(const shoal_policy* policy);

/* Number and names of the cameras, in the order of a frame's channels. The name is NULL if `index`
 * >= the count. */
SHOAL_POLICY_API size_t shoal_policy_camera_count(const shoal_policy* policy);
SHOAL_POLICY_API const char* shoal_policy_camera_name(const shoal_policy* policy, size_t index);

/* Number, names and sizes of the blocks of numbers that the policy observes in addition to the
 * pixels ("grip", "desired_goal"). If `index` >= the count, the name is NULL and the size is 0. */
SHOAL_POLICY_API size_t shoal_policy_block_count(const shoal_policy* policy);
SHOAL_POLICY_API const char* shoal_policy_block_name(const shoal_policy* policy, size_t index);
SHOAL_POLICY_API size_t shoal_policy_block_size(const shoal_policy* policy, size_t index);

/* A block of N observations. */
typedef struct shoal_policy_block {
  const char* name;
  const float* values; /* (N, size of the block), in the task's own units */
  size_t count;        /* floats in `values` */
} shoal_policy_block;

typedef struct shoal_policy_observations {
  size_t count; /* N, at least 1 */
  /* (N, (K+G)*C, H, W), 0..255, row 0 = top, RGB. The frames of a stack are ordered, oldest first;
   * at an episode's start, the first frame is repeated K times. The goal picture is last. For a
   * policy without pixels, `pixels` is NULL and `pixel_count` is 0. */
  const uint8_t* pixels;
  size_t pixel_count; /* bytes in `pixels` */
  /* All blocks that the policy observes, in any order, and no other blocks. */
  const shoal_policy_block* blocks;
  size_t block_count;
} shoal_policy_observations;

/* Writes actions (N, A), each number in [-1, 1]. `action_count`: size of `actions` in floats, N*A.
 * The other observations of the batch can change an action only in the last digits of f32. If this
 * function fails, do not use `actions`, which may be partly written. */
SHOAL_POLICY_API shoal_policy_status shoal_policy_act(shoal_policy* policy,
                                                      const shoal_policy_observations* observations,
                                                      float* actions, size_t action_count);

#ifdef __cplusplus
}
#endif
