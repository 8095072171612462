# Installs into one prefix and moves the result to another, so that whatever is tested afterwards is relocated.
file(REMOVE_RECURSE "${PREFIX}" "${PREFIX}-first")
execute_process(
  COMMAND "${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${PREFIX}-first" --config "${CONFIG}"
  RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "cmake --install failed")
endif()
file(RENAME "${PREFIX}-first" "${PREFIX}")
