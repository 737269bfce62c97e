# haptrial_unite(TARGET SOURCE...): with HAPTRIAL_UNITY the compiler reads a folder as one file, which
# takes two thirds of the time. Kernels for an instruction set stay alone: their options are a file's.
function(haptrial_unite target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${HAPTRIAL_UNITY} UNITY_BUILD_BATCH_SIZE 0)
  list(FILTER ARGN INCLUDE REGEX "(baseline|avx2|avx512)[.]cpp$")
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# haptrial_unite_tests(TARGET SOURCE...): the same for tests, at most sixteen files as one, whatever
# their folder: most have few, and each begins with the same templates.
function(haptrial_unite_tests target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${HAPTRIAL_UNITY} UNITY_BUILD_MODE GROUP)
  set(files 0)
  foreach(source ${ARGN})
    math(EXPR part "${files} / 16")
    math(EXPR files "${files} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP part_${part})
  endforeach()
endfunction()

# haptrial_module(NAME FOLDER LINKS ... USES ...): every source in FOLDER becomes haptrial_NAME.
function(haptrial_module name folder)
  cmake_parse_arguments(ARG "" "" "LINKS;USES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  if(NOT sources)
    message(FATAL_ERROR "module ${name}: no sources in ${folder}")
  endif()
  add_library(haptrial_${name} STATIC ${sources})
  target_include_directories(haptrial_${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>
                                                     $<INSTALL_INTERFACE:include/haptrial>)
  target_compile_features(haptrial_${name} PUBLIC cxx_std_20)
  foreach(link ${ARG_LINKS})
    if(link MATCHES "::")
      target_link_libraries(haptrial_${name} PUBLIC ${link})
    else()
      target_link_libraries(haptrial_${name} PUBLIC haptrial_${link})
    endif()
  endforeach()
  target_link_libraries(haptrial_${name} PRIVATE ${ARG_USES})
  haptrial_precompile(haptrial_${name} modules ${folder})
  haptrial_optimise(haptrial_${name} ${folder})
  haptrial_unite(haptrial_${name} ${sources})
  set_property(GLOBAL APPEND PROPERTY HAPTRIAL_MODULES ${name})
  set_property(GLOBAL PROPERTY HAPTRIAL_FOLDER_${name} ${folder})
endfunction()

# haptrial_group(NAME FOLDER LINKS ...): haptrial_NAME stands for the modules below FOLDER, which has
# no source of its own, and test_NAME has the tests of all of them.
function(haptrial_group name folder)
  cmake_parse_arguments(ARG "" "" "LINKS" ${ARGN})
  add_library(haptrial_${name} INTERFACE)
  list(TRANSFORM ARG_LINKS PREPEND haptrial_)
  target_link_libraries(haptrial_${name} INTERFACE ${ARG_LINKS})
  set_property(GLOBAL APPEND PROPERTY HAPTRIAL_GROUPS ${name})
  set_property(GLOBAL PROPERTY HAPTRIAL_FOLDER_${name} ${folder})
endfunction()

# The command: build/haptrial. It knows the commit that it was built from.
function(haptrial_command)
  execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} rev-parse --short=12 HEAD
                  OUTPUT_VARIABLE HAPTRIAL_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT HAPTRIAL_COMMIT)
    set(HAPTRIAL_COMMIT unknown)
  endif()
  if(EXISTS ${CMAKE_SOURCE_DIR}/.git/logs/HEAD)
    set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
                 ${CMAKE_SOURCE_DIR}/.git/logs/HEAD)
  endif()
  configure_file(${CMAKE_SOURCE_DIR}/cmake/version.cpp.in ${CMAKE_BINARY_DIR}/version.cpp @ONLY)
  target_sources(haptrial_runner PRIVATE ${CMAKE_BINARY_DIR}/version.cpp)
  add_executable(haptrial ${CMAKE_SOURCE_DIR}/experiments/main.cpp)
  target_link_libraries(haptrial PRIVATE haptrial_command_line)
  haptrial_precompile(haptrial modules experiments)
  haptrial_optimise(haptrial experiments)
  set_target_properties(haptrial PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
endfunction()

# Shared libraries with the symbols of the vendors' ones, in the build folder.
function(haptrial_stand_ins)
  set(support ${CMAKE_SOURCE_DIR}/tests/support)
  add_library(stand_in_dhd SHARED ${support}/stand_in_dhd.cpp ${support}/stand_in_drd.cpp)
  add_library(stand_in_dhd_only SHARED ${support}/stand_in_dhd.cpp)
  add_library(stand_in_hd SHARED ${support}/stand_in_hd.cpp)
  add_library(stand_in_lsl SHARED ${support}/stand_in_lsl.cpp)
  add_library(stand_in_espeak SHARED ${support}/stand_in_espeak.cpp)
  foreach(name stand_in_dhd stand_in_dhd_only stand_in_hd stand_in_lsl stand_in_espeak)
    target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
    target_link_libraries(${name} PRIVATE Threads::Threads)
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  endforeach()
endfunction()

# haptrial_page(MODULE FILE FUNCTION HEADER): a page is built in, as what FUNCTION() of HEADER returns.
# PART:NAME in it stands for the text of the style sheet or script NAME beside it.
function(haptrial_page module file HAPTRIAL_PAGE_FUNCTION HAPTRIAL_PAGE_HEADER)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${file})
  file(READ ${CMAKE_SOURCE_DIR}/${file} HAPTRIAL_PAGE_HTML)
  cmake_path(GET file PARENT_PATH folder)
  string(REGEX MATCHALL "PART:[a-z_]+[.](css|js)" parts "${HAPTRIAL_PAGE_HTML}")
  foreach(part ${parts})
    string(REPLACE "PART:" "${CMAKE_SOURCE_DIR}/${folder}/" part_file ${part})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${part_file})
    file(READ ${part_file} text)
    string(REPLACE "${part}" "${text}" HAPTRIAL_PAGE_HTML "${HAPTRIAL_PAGE_HTML}")
  endforeach()
  cmake_path(GET file STEM name)
  set(built ${CMAKE_BINARY_DIR}/${name}_page.cpp)
  configure_file(${CMAKE_SOURCE_DIR}/cmake/page.cpp.in ${built} @ONLY)
  target_sources(haptrial_${module} PRIVATE ${built})
endfunction()

# So are the shipped definitions, which a new one may begin from.
function(haptrial_examples)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/experiments/*.toml)
  list(FILTER files EXCLUDE REGEX "[.]texts[.]")
  set(HAPTRIAL_EXAMPLES "")
  foreach(file ${files})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    cmake_path(GET file STEM name)
    file(READ ${file} text)
    string(APPEND HAPTRIAL_EXAMPLES "      Example{\"${name}\", R\"toml(${text})toml\"},\n")
  endforeach()
  configure_file(${CMAKE_SOURCE_DIR}/cmake/examples.cpp.in ${CMAKE_BINARY_DIR}/examples.cpp @ONLY)
  target_sources(haptrial_command_start PRIVATE ${CMAKE_BINARY_DIR}/examples.cpp)
endfunction()

# haptrial_test(NAME LINK SOURCE...): test_NAME, which the test runner finds.
function(haptrial_test name link)
  add_executable(test_${name} ${ARGN})
  target_link_libraries(test_${name} PRIVATE haptrial_${link} haptrial_test_support GTest::gmock
                                             GTest::gtest GTest::gtest_main)
  list(GET ARGN 0 folder)
  cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${CMAKE_SOURCE_DIR})
  haptrial_optimise(test_${name} ${folder})
  haptrial_precompile(test_${name} tests ${folder})
  haptrial_unite_tests(test_${name} ${ARGN})
  # The allocation guard sees malloc of our objects too (Eigen calls it directly); it is linked
  # also where no test names it.
  target_link_options(test_${name} PRIVATE LINKER:--undefined=__wrap_malloc
    LINKER:--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=aligned_alloc,--wrap=posix_memalign)
  target_compile_definitions(test_${name} PRIVATE HAPTRIAL_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
                                                  HAPTRIAL_BINARY_DIR="${CMAKE_BINARY_DIR}")
  get_property(together GLOBAL PROPERTY HAPTRIAL_TOGETHER_${name})
  haptrial_whole_suites(test_${name} ${together})
  list(TRANSFORM together APPEND ".*")
  list(JOIN together ":" together)
  if(name STREQUAL realtime)
    haptrial_discover(test_${name} "*" 4 RUN_SERIAL TRUE)  # these measure time
  elseif(name STREQUAL experiments)
    # They wait for a session on the real clock.
    set(live "*Live*:KilledTest.*:KilledTrialsTest.*:LostDiskTest.*:ResumedParticipantTest.*")
    string(APPEND live ":RoundTripTest.ARec*:SessionMarkersTest.*:SessionTest.RealClock*:TakenBackTest.*")
    string(APPEND live ":*MarkerKillTest.*:AddedQuestionTest.*:DecisionScriptTest.*:StandInSensorTest.*")
    string(APPEND live ":LevelScriptSessionTest.*:OwnShapeTest.ASession*")
    haptrial_discover(test_${name} "-${live}:Timed*:${together}" 4)
    haptrial_discover(test_${name} "${live}:-LiveConsoleTest.*" 1)
    haptrial_discover(test_${name} "LiveConsoleTest.*" 4)  # a browser and a session take their time
    haptrial_discover(test_${name} "Timed*" 4 RUN_SERIAL TRUE)  # a busy machine is a fault here
  elseif(name STREQUAL channel)
    haptrial_discover(test_${name} "*" 1)  # these wait for instruments
  else()
    haptrial_discover(test_${name} "-${together}" 4)
  endif()
endfunction()

# haptrial_together(NAME SUITE...): suites of test_NAME whose cases share a set-up of seconds. The
# test runner gives every other case a process of its own; such a suite is one entry, so that the
# set-up is made once. Before the tests.
function(haptrial_together name)
  set_property(GLOBAL APPEND PROPERTY HAPTRIAL_TOGETHER_${name} ${ARGN})
endfunction()

# An entry for each suite; one that the program does not have fails.
function(haptrial_whole_suites target)
  foreach(suite ${ARGN})
    add_test(NAME ${suite} COMMAND ${target} --gtest_filter=${suite}.*)
    set_tests_properties(${suite} PROPERTIES TIMEOUT 600 PROCESSORS 4
                                             FAIL_REGULAR_EXPRESSION "Running 0 tests")
  endforeach()
endfunction()

# Tests run on seven times as many places as there are processors (check.sh). One that computes takes
# four; one of a live session, which sleeps most of its time, takes one. So of two processors' fourteen
# places tests that compute leave two, which sessions fill from the start.
function(haptrial_discover target filter places)
  gtest_discover_tests(${target} TEST_FILTER ${filter} DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT 600 PROCESSORS ${places} ${ARGN})
endfunction()

# tests/FOLDER/*.cpp becomes test_NAME for a module; those of a group's modules are one program, and
# so are those of protocols and of experiments. Sets `out` to the sources of test_NAME, none of a
# module that is tested with others.
function(haptrial_test_sources name out)
  get_property(folder GLOBAL PROPERTY HAPTRIAL_FOLDER_${name})
  get_property(groups GLOBAL PROPERTY HAPTRIAL_GROUPS)
  set(sources "")
  if(name IN_LIST groups)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/${folder}/*.cpp)
  elseif(NOT folder MATCHES "^(protocols|experiments)/")
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/${folder}/*.cpp)
    foreach(group ${groups})
      get_property(whole GLOBAL PROPERTY HAPTRIAL_FOLDER_${group})
      string(FIND ${folder} ${whole}/ at)
      if(at EQUAL 0)
        set(sources "")
      endif()
    endforeach()
  endif()
  set(${out} ${sources} PARENT_SCOPE)
endfunction()

# test_protocols and test_experiments. Tests of protocols run whole sessions, too, with the helpers
# of the tests of experiments.
function(haptrial_layer_tests)
  file(GLOB helpers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/experiments/*.cpp)
  list(FILTER helpers EXCLUDE REGEX "_test[.]cpp$")
  foreach(layer protocols experiments)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/${layer}/*.cpp)
    list(FILTER sources EXCLUDE REGEX "/tests/protocols/psychophysics/")
    list(APPEND sources ${helpers})
    list(REMOVE_DUPLICATES sources)
    haptrial_test(${layer} command_line ${sources})
    add_dependencies(test_${layer} haptrial)  # its tests run the command
  endforeach()
  target_link_libraries(test_experiments PRIVATE nlohmann_json::nlohmann_json)
  # A program with kinds of its own, as a page of the documents shows it.
  add_executable(own_kinds ${CMAKE_SOURCE_DIR}/docs/worked/own/own.cpp)
  target_link_libraries(own_kinds PRIVATE haptrial_command_line)
  add_dependencies(test_experiments own_kinds)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/protocols/psychophysics/*.cpp)
  haptrial_test(psychophysics psychophysics_preview ${sources})  # needs no other protocol
  # A protocol that only the tests and a page of the documents have.
  target_sources(test_experiments PRIVATE ${CMAKE_SOURCE_DIR}/docs/worked/protocol/springs.cpp)
  target_include_directories(test_experiments PRIVATE ${CMAKE_SOURCE_DIR}/docs/worked/protocol)
  target_sources(test_experiments PRIVATE
                 ${CMAKE_SOURCE_DIR}/tests/support/boards/simulated_board.cpp
                 ${CMAKE_SOURCE_DIR}/tests/analysis/exchange/small_session.cpp)
  add_dependencies(test_experiments stand_in_dhd stand_in_hd stand_in_lsl stand_in_espeak)
endfunction()

# What tests of a module need beside it: peers, slow methods to compare with, files to try.
function(haptrial_test_needs)
  file(GLOB references CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/support/references/*.cpp)
  add_library(haptrial_test_references STATIC ${references})
  target_link_libraries(haptrial_test_references PUBLIC haptrial_geometry_bvh haptrial_bone_model)
  find_package(assimp REQUIRED)
  target_link_libraries(test_geometry_files PRIVATE assimp::assimp haptrial_geometry_volume)
  target_link_libraries(test_geometry_mesh PRIVATE haptrial_geometry_volume)
  target_link_libraries(test_geometry_bvh PRIVATE haptrial_test_references)
  target_link_libraries(test_geometry_volume PRIVATE haptrial_test_references
                                                     haptrial_geometry_files)
  target_link_libraries(test_contact PRIVATE haptrial_geometry_files)
  target_link_libraries(test_deformable PRIVATE SUNDIALS::kinsol SUNDIALS::cvode
                                                haptrial_base)  # solvers to compare with
  target_link_libraries(test_bone_surface PRIVATE haptrial_bone_drill)
  target_link_libraries(test_bone_drill PRIVATE haptrial_test_references)
  target_link_libraries(test_bone_nerve PRIVATE haptrial_sound)
  pkg_check_modules(harfbuzz REQUIRED IMPORTED_TARGET harfbuzz)
  set_property(TARGET PkgConfig::harfbuzz PROPERTY INTERFACE_COMPILE_OPTIONS "")
  target_link_libraries(test_render_flat PRIVATE PkgConfig::harfbuzz)
  target_link_libraries(test_render_gl PRIVATE haptrial_render_flat)
  target_link_libraries(test_record PRIVATE haptrial_bone_record haptrial_record_rows  # tables to try
                                            haptrial_bone_nerve haptrial_bone_hint haptrial_bone_region
                                            haptrial_subject_drilling haptrial_channel
                                            PkgConfig::hdf5)
  target_link_libraries(test_drilling_analysis PRIVATE haptrial_bone_data)
  find_library(xdf_library xdf REQUIRED)
  target_link_libraries(test_exchange PRIVATE haptrial_force_score ${xdf_library})
  target_link_libraries(test_contact_analysis PRIVATE haptrial_geometry_files haptrial_geometry_volume)
  target_link_libraries(test_psychophysics PRIVATE haptrial_deformable_elements)  # bodies as they are calibrated
  target_link_libraries(test_subject_perceiver PRIVATE haptrial_scene)
  target_link_libraries(test_psychometric_fit PRIVATE nlohmann_json::nlohmann_json PkgConfig::gsl
                                                      haptrial_psychometric)  # virtual sessions
  target_link_libraries(test_psychometric_models PRIVATE PkgConfig::gsl)
  target_link_libraries(test_psychometric_hierarchical PRIVATE PkgConfig::gsl)
  target_link_libraries(test_psychophysics_analysis PRIVATE nlohmann_json::nlohmann_json PkgConfig::gsl
                                                     haptrial_record_hdf5)
  target_sources(test_force_analysis
                 PRIVATE ${CMAKE_SOURCE_DIR}/tests/analysis/exchange/small_session.cpp)
  add_dependencies(test_stream stand_in_lsl)
  add_dependencies(test_channel stand_in_lsl)
  target_sources(test_device PRIVATE ${CMAKE_SOURCE_DIR}/tests/support/boards/simulated_board.cpp)
  target_link_libraries(test_channel PRIVATE PkgConfig::httplib)  # a phone that answers
  target_link_libraries(test_stream PRIVATE PkgConfig::httplib)
  add_dependencies(test_device stand_in_dhd stand_in_dhd_only stand_in_hd)
endfunction()

function(haptrial_tests)
  include(GoogleTest)
  find_package(GTest REQUIRED)
  haptrial_precompiled(tests FOLDERS tests LIBRARIES Eigen3::Eigen fmt::fmt GTest::gmock GTest::gtest
                       HEADERS <gmock/gmock.h> <gtest/gtest.h>)
  file(GLOB support CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/support/*.cpp)
  list(FILTER support EXCLUDE REGEX "/stand_in_")
  add_library(haptrial_test_support STATIC ${support})
  target_include_directories(haptrial_test_support PUBLIC ${CMAKE_SOURCE_DIR})
  haptrial_stand_ins()
  haptrial_together(bone_data EarVariantsTest MandibleTest TemporalBoneTest)
  haptrial_together(deformable BallTouchTest)
  haptrial_together(experiments BoneSessionTest CurriculumSessionTest DesignReportsTest HintSessionTest
                                KeysTest LearningSessionTest NerveSessionTest RateTest
                                SoftTissueSessionTest TwoHandsTest)
  haptrial_together(protocols BeginningTest BoneRestoreTest ReplayTest)
  get_property(modules GLOBAL PROPERTY HAPTRIAL_MODULES)
  get_property(groups GLOBAL PROPERTY HAPTRIAL_GROUPS)
  foreach(name ${modules} ${groups})
    haptrial_test_sources(${name} sources)
    if(sources)
      haptrial_test(${name} ${name} ${sources})
    endif()
  endforeach()
  haptrial_layer_tests()
  haptrial_test_needs()
  file(GLOB architecture CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/architecture/*.cpp)
  add_executable(test_architecture ${architecture})
  # Eigen and fmt are in the precompiled headers.
  target_link_libraries(test_architecture PRIVATE Eigen3::Eigen fmt::fmt GTest::gmock GTest::gtest
                                                  GTest::gtest_main)
  target_compile_definitions(test_architecture PRIVATE HAPTRIAL_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  haptrial_optimise(test_architecture tests)
  haptrial_precompile(test_architecture tests tests)
  haptrial_unite_tests(test_architecture ${architecture})
  haptrial_discover(test_architecture "*" 4)
endfunction()
