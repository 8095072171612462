# Headers and CMake package. Header-only: one package serves every architecture, and every path in it is relative.
include(CMakePackageConfigHelpers)

set(WAKELINE_PACKAGE_DIR "${CMAKE_INSTALL_DATADIR}/cmake/wakeline")

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cpp/cmake/config.cmake.in" "${PROJECT_BINARY_DIR}/package/wakeline-config.cmake"
  INSTALL_DESTINATION "${WAKELINE_PACKAGE_DIR}"
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(
  "${PROJECT_BINARY_DIR}/package/wakeline-config-version.cmake"
  COMPATIBILITY SameMinorVersion
  ARCH_INDEPENDENT)

install(DIRECTORY "${PROJECT_SOURCE_DIR}/cpp/include/wakeline" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
        COMPONENT development FILES_MATCHING PATTERN "*.hpp")
install(TARGETS wakeline EXPORT wakeline-targets)
install(EXPORT wakeline-targets NAMESPACE wakeline:: DESTINATION "${WAKELINE_PACKAGE_DIR}" COMPONENT development)
install(FILES "${PROJECT_BINARY_DIR}/package/wakeline-config.cmake"
              "${PROJECT_BINARY_DIR}/package/wakeline-config-version.cmake"
        DESTINATION "${WAKELINE_PACKAGE_DIR}" COMPONENT development)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/wakeline"
        COMPONENT development)
