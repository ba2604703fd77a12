# Builds and runs the project in consumer/ against the library, the way `way` says:
# find_package: installed from `build` into a scratch prefix, examples/cpp too; add_subdirectory:
# from `source`.
cmake_minimum_required(VERSION 3.22)

function(step)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nfailed (${result}):\n${output}")
  endif()
  message("${output}")
endfunction()

file(REMOVE_RECURSE ${scratch})
set(arguments -G ${generator} -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_CXX_FLAGS=${flags}
  -D CMAKE_CXX_COMPILER_LAUNCHER=${launcher})
if(way STREQUAL "find_package")
  step(${CMAKE_COMMAND} --install ${build} --prefix ${scratch}/prefix)
  list(APPEND arguments -D CMAKE_PREFIX_PATH=${scratch}/prefix -D CMAKE_BUILD_TYPE=Release)
else()
  # The whole library is compiled again, only to see that it is found: out of the compiler cache
  # with the options of the presets, without optimisation where there is no cache.
  list(APPEND arguments -D NONOBTUSE_SOURCE=${source})
  if(launcher)
    list(APPEND arguments -D CMAKE_BUILD_TYPE=Release "-D CMAKE_CXX_FLAGS_RELEASE=-O3 -DNDEBUG"
      -D NONOBTUSE_WERROR=ON)
  else()
    list(APPEND arguments -D CMAKE_BUILD_TYPE=Debug -D CMAKE_CXX_FLAGS_DEBUG=-O0)
  endif()
endif()
step(${CMAKE_COMMAND} -S ${source}/tests/house/consumer -B ${scratch}/build ${arguments})
step(${CMAKE_COMMAND} --build ${scratch}/build --target consumer)
step(${scratch}/build/consumer)
# The example for users of the installed package.
if(way STREQUAL "find_package")
  step(${CMAKE_COMMAND} -S ${source}/examples/cpp -B ${scratch}/example ${arguments})
  step(${CMAKE_COMMAND} --build ${scratch}/example)
  step(${scratch}/example/transfer)
endif()
