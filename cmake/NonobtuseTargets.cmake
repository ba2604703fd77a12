# What every target of the project has in common, and the choice of the thread backend.

# Compile options of all our targets: the same bits everywhere (no fused multiply-add behind our
# back, no reordering) and strict warnings.
function(nonobtuse_target target)
  target_compile_options(${target} PRIVATE -ffp-contract=off
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow $<$<BOOL:${NONOBTUSE_WERROR}>:-Werror>)
endfunction()

# Sets NONOBTUSE_BACKEND (tbb, threads, serial) and the libraries it needs from NONOBTUSE_PARALLEL.
macro(nonobtuse_choose_backend)
  if(NOT NONOBTUSE_PARALLEL MATCHES "^(auto|tbb|threads|serial)$")
    message(FATAL_ERROR "NONOBTUSE_PARALLEL is '${NONOBTUSE_PARALLEL}'; it must be auto, tbb, threads or serial")
  endif()
  set(NONOBTUSE_BACKEND ${NONOBTUSE_PARALLEL})
  if(NONOBTUSE_PARALLEL STREQUAL "auto")
    find_package(TBB QUIET)
    if(TBB_FOUND)
      set(NONOBTUSE_BACKEND tbb)
    else()
      set(NONOBTUSE_BACKEND threads)
    endif()
  elseif(NONOBTUSE_PARALLEL STREQUAL "tbb")
    find_package(TBB REQUIRED)
  endif()
  set(NONOBTUSE_BACKEND_LIBRARIES)
  if(NOT NONOBTUSE_BACKEND STREQUAL "serial")
    find_package(Threads REQUIRED)
    set(NONOBTUSE_BACKEND_LIBRARIES Threads::Threads)
  endif()
  if(NONOBTUSE_BACKEND STREQUAL "tbb")
    list(APPEND NONOBTUSE_BACKEND_LIBRARIES TBB::tbb)
  endif()
  message(STATUS "nonobtuse ${PROJECT_VERSION}: thread backend ${NONOBTUSE_BACKEND}")
endmacro()
