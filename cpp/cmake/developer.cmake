# wakeline_developer: how our own tests, examples, benchmarks and bindings are compiled. Never linked by users.
set(CMAKE_CXX_SCAN_FOR_MODULES OFF)  # there are none, and newer CMake would read each file twice

# ccache for anyone who has it, unless another launcher is given (-DCMAKE_CXX_COMPILER_LAUNCHER= gives none). The first
# setting is what precompiled headers ask for, the others let a second clone use what the first one has compiled. A build
# folder that began without it stays without, as it would compile everything again.
if(NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  if(NOT DEFINED WAKELINE_CCACHE)
    find_program(WAKELINE_CCACHE ccache)
    mark_as_advanced(WAKELINE_CCACHE)
  endif()
  if(WAKELINE_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
                                    CCACHE_NOHASHDIR=1 "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}" "${WAKELINE_CCACHE}")
  endif()
endif()
add_library(wakeline_developer INTERFACE)
target_link_libraries(wakeline_developer INTERFACE wakeline::wakeline)

# GCC notes that packs wider than a register pass as they did not in 2010; they are passed within a build alone.
set(WAKELINE_WARNING_FLAGS -Wall -Wextra -Wconversion -Wno-psabi)
if(WAKELINE_WARNINGS_AS_ERRORS)
  list(APPEND WAKELINE_WARNING_FLAGS -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(wakeline_developer INTERFACE ${WAKELINE_WARNING_FLAGS})
  if(WAKELINE_SANITIZE)
    set(WAKELINE_SANITIZE_FLAGS -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_compile_options(wakeline_developer INTERFACE ${WAKELINE_SANITIZE_FLAGS})
    target_link_options(wakeline_developer INTERFACE ${WAKELINE_SANITIZE_FLAGS})
  endif()
endif()

# wakeline_find(<package> <debian package> <option that asks for it>): find_package with an error one can act on.
macro(wakeline_find package debian_package option)
  find_package(${package} CONFIG QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR "${package} is missing: install it (Debian: ${debian_package}) or configure with -D${option}=OFF.")
  endif()
endmacro()
