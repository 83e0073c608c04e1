# SPDX-License-Identifier: Apache-2.0
# shoal_environment_library(NAME SOURCES...): NAME.so with a user's environments in C++, which need
# no engine (docs/own_environment.md). Used by a user's project after find_package(Shoal), which sets
#   SHOAL_TASK_INCLUDE_DIR   folder of Shoal's headers
function(shoal_environment_library name)
  add_library(${name} MODULE ${ARGN})
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_include_directories(${name} PRIVATE ${SHOAL_TASK_INCLUDE_DIR})
  target_link_libraries(${name} PRIVATE fmt::fmt)
  set_target_properties(${name} PROPERTIES PREFIX "")
endfunction()
