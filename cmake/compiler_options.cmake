# SPDX-License-Identifier: GPL-3.0-or-later
# Warnings and sanitizers for our own targets: target_link_libraries(x PRIVATE shapemap_compiler_options).
add_library(shapemap_compiler_options INTERFACE)
target_compile_options(
  shapemap_compiler_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow
                                      -Wnon-virtual-dtor -Woverloaded-virtual)
# The same bits on every machine of one architecture: no fused multiply-add chosen by the compiler.
target_compile_options(shapemap_compiler_options INTERFACE -ffp-contract=off)
if(SHAPEMAP_WARNINGS_AS_ERRORS)
  target_compile_options(shapemap_compiler_options INTERFACE -Werror)
endif()
if(SHAPEMAP_SANITIZE)
  # For every target, ours or not: objects with and without a sanitizer must not share containers.
  add_compile_options(-fsanitize=${SHAPEMAP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SHAPEMAP_SANITIZE})
  # Checks at each access that make the build much longer; AddressSanitizer stops at most of what they would find.
  add_compile_options(-fno-sanitize=null,object-size,alignment)
  # Eigen aligns by itself what sanitizers allocate, and libraries that were built without them free it otherwise.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

find_program(SHAPEMAP_CCACHE ccache)
if(SHAPEMAP_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${SHAPEMAP_CCACHE})
endif()
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE RelWithDebInfo)
endif()
