# Every tests/benchmarks/NAME_bench.cpp becomes bench_NAME.
file(GLOB benchmarks CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/benchmarks/*_bench.cpp)
foreach(source ${benchmarks})
  get_filename_component(name ${source} NAME_WE)
  string(REGEX REPLACE "_bench$" "" name ${name})
  add_executable(bench_${name} ${source})
  target_link_libraries(bench_${name} PRIVATE haptrial_experiments fmt::fmt Threads::Threads)
endforeach()
target_sources(bench_servo PRIVATE ${CMAKE_SOURCE_DIR}/tests/experiments/timed_session.cpp
                                   ${CMAKE_SOURCE_DIR}/tests/experiments/shipped.cpp
                                   ${CMAKE_SOURCE_DIR}/tests/support/temporary_folder.cpp)
target_compile_definitions(bench_servo PRIVATE HAPTRIAL_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
