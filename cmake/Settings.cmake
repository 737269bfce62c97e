# Compiler settings of every target.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
# The project has no address: lintian's only complaint about the packages.
set(CPACK_PACKAGE_CONTACT "the haptrial authors <haptrial@localhost>")
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O2")  # kernels take more: haptrial_optimise

option(HAPTRIAL_WERROR "Warnings are errors, as check.sh builds" OFF)
# No fused multiply-add unless it is written: the same source gives the same bits on every
# instruction set that a kernel is dispatched to.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                    $<$<BOOL:${HAPTRIAL_WERROR}>:-Werror> -ffp-contract=off)
# Eigen adds up in an order that follows the processor's caches, unless it is told their sizes: then a
# product has the same bits everywhere. haptrial_base hands this on to programs that link it.
set(HAPTRIAL_EIGEN EIGEN_NO_CPUID EIGEN_DEFAULT_L1_CACHE_SIZE=32768 EIGEN_DEFAULT_L2_CACHE_SIZE=1048576
                   EIGEN_DEFAULT_L3_CACHE_SIZE=33554432)
add_compile_definitions(${HAPTRIAL_EIGEN})
# GCC 12 sees an overflow in fmt 9 that cannot happen.
add_compile_options(-Wno-stringop-overflow)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # The compiler looks for memory to free every time that its heap has grown by a third; with this it
  # begins at 256 MB, which takes 40 MB more and a sixth less time.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=262144>)
endif()

set(HAPTRIAL_SANITIZER "" CACHE STRING "address or thread")
if(HAPTRIAL_SANITIZER STREQUAL "address")
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
elseif(HAPTRIAL_SANITIZER STREQUAL "thread")
  # Boost.Asio's fences are not followed, which is worth a warning to the compiler.
  add_compile_options(-fsanitize=thread -fno-omit-frame-pointer -Wno-tsan)
  add_link_options(-fsanitize=thread)
elseif(HAPTRIAL_SANITIZER)
  message(FATAL_ERROR "HAPTRIAL_SANITIZER is '${HAPTRIAL_SANITIZER}'; allowed: address, thread, or empty")
endif()

if(HAPTRIAL_SANITIZER)
  # GCC 12 takes std::regex under a sanitizer for uninitialised; less optimisation builds faster.
  add_compile_options(-Wno-maybe-uninitialized)
  set(CMAKE_CXX_FLAGS_RELEASE "-O1 -g1")
endif()

option(HAPTRIAL_UNITY "Compile each folder as one file: quicker from nothing, slower after a change" OFF)
if(HAPTRIAL_UNITY)
  add_compile_options(-Wno-subobject-linkage)  # the members of an implementation are the file's own
endif()
option(HAPTRIAL_TESTS "Build the tests (needs GoogleTest)" ON)
option(HAPTRIAL_PYTHON "Build the Python module (needs pybind11 and Python's headers)" OFF)
# The module takes the static libraries in. All targets alike, and without the module, too, so that
# precompiled headers fit and check.sh goes on where quickstart.sh ended; nothing replaces a function of
# ours from outside, so calls within a file stay direct.
add_compile_options(-fPIC -fno-semantic-interposition)
option(HAPTRIAL_FUZZ "Build the libFuzzer targets (needs clang)" OFF)
option(HAPTRIAL_BENCHMARKS "Build the benchmarks (needs Google Benchmark and the peers)" OFF)

find_program(CCACHE ccache)
if(CCACHE)
  # Without these two ccache keeps nothing that was compiled with precompiled headers.
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()
