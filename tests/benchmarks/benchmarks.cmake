# Every tests/benchmarks/NAME_bench.cpp becomes bench_NAME.
find_package(embree 3 QUIET)
file(GLOB benchmarks CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/benchmarks/*_bench.cpp)
foreach(source ${benchmarks})
  get_filename_component(name ${source} NAME_WE)
  string(REGEX REPLACE "_bench$" "" name ${name})
  add_executable(bench_${name} ${source})
  target_compile_options(bench_${name} PRIVATE -Wno-restrict)  # GCC 12 sees overlaps that cannot be
  # These build without the rest.
  if(name STREQUAL scene)
    target_link_libraries(bench_scene PRIVATE haptrial_scene)
    continue()
  elseif(name STREQUAL contact)
    target_link_libraries(bench_contact PRIVATE haptrial_contact haptrial_geometry_files)
    if(embree_FOUND)
      target_link_libraries(bench_contact PRIVATE embree)
      target_compile_definitions(bench_contact PRIVATE HAPTRIAL_EMBREE)
    endif()
    continue()
  elseif(name MATCHES "^springs")
    target_link_libraries(bench_${name} PRIVATE haptrial_deformable haptrial_document)
    continue()
  elseif(name STREQUAL elements)
    target_link_libraries(bench_elements PRIVATE haptrial_deformable)
    continue()
  elseif(name STREQUAL touch)
    target_link_libraries(bench_touch PRIVATE haptrial_deformable)
    continue()
  elseif(name STREQUAL text)
    target_link_libraries(bench_text PRIVATE haptrial_render_flat)
    continue()
  elseif(name MATCHES "^(psychometric|procedure|threshold)")
    target_link_libraries(bench_${name} PRIVATE haptrial_psychometric haptrial_psychometric_models)
    continue()
  endif()
  if(name STREQUAL hierarchical)
    target_sources(bench_hierarchical
                   PRIVATE ${CMAKE_SOURCE_DIR}/tests/analysis/psychometric/hierarchical/hierarchical_study.cpp)
    target_link_libraries(bench_hierarchical PRIVATE haptrial_psychometric_hierarchical fmt::fmt PkgConfig::gsl)
    continue()
  endif()
  if(name STREQUAL device_certificate)
    target_sources(bench_device_certificate
                   PRIVATE ${CMAKE_SOURCE_DIR}/tests/analysis/device/device_coverage.cpp
                           ${CMAKE_SOURCE_DIR}/tests/analysis/device/simulated_certificate.cpp)
    target_link_libraries(bench_device_certificate PRIVATE haptrial_device_analysis)
    continue()
  endif()
  if(name STREQUAL null_trials)
    target_sources(bench_null_trials
                   PRIVATE ${CMAKE_SOURCE_DIR}/tests/analysis/psychophysics/simulated_trials.cpp
                           ${CMAKE_SOURCE_DIR}/tests/analysis/psychophysics/study/null_cues.cpp
                           ${CMAKE_SOURCE_DIR}/tests/analysis/psychophysics/study/null_trials.cpp
                           ${CMAKE_SOURCE_DIR}/tests/analysis/psychophysics/study/simulated_cues.cpp
                           ${CMAKE_SOURCE_DIR}/tests/analysis/psychophysics/study/simulated_reaches.cpp)
    target_link_libraries(bench_null_trials PRIVATE haptrial_psychophysics_study haptrial_record_hdf5
                                                    PkgConfig::gsl)
    continue()
  endif()
  target_link_libraries(bench_${name} PRIVATE haptrial_command_line fmt::fmt Threads::Threads)
endforeach()
target_sources(bench_servo PRIVATE ${CMAKE_SOURCE_DIR}/tests/experiments/timed_session.cpp
                                   ${CMAKE_SOURCE_DIR}/tests/experiments/shipped.cpp
                                   ${CMAKE_SOURCE_DIR}/tests/support/temporary_folder.cpp)
target_sources(bench_procedure_coverage
               PRIVATE ${CMAKE_SOURCE_DIR}/tests/analysis/psychometric/fit/coverage_grid.cpp
                       ${CMAKE_SOURCE_DIR}/tests/analysis/psychometric/fit/procedure_study.cpp
                       ${CMAKE_SOURCE_DIR}/tests/analysis/psychometric/fit/surface_counts.cpp)
target_link_libraries(bench_procedure_coverage PRIVATE haptrial_psychometric_fit PkgConfig::gsl)
target_sources(bench_null_reports PRIVATE ${CMAKE_SOURCE_DIR}/tests/analysis/force_training/study/null_reports.cpp)
target_sources(bench_null_relabelled
               PRIVATE ${CMAKE_SOURCE_DIR}/tests/analysis/force_training/report/null_comparisons.cpp
                       ${CMAKE_SOURCE_DIR}/tests/analysis/bone_drilling/report/null_validity.cpp)
target_compile_definitions(bench_servo PRIVATE HAPTRIAL_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
target_compile_definitions(bench_responses PRIVATE HAPTRIAL_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
target_compile_definitions(bench_mesh PRIVATE HAPTRIAL_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
# bench_distance compares with those of its peers that are installed.
if(embree_FOUND)
  target_link_libraries(bench_distance PRIVATE embree)
  target_compile_definitions(bench_distance PRIVATE HAPTRIAL_EMBREE)
endif()
find_path(CGAL_HEADERS CGAL/AABB_tree.h)
if(CGAL_HEADERS)
  target_compile_definitions(bench_distance PRIVATE HAPTRIAL_CGAL)
endif()
# bench_bone compares with OpenVDB where that is installed.
find_path(OPENVDB_HEADERS openvdb/openvdb.h)
find_package(TBB QUIET)
find_package(Imath QUIET)
if(OPENVDB_HEADERS AND TBB_FOUND AND Imath_FOUND)
  target_link_libraries(bench_bone PRIVATE openvdb TBB::tbb Imath::Imath)
  target_compile_definitions(bench_bone PRIVATE HAPTRIAL_OPENVDB)
endif()
# What distance_study and others compare with.
file(GLOB references CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/support/references/*.cpp)
foreach(name distance_study bone feel_study)
  target_sources(bench_${name} PRIVATE ${references})
endforeach()
