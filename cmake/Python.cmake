# HAPTRIAL_PYTHON: the package `haptrial` for Python in build/python. analysis/python has the sources
# of the extension and, in its folder haptrial, what is written in Python.
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)  # Debian's, whose packages the module uses
endif()
find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 REQUIRED CONFIG)

# Symbols of the libraries stay inside, and of the shared ones only those that are used are loaded.
function(haptrial_python)
  set(package ${CMAKE_BINARY_DIR}/python/haptrial)
  file(MAKE_DIRECTORY ${package})
  Python3_add_library(haptrial_extension MODULE WITH_SOABI $<TARGET_OBJECTS:haptrial_python>)
  get_target_property(links haptrial_python LINK_LIBRARIES)
  target_link_libraries(haptrial_extension PRIVATE ${links})
  target_link_options(haptrial_extension PRIVATE LINKER:--exclude-libs,ALL LINKER:--gc-sections
                                                 LINKER:--as-needed)
  set_target_properties(haptrial_extension PROPERTIES OUTPUT_NAME _haptrial LINKER_LANGUAGE CXX
                                                      LIBRARY_OUTPUT_DIRECTORY ${package})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/analysis/python/haptrial/*)
  list(FILTER sources INCLUDE REGEX "[.](py|pyi|typed)$")
  set(copied ${CMAKE_BINARY_DIR}/python/copied)
  add_custom_command(OUTPUT ${copied} DEPENDS ${sources}
                     COMMAND ${CMAKE_COMMAND} -E copy_if_different ${sources} ${package}
                     COMMAND ${CMAKE_COMMAND} -E touch ${copied})
  add_custom_target(haptrial_python_files ALL DEPENDS ${copied})
  add_dependencies(haptrial_extension haptrial_python_files)
  set(installed lib/python3/dist-packages/haptrial)  # where Debian's Python looks below /usr
  install(TARGETS haptrial_extension LIBRARY DESTINATION ${installed} COMPONENT python)
  install(FILES ${sources} DESTINATION ${installed} COMPONENT python)
  haptrial_package_texts(python python3-haptrial)
endfunction()

# Each file of tests/analysis/python is an entry; its studies are simulated by the command.
function(haptrial_python_tests)
  file(GLOB tests CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/analysis/python/*_test.py)
  foreach(test ${tests})
    cmake_path(GET test STEM name)
    add_test(NAME python_${name} COMMAND ${Python3_EXECUTABLE} -B ${test})
    # The cost makes them begin first: one of them takes as long as hundreds of others.
    set_tests_properties(python_${name} PROPERTIES TIMEOUT 600 PROCESSORS 4 COST 100
      ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python;HAPTRIAL_COMMAND=$<TARGET_FILE:haptrial>")
  endforeach()
endfunction()
