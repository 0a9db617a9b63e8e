# SPDX-License-Identifier: GPL-3.0-or-later
# Arguments: build_dir, source_dir, work_dir (made anew), config, generator, compiler, flags.
set(prefix ${work_dir}/prefix)
file(REMOVE_RECURSE ${work_dir})

function(run)
  message(STATUS "${ARGV}")
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${build_dir} --config ${config} --prefix ${prefix})

file(GLOB_RECURSE package_files ${prefix}/*.cmake)
if(NOT package_files)
  message(FATAL_ERROR "no CMake package in ${prefix}")
endif()
foreach(package_file IN LISTS package_files)
  file(READ ${package_file} content)
  foreach(private "shapemap_compiler_options" "nlohmann" "nanoflann" "${source_dir}")
    string(FIND "${content}" "${private}" position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${package_file} must not mention ${private}")
    endif()
  endforeach()
endforeach()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${work_dir}/consumer -G ${generator}
    -D CMAKE_BUILD_TYPE=${config} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_COMPILER=${compiler}
    "-DCMAKE_CXX_FLAGS=${flags}")
run(${CMAKE_COMMAND} --build ${work_dir}/consumer --config ${config})
run(${work_dir}/consumer/bin/consumer)
