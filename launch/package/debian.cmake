# cpack -G DEB: a package of each component (./run package).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME shoal)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Shoal developers <shoal@localhost>")
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

set(CPACK_DEBIAN_SHOAL_PACKAGE_NAME shoal)
set(CPACK_DEBIAN_SHOAL_PACKAGE_SECTION science)
# Programs and a font that are found when they are asked for; no library names them.
set(CPACK_DEBIAN_SHOAL_PACKAGE_RECOMMENDS "gnuplot-nox, fonts-dejavu-core")
set(CPACK_DEBIAN_SHOAL_PACKAGE_SUGGESTS "libshoal-dev, openssh-client")
set(CPACK_COMPONENT_SHOAL_DESCRIPTION
"distributed reinforcement learning from pixels
 Trains robot policies by SAC, DrQ, TD3, DDPG and PPO, from 84x84 camera
 pictures or from state. Actor processes step and render MuJoCo environments,
 publish transitions over DDS to a replay server, a learner updates the networks
 and broadcasts weights. One host or many, no GPU and no Python needed.")

set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_NAME libshoal-dev)
set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_DEPENDS
  "shoal (= ${PROJECT_VERSION}), libmujoco-dev, libfmt-dev")
set(CPACK_DEBIAN_LIBSHOAL-DEV_PACKAGE_SUGGESTS "cmake, g++")
set(CPACK_COMPONENT_LIBSHOAL-DEV_DESCRIPTION
"tasks of one's own for Shoal (development files)
 Headers and a CMake package for shared objects that Shoal's programs load as
 tasks. They fit the very version of Shoal that they are built with.")

# What Debian expects of every package. The same bytes from the same changelog: -n leaves the time out.
find_program(GZIP gzip REQUIRED)
execute_process(COMMAND ${GZIP} -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  OUTPUT_FILE ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
foreach(package shoal libshoal-dev)
  set(doc ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES copyright DESTINATION ${doc} COMPONENT ${package})
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz DESTINATION ${doc} COMPONENT ${package})
  install(FILES lintian-overrides/${package} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
    COMPONENT ${package})
endforeach()
include(CPack)
