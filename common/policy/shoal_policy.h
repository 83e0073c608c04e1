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
 * colour camera, 1 for each grey one, camera after camera), H, W, A actions. Arrays are row-major
 * and without gaps.
 *
 * Ownership: the caller that loaded a policy owns it, until shoal_policy_free. Arrays and names
 * that are passed in are borrowed for the call; strings that are returned belong to the policy.
 * Threads: one thread at a time for each policy; policies are independent of each other.
 * Errors: a function that can fail returns a status other than SHOAL_POLICY_OK, and
 * shoal_policy_error() says in one line what was wrong and what was expected. Nothing is printed,
 * nothing ends the process, and no C++ exception leaves the library. */
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
  SHOAL_POLICY_FAILED = 4          /* memory, or what should not happen */
} shoal_policy_status;

typedef struct shoal_policy shoal_policy;

/* Message of this thread's latest call that failed; "" before any failure. Valid until this
 * thread's next call that fails. */
SHOAL_POLICY_API const char* shoal_policy_error(void);

/* Version of the library: "0.1.0". */
SHOAL_POLICY_API const char* shoal_policy_version(void);

/* Loads a checkpoint folder from any place: reads and verifies its state.json, policy.json and
 * policy.safetensors. On success, the caller must free *policy; otherwise *policy is NULL. The
 * first action takes no longer than later ones. */
SHOAL_POLICY_API shoal_policy_status shoal_policy_load(const char* checkpoint,
                                                       shoal_policy** policy);

/* NULL is allowed. */
SHOAL_POLICY_API void shoal_policy_free(shoal_policy* policy);

/* The functions below need a loaded policy, not NULL. */

/* Task and algorithm of the policy's training: "FetchReachDense", "sac". */
SHOAL_POLICY_API const char* shoal_policy_task(const shoal_policy* policy);
SHOAL_POLICY_API const char* shoal_policy_algorithm(const shoal_policy* policy);

/* A. */
SHOAL_POLICY_API size_t shoal_policy_action_size(const shoal_policy* policy);

/* Shape of the pixels of one observation; all 0 for a policy without pixels. */
typedef struct shoal_policy_shape {
  size_t stack;    /* K */
  size_t channels; /* C of one frame */
  size_t height, width;
} shoal_policy_shape;
SHOAL_POLICY_API shoal_policy_shape shoal_policy_pixels(const shoal_policy* policy);

/* G: 1 for a policy that observes a picture of its reached goal, which is one more frame after the
 * stack; else 0. */
SHOAL_POLICY_API size_t shoal_policy_goal_pictures(const shoal_policy* policy);

/* The cameras in the order of a frame's channels. The name is NULL if `index` >= the count. */
SHOAL_POLICY_API size_t shoal_policy_camera_count(const shoal_policy* policy);
SHOAL_POLICY_API const char* shoal_policy_camera_name(const shoal_policy* policy, size_t index);

/* The blocks of numbers that the policy observes besides the pixels ("grip", "desired_goal"), and
 * the size of each. Name and size are NULL and 0 if `index` >= the count. */
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
  /* (N, (K+G)*C, H, W), 0..255, row 0 = top, RGB. The frames of a stack are in order, oldest first;
   * at an episode's start, the first frame is repeated K times; the goal's frame is last. NULL and
   * 0 for a policy without pixels. */
  const uint8_t* pixels;
  size_t pixel_count; /* bytes in `pixels` */
  /* All blocks that the policy observes, in any order, and no other blocks. */
  const shoal_policy_block* blocks;
  size_t block_count;
} shoal_policy_observations;

/* Writes actions (N, A), each number in [-1, 1]; `action_count`: the floats that `actions` has room
 * for, N*A. Other observations of the batch change an action by f32's last digits at most. If this
 * function fails, do not use `actions`, which may be partly written. */
SHOAL_POLICY_API shoal_policy_status shoal_policy_act(shoal_policy* policy,
                                                      const shoal_policy_observations* observations,
                                                      float* actions, size_t action_count);

#ifdef __cplusplus
}
#endif
