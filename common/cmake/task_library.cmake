# shoal_task_library(NAME FOLDER): NAME.so of FOLDER/goal.cpp and NAME_physics.so of the folder's
# other sources, which may look inside the engine (docs/own_task.md). Used by Shoal's own build and,
# installed, by a user's project; either sets
#   SHOAL_TASK_INCLUDE_DIR   where Shoal's headers lie
#   MUJOCO_INCLUDE_DIR, MUJOCO_LIBRARY
function(shoal_task_library name folder)
  get_filename_component(folder ${folder} ABSOLUTE)
  file(GLOB physics CONFIGURE_DEPENDS ${folder}/*.cpp)
  list(REMOVE_ITEM physics ${folder}/goal.cpp)
  if(NOT EXISTS ${folder}/goal.cpp OR NOT physics)
    message(FATAL_ERROR "'${folder}': expected goal.cpp and the sources of a physics half")
  endif()
  add_library(${name} MODULE ${folder}/goal.cpp)
  add_library(${name}_physics MODULE ${physics})
  target_include_directories(${name}_physics SYSTEM PRIVATE ${MUJOCO_INCLUDE_DIR})
  target_link_libraries(${name}_physics PRIVATE ${MUJOCO_LIBRARY})
  foreach(library ${name} ${name}_physics)
    target_compile_features(${library} PRIVATE cxx_std_20)
    target_include_directories(${library} PRIVATE ${SHOAL_TASK_INCLUDE_DIR} ${folder})
    target_link_libraries(${library} PRIVATE fmt::fmt)
    set_target_properties(${library} PROPERTIES PREFIX "")
    if(CMAKE_RUNTIME_OUTPUT_DIRECTORY)
      set_target_properties(${library} PROPERTIES
        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
    endif()
  endforeach()
endfunction()
