# SPDX-License-Identifier: Apache-2.0
# shoal_task_library(NAME FOLDER): NAME.so of FOLDER/goal.cpp and NAME_physics.so of the folder's
# other sources, which may look inside the engine (docs/own_task.md); NAME_python.so and
# NAME_python_physics.so, the same for the Python package. FOLDER/model, if it exists, is copied next
# to them, for WorldOptions::Beside("model/..."). Used by Shoal's own build and, installed, by a
# user's project. Both set
#   SHOAL_TASK_INCLUDE_DIR   folder of Shoal's headers
#   MUJOCO_INCLUDE_DIR, MUJOCO_LIBRARY

# A task finds the symbols that it uses in the program that loads it. Python hides the symbols of its
# modules: libraries for it need the module by its soname (launch/tools/python), and the loader takes the
# module that is loaded. An empty library stands in for the module when they are linked.
function(shoal_python_module_stand_in)
  if(TARGET shoal_python_module)
    return()
  endif()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/shoal_python_module.cpp CONTENT "")
  add_library(shoal_python_module SHARED ${PROJECT_BINARY_DIR}/shoal_python_module.cpp)
  set_target_properties(shoal_python_module PROPERTIES
    PREFIX "" OUTPUT_NAME shoal_rl_native LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/CMakeFiles)
endfunction()

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
  shoal_python_module_stand_in()
  add_library(${name}_python MODULE $<TARGET_OBJECTS:${name}>)
  add_library(${name}_python_physics MODULE $<TARGET_OBJECTS:${name}_physics>)
  target_link_libraries(${name}_python_physics PRIVATE ${MUJOCO_LIBRARY})
  foreach(library ${name}_python ${name}_python_physics)
    target_link_options(${library} PRIVATE
      LINKER:--no-as-needed $<TARGET_FILE:shoal_python_module> LINKER:--as-needed)
    add_dependencies(${library} shoal_python_module)
    set_target_properties(${library} PROPERTIES LINKER_LANGUAGE CXX)
  endforeach()
  if(EXISTS ${folder}/model)
    file(GLOB_RECURSE models CONFIGURE_DEPENDS ${folder}/model/*)
    set(copied ${CMAKE_CURRENT_BINARY_DIR}/${name}_model.stamp)
    add_custom_command(OUTPUT ${copied}
      COMMAND ${CMAKE_COMMAND} -E copy_directory
              ${folder}/model $<TARGET_FILE_DIR:${name}_physics>/model
      COMMAND ${CMAKE_COMMAND} -E touch ${copied}
      DEPENDS ${models} VERBATIM)
    add_custom_target(${name}_model ALL DEPENDS ${copied})
    add_dependencies(${name}_physics ${name}_model)
  endif()
  foreach(library ${name} ${name}_physics)
    target_compile_features(${library} PRIVATE cxx_std_20)
    target_include_directories(${library} PRIVATE ${SHOAL_TASK_INCLUDE_DIR} ${folder})
  endforeach()
  foreach(library ${name} ${name}_physics ${name}_python ${name}_python_physics)
    target_link_libraries(${library} PRIVATE fmt::fmt)
    set_target_properties(${library} PROPERTIES PREFIX "")
    if(CMAKE_RUNTIME_OUTPUT_DIRECTORY)
      set_target_properties(${library} PROPERTIES
        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
    endif()
  endforeach()
endfunction()
