# The headers of libraries that most files read, compiled once for the modules and twice for
# the tests, at both levels of optimisation. Every file still includes what it uses: HAPTRIAL_PRECOMPILED=OFF builds without them.
option(HAPTRIAL_PRECOMPILED "Precompile the headers of libraries (GCC)" ON)
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(HAPTRIAL_PRECOMPILED OFF)
endif()

set(HAPTRIAL_LIBRARY_HEADERS
    <algorithm> <array> <atomic> <charconv> <chrono> <cmath> <condition_variable> <cstdint> <cstring>
    <deque> <exception> <filesystem> <fstream> <functional> <limits> <map> <memory> <mutex> <numbers>
    <numeric> <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <system_error>
    <thread> <tuple> <unordered_map> <utility> <variant> <vector>
    <Eigen/Geometry> <fmt/format.h>)

# haptrial_precompile(TARGET KIND): TARGET's files begin with KIND's precompiled headers: modules,
# tests or core_tests. Targets of one kind must agree in all macros and options that these headers depend on.
function(haptrial_precompile target kind)
  if(HAPTRIAL_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM precompiled_${kind})
    cmake_language(EVAL CODE "cmake_language(DEFER CALL haptrial_skip_own_options ${target})")
  endif()
endfunction()

# A file with compiler options of its own, but for its level of optimisation, cannot
# begin with headers that were compiled without them.
function(haptrial_skip_own_options target)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    list(FILTER options EXCLUDE REGEX "NOTFOUND|-O[0-3]")
    if(options)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()

# haptrial_precompiled(KIND FOR FOLDER LIBRARIES ... HEADERS ...): makes what haptrial_precompile
# takes, at the level of optimisation of a folder.
function(haptrial_precompiled kind)
  cmake_parse_arguments(ARG "" "FOR" "LIBRARIES;HEADERS" ${ARGN})
  if(NOT HAPTRIAL_PRECOMPILED)
    return()
  endif()
  set(source ${CMAKE_BINARY_DIR}/precompiled_${kind}.cpp)  # a target needs one
  file(CONFIGURE OUTPUT ${source} CONTENT "\n")
  add_library(precompiled_${kind} OBJECT EXCLUDE_FROM_ALL ${source})
  target_compile_features(precompiled_${kind} PRIVATE cxx_std_20)
  target_link_libraries(precompiled_${kind} PRIVATE ${ARG_LIBRARIES})
  haptrial_optimise(precompiled_${kind} "${ARG_FOR}")  # __OPTIMIZE__ is one of the macros
  target_precompile_headers(precompiled_${kind} PRIVATE ${HAPTRIAL_LIBRARY_HEADERS} ${ARG_HEADERS})
endfunction()
