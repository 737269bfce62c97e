# The headers of libraries that most files read, compiled once for each level of optimisation, of the
# modules and of the tests: those of another level would be taken, too, but cost more time.
# Every file still includes what it uses: HAPTRIAL_PRECOMPILED=OFF builds without them.
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

# haptrial_precompile(TARGET KIND FOLDER): TARGET's files begin with KIND's precompiled headers at
# FOLDER's level: modules or tests. Targets of one kind must agree in all macros and options that
# these headers depend on.
function(haptrial_precompile target kind folder)
  if(HAPTRIAL_PRECOMPILED)
    haptrial_level("${folder}" level)
    target_precompile_headers(${target} REUSE_FROM precompiled_${kind}_${level})
    cmake_language(EVAL CODE "cmake_language(DEFER CALL haptrial_skip_own_options ${target})")
  endif()
endfunction()

# A file with compiler options of its own, but for its level of optimisation, cannot
# begin with headers that were compiled without them.
function(haptrial_skip_own_options target)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    list(FILTER options EXCLUDE REGEX "NOTFOUND|-O[0-3s]")
    if(options)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()

# haptrial_precompiled(KIND FOLDERS ... LIBRARIES ... HEADERS ...): makes what haptrial_precompile
# takes, at the levels of these folders.
function(haptrial_precompiled kind)
  cmake_parse_arguments(ARG "" "" "FOLDERS;LIBRARIES;HEADERS" ${ARGN})
  if(NOT HAPTRIAL_PRECOMPILED)
    return()
  endif()
  foreach(folder ${ARG_FOLDERS})
    haptrial_level(${folder} level)
    set(target precompiled_${kind}_${level})
    set(source ${CMAKE_BINARY_DIR}/${target}.cpp)  # a target needs one
    file(CONFIGURE OUTPUT ${source} CONTENT "\n")
    add_library(${target} OBJECT EXCLUDE_FROM_ALL ${source})
    target_compile_features(${target} PRIVATE cxx_std_20)
    target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES})
    haptrial_optimise(${target} ${folder})
    target_precompile_headers(${target} PRIVATE ${HAPTRIAL_LIBRARY_HEADERS} ${ARG_HEADERS})
  endforeach()
endfunction()
