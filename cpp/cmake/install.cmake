# Headers, CMake package and, where it is built, the compiled tracker. Every path in the package is relative; without the
# tracker it serves every architecture.
include(CMakePackageConfigHelpers)

set(WAKELINE_PACKAGE_DIR "${CMAKE_INSTALL_DATADIR}/cmake/wakeline")

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cpp/cmake/config.cmake.in" "${PROJECT_BINARY_DIR}/package/wakeline-config.cmake"
  INSTALL_DESTINATION "${WAKELINE_PACKAGE_DIR}"
  NO_SET_AND_CHECK_MACRO)
if(WAKELINE_TRACKER)
  set(WAKELINE_ARCHITECTURE "")
else()
  set(WAKELINE_ARCHITECTURE ARCH_INDEPENDENT)
endif()
write_basic_package_version_file(
  "${PROJECT_BINARY_DIR}/package/wakeline-config-version.cmake"
  COMPATIBILITY SameMinorVersion
  ${WAKELINE_ARCHITECTURE})

install(DIRECTORY "${PROJECT_SOURCE_DIR}/cpp/include/wakeline" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
        COMPONENT development FILES_MATCHING PATTERN "*.hpp")
install(TARGETS wakeline EXPORT wakeline-targets)
install(EXPORT wakeline-targets NAMESPACE wakeline:: DESTINATION "${WAKELINE_PACKAGE_DIR}" COMPONENT development)
if(WAKELINE_TRACKER)
  install(TARGETS wakeline_tracker EXPORT wakeline-tracker-targets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
          COMPONENT development)
  install(EXPORT wakeline-tracker-targets NAMESPACE wakeline:: DESTINATION "${WAKELINE_PACKAGE_DIR}"
          COMPONENT development)
endif()
install(FILES "${PROJECT_BINARY_DIR}/package/wakeline-config.cmake"
              "${PROJECT_BINARY_DIR}/package/wakeline-config-version.cmake"
        DESTINATION "${WAKELINE_PACKAGE_DIR}" COMPONENT development)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/wakeline"
        COMPONENT development)
