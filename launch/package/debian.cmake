# SPDX-License-Identifier: Apache-2.0
# cpack -G DEB: a package of each component (./run package).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME shoal)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Shoal developers <shoal@example.org>")
set(CPACK_PACKAGE_VENDOR Shoal)
set(CPACK_COMPONENTS_ALL shoal libshoal-dev)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_RELEASE 0shoal1)  # not one of Debian's own
set(package_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

set(CPACK_DEBIAN_SHOAL_PACKAGE_NAME shoal)
set(CPACK_DEBIAN_SHOAL_PACKAGE_SECTION science)
# Programs, a font and a library that are found when they are asked for; no library names them.
set(CPACK_DEBIAN_SHOAL_PACKAGE_RECOMMENDS
  "libosmesa6, gnuplot-nox, fonts-dejavu-core, libjs-dygraphs")
set(CPACK_DEBIAN_SHOAL_PACKAGE_SUGGESTS "libshoal-dev, openssh-client")
set(CPACK_COMPONENT_SHOAL_DESCRIPTION
"distributed reinforcement learning from pixels
Trains robot policies by SAC, DrQ, TD3, DDPG and PPO, from 84x84 camera
pictures or from state. Actor processes step and render MuJoCo environments
and publish transitions over DDS to a replay server; a learner updates the
networks and broadcasts weights. One host or many; no GPU, no Python.")

set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_NAME libshoal-dev)
set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_DEPENDS
  "shoal (= ${package_version}), libmujoco-dev, libfmt-dev")
set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_SUGGESTS "cmake, g++")
set(CPACK_COMPONENT_LIBSHOAL-DEV_DESCRIPTION
"tasks of one's own for Shoal (development files)
Headers and a CMake package for shared objects that Shoal's programs load as
tasks. They fit the very version of Shoal that they are built with.")

# Files that Debian expects in every package: copyright, changelogs of the program and of its packaging.
# Equal commits give equal bytes: gzip's -n leaves the time out.
find_program(GZIP gzip REQUIRED)
execute_process(COMMAND git log -1 --format=%cD WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  OUTPUT_VARIABLE commit_time OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)  # no clone: an archive of the sources
  set(commit_time "Thu, 01 Jan 1970 00:00:00 +0000")
endif()
configure_file(changelog.Debian.in changelog.Debian @ONLY)
configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md changelog COPYONLY)
foreach(file changelog changelog.Debian)
  execute_process(COMMAND ${GZIP} -9nkf ${CMAKE_CURRENT_BINARY_DIR}/${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
foreach(package shoal libshoal-dev)
  install(FILES copyright third_party_notices.txt
    ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${package})
endforeach()

include(CPack)
