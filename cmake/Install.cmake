# cmake --install: the command, and every module as a library that others take with
# find_package(haptrial). Headers keep their folders: #include <core/geometry/bvh/bvh.h>.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

function(haptrial_install)
  get_property(modules GLOBAL PROPERTY HAPTRIAL_MODULES)
  foreach(name ${modules})
    get_property(folder GLOBAL PROPERTY HAPTRIAL_FOLDER_${name})
    set_target_properties(haptrial_${name} PROPERTIES EXPORT_NAME ${name})
    install(TARGETS haptrial_${name} EXPORT haptrial-targets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/haptrial)
    file(GLOB headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.h)
    install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/haptrial/${folder})
  endforeach()
  get_property(groups GLOBAL PROPERTY HAPTRIAL_GROUPS)
  foreach(name ${groups})
    set_target_properties(haptrial_${name} PROPERTIES EXPORT_NAME ${name})
    install(TARGETS haptrial_${name} EXPORT haptrial-targets)
  endforeach()
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/haptrial)
  install(EXPORT haptrial-targets NAMESPACE haptrial:: DESTINATION ${package})
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/haptrial-config-version.cmake
                                   COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_SOURCE_DIR}/cmake/haptrial-config.cmake
                ${CMAKE_BINARY_DIR}/haptrial-config-version.cmake
          DESTINATION ${package})
  install(CODE "set(CMAKE_INSTALL_DO_STRIP TRUE)")  # the command without its symbols
  install(TARGETS haptrial RUNTIME)
endfunction()
