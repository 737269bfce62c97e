# libFuzzer targets: the readers with nothing else of the project, instrumented whole.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "HAPTRIAL_FUZZ needs clang; the compiler is ${CMAKE_CXX_COMPILER_ID}")
endif()
file(GLOB readers ${CMAKE_SOURCE_DIR}/core/geometry/files/read_*.cpp)
add_executable(fuzz_read_mesh ${CMAKE_SOURCE_DIR}/tests/fuzz/read_mesh_fuzz.cpp ${readers}
               ${CMAKE_SOURCE_DIR}/core/geometry/files/mesh_text.cpp
               ${CMAKE_SOURCE_DIR}/core/geometry/files/mesh_io.cpp
               ${CMAKE_SOURCE_DIR}/core/geometry/files/encode_mesh.cpp
               ${CMAKE_SOURCE_DIR}/core/base/whole_file.cpp)
target_include_directories(fuzz_read_mesh PRIVATE ${CMAKE_SOURCE_DIR})
target_link_libraries(fuzz_read_mesh PRIVATE Eigen3::Eigen fmt::fmt)
target_compile_options(fuzz_read_mesh PRIVATE -fsanitize=fuzzer,address,undefined -Wno-error)
target_link_options(fuzz_read_mesh PRIVATE -fsanitize=fuzzer,address,undefined)
