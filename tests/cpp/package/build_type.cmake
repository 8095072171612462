# find_package says once that nothing is optimised without a build type, and nothing with one.
foreach(build_type IN ITEMS "" Release)
  file(REMOVE_RECURSE "${BUILD_DIR}")
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -S "${CONSUMER}" -B "${BUILD_DIR}" "-DCMAKE_CXX_COMPILER=${COMPILER}" -DCMAKE_CXX_FLAGS=
            "-DCMAKE_BUILD_TYPE=${build_type}" "-DCMAKE_PREFIX_PATH=${PREFIX}" "-DEigen3_DIR=${EIGEN_DIR}"
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "the consumer cannot be configured:\n${output}")
  endif()
  string(REGEX MATCHALL "configure with -DCMAKE_BUILD_TYPE=Release" notices "${output}")
  list(LENGTH notices count)
  if(build_type STREQUAL "" AND NOT count EQUAL 1)
    message(FATAL_ERROR "without a build type there are ${count} notices instead of one:\n${output}")
  elseif(build_type STREQUAL "Release" AND NOT count EQUAL 0)
    message(FATAL_ERROR "a build type is set, but there is a notice:\n${output}")
  endif()
endforeach()
