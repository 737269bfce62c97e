# Plug-ins take the program's own functions: the command exports them, and haptrial::plugin has the
# headers without the libraries (docs/decisions/0015-plug-ins-take-the-program.md).
function(haptrial_plugins)
  set(folder ${CMAKE_BINARY_DIR}/generated)
  set(header ${folder}/experiments/plugin/plugin_abi.h)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/core/*.h
       ${CMAKE_SOURCE_DIR}/protocols/*.h ${CMAKE_SOURCE_DIR}/analysis/*.h
       ${CMAKE_SOURCE_DIR}/experiments/*.h)
  set(script ${CMAKE_SOURCE_DIR}/cmake/plugin-abi.cmake)
  add_custom_command(OUTPUT ${header} DEPENDS ${headers} ${script} VERBATIM
                     COMMAND ${CMAKE_COMMAND} -DFOLDER=${CMAKE_SOURCE_DIR} -DOUT=${header}
                             -DVERSION=${PROJECT_VERSION} -P ${script})
  add_custom_target(haptrial_plugin_abi DEPENDS ${header})
  add_dependencies(haptrial_plugins haptrial_plugin_abi)
  target_include_directories(haptrial_plugins PUBLIC $<BUILD_INTERFACE:${folder}>)

  add_library(haptrial_plugin INTERFACE)
  set_target_properties(haptrial_plugin PROPERTIES EXPORT_NAME plugin)
  target_include_directories(haptrial_plugin INTERFACE $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>
                             $<BUILD_INTERFACE:${folder}> $<INSTALL_INTERFACE:include/haptrial>)
  target_compile_features(haptrial_plugin INTERFACE cxx_std_20)
  target_compile_options(haptrial_plugin INTERFACE -ffp-contract=off)
  target_compile_definitions(haptrial_plugin INTERFACE "$<INSTALL_INTERFACE:${HAPTRIAL_EIGEN}>")
  target_link_libraries(haptrial_plugin INTERFACE Eigen3::Eigen fmt::fmt)
  install(TARGETS haptrial_plugin EXPORT haptrial-targets COMPONENT development)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/haptrial/experiments/plugin
          COMPONENT development)

  set_target_properties(haptrial PROPERTIES ENABLE_EXPORTS ON)
endfunction()
