# find_package(touchdown): the exported targets and what they need again in the consumer's tree.
include(CMakePackageConfigHelpers)

set(TOUCHDOWN_CONFIG_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/touchdown")
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/touchdownConfig.cmake.in"
                              "${PROJECT_BINARY_DIR}/touchdownConfig.cmake"
                              INSTALL_DESTINATION "${TOUCHDOWN_CONFIG_DIR}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/touchdownConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/touchdownConfig.cmake"
              "${PROJECT_BINARY_DIR}/touchdownConfigVersion.cmake"
        DESTINATION "${TOUCHDOWN_CONFIG_DIR}")
install(EXPORT touchdownTargets NAMESPACE touchdown:: DESTINATION "${TOUCHDOWN_CONFIG_DIR}")
