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
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/haptrial COMPONENT development)
    file(GLOB headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.h)
    install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/haptrial/${folder}
            COMPONENT development)
  endforeach()
  get_property(groups GLOBAL PROPERTY HAPTRIAL_GROUPS)
  foreach(name ${groups})
    set_target_properties(haptrial_${name} PROPERTIES EXPORT_NAME ${name})
    install(TARGETS haptrial_${name} EXPORT haptrial-targets COMPONENT development)
  endforeach()
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/haptrial)
  install(EXPORT haptrial-targets NAMESPACE haptrial:: DESTINATION ${package}
          COMPONENT development)
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/haptrial-config-version.cmake
                                   COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_SOURCE_DIR}/cmake/haptrial-config.cmake
                ${CMAKE_BINARY_DIR}/haptrial-config-version.cmake
          DESTINATION ${package} COMPONENT development)
  haptrial_package_texts(development libhaptrial-dev)
  haptrial_install_command()
endfunction()

# haptrial_package_texts(COMPONENT PACKAGE): what Debian wants each package to have in /usr/share/doc.
function(haptrial_package_texts component package)
  set(folder ${CMAKE_BINARY_DIR}/texts/${package})
  file(TIMESTAMP ${CMAKE_SOURCE_DIR}/CHANGELOG.md written "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(CONFIGURE OUTPUT ${folder}/changelog CONTENT
       "haptrial (${PROJECT_VERSION}) unstable; urgency=medium\n
  * Version ${PROJECT_VERSION}: see CHANGELOG.md of the source.\n
 -- ${CPACK_PACKAGE_CONTACT}  ${written}\n")
  execute_process(COMMAND gzip -9nf ${folder}/changelog)
  set(documents ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES ${folder}/changelog.gz DESTINATION ${documents} COMPONENT ${component})
  install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${documents} COMPONENT ${component}
          RENAME copyright)
endfunction()

# The command without its symbols, what is typed with it, and what is read about it. The manual is
# there once make-package.sh has written it.
function(haptrial_install_command)
  set(documents ${CMAKE_INSTALL_DOCDIR})
  install(CODE "set(CMAKE_INSTALL_DO_STRIP TRUE)" COMPONENT command)
  install(TARGETS haptrial RUNTIME COMPONENT command)
  file(GLOB definitions CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/experiments/*.toml)
  install(FILES ${definitions} DESTINATION ${documents}/experiments COMPONENT command)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs DESTINATION ${documents} COMPONENT command)
  install(FILES ${CMAKE_SOURCE_DIR}/README.md DESTINATION ${documents} COMPONENT command)
  haptrial_package_texts(command haptrial)
  install(FILES ${CMAKE_SOURCE_DIR}/experiments/completion.bash COMPONENT command
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME haptrial)
  install(FILES ${CMAKE_BINARY_DIR}/haptrial.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
          COMPONENT command OPTIONAL)
endfunction()
