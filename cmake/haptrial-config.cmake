# find_package(haptrial): targets haptrial::NAME, one for each module (docs/architecture.md), such
# as haptrial::geometry_bvh.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(Boost 1.74)
find_dependency(Threads)
find_dependency(PNG)
find_dependency(meshoptimizer)
find_dependency(SUNDIALS)
find_dependency(PkgConfig)
foreach(library hdf5:hdf5-serial gsl:gsl freetype:freetype2 glfw:glfw3
                libdeflate:libdeflate tomlplusplus:tomlplusplus httplib:cpp-httplib
                sndfile:sndfile alsa:alsa muparser:muparser pangoft2:pangoft2
                nlopt:nlopt sodium:libsodium)
  string(REPLACE ":" ";" library ${library})
  list(GET library 0 name)
  list(GET library 1 package)
  if(NOT TARGET PkgConfig::${name})
    pkg_check_modules(${name} REQUIRED IMPORTED_TARGET ${package})
  endif()
endforeach()
include(${CMAKE_CURRENT_LIST_DIR}/haptrial-targets.cmake)
