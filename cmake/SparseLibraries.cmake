# CHOLMOD, of SuiteSparse, which Debian ships without CMake files.
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
add_library(cholmod INTERFACE IMPORTED)
target_link_libraries(cholmod INTERFACE ${CHOLMOD_LIBRARY})
target_include_directories(cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
