# Every tests/benchmarks/NAME_bench.cpp becomes bench_NAME.
find_package(benchmark REQUIRED)
file(GLOB benchmarks CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/benchmarks/*_bench.cpp)
foreach(source ${benchmarks})
  get_filename_component(name ${source} NAME_WE)
  string(REGEX REPLACE "_bench$" "" name ${name})
  add_executable(bench_${name} ${source})
  target_link_libraries(bench_${name} PRIVATE haptrial_realtime haptrial_analysis fmt::fmt
                                              benchmark::benchmark Threads::Threads)
endforeach()
