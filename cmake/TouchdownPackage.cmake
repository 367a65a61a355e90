# The Debian package, by `cpack -G DEB` in any tree with the program and the Python package; ./deb.sh makes the one that is
# handed on. Files that only Debian's policy needs are in debian/.
install(FILES "${PROJECT_SOURCE_DIR}/cmake/debian/copyright" DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT debian EXCLUDE_FROM_ALL)
function(touchdown_install_changelog source name)
  set(packed "${PROJECT_BINARY_DIR}/${name}")
  execute_process(COMMAND gzip -9nc "${PROJECT_SOURCE_DIR}/${source}" OUTPUT_FILE "${packed}" COMMAND_ERROR_IS_FATAL ANY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${source}")
  install(FILES "${packed}" DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT debian EXCLUDE_FROM_ALL)
endfunction()
touchdown_install_changelog(CHANGELOG.md changelog.gz)
touchdown_install_changelog(cmake/debian/changelog changelog.Debian.gz)

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program python manual debian)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_PACKAGE_NAME touchdown)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
# What it depends on is of the distribution that it is made on.
cmake_host_system_information(RESULT distribution QUERY DISTRIB_INFO)
set(CPACK_DEBIAN_PACKAGE_RELEASE "1~${distribution_ID}${distribution_VERSION_ID}")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
# The maintainer is who entered the version in Debian's changelog.
file(STRINGS "${PROJECT_SOURCE_DIR}/cmake/debian/changelog" signature REGEX "^ -- " LIMIT_COUNT 1)
string(REGEX REPLACE "^ -- (.*>)  .*$" "\\1" CPACK_DEBIAN_PACKAGE_MAINTAINER "${signature}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "plans and flies landings of a quadrotor on a moving vehicle")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Touchdown plans landings of a quadrotor on a moving ground vehicle among
obstacles that are not known at take-off, as one optimisation problem that
ten solver backends can solve. It flies the plans in a simulation with
sensors, a filter, a map and contact, and judges every landing.
.
The package holds the program, the scenarios and studies that come with it,
and a package for Python.")

# The module is of one version of Python.
get_target_property(suffix touchdown_python SUFFIX)
string(REGEX REPLACE "^.*cpython-3([0-9]+).*$" "\\1" minor "${suffix}")
math(EXPR next "${minor} + 1")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "python3 (>= 3.${minor}), python3 (<< 3.${next}), python3-matplotlib, python3-numpy, python3-pandas")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-scipy, python3-statsmodels, python3-tqdm")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "ffmpeg")  # for videos alone, and 160 packages
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    "${PROJECT_SOURCE_DIR}/cmake/debian/postinst" "${PROJECT_SOURCE_DIR}/cmake/debian/prerm")
include(CPack)
