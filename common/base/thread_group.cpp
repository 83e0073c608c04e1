// SPDX-License-Identifier: Apache-2.0
#include "common/base/thread_group.h"

namespace shoal {
namespace {

thread_local ThreadGroup* current_group = nullptr;

}  // namespace

ThreadGroup* ThreadGroup::Current() { return current_group; }

ThreadGroup::Member::Member(ThreadGroup* group) : former_(std::exchange(current_group, group)) {}

ThreadGroup::Member::~Member() { current_group = former_; }

}  // namespace shoal
