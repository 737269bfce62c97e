# Readers of medical volumes. Their own CMake files ask for parts that Debian packages elsewhere.
find_library(TEEM_LIBRARY teem REQUIRED)
find_library(NIFTI_LIBRARY nifti2 REQUIRED)
find_path(NIFTI_INCLUDE_DIR nifti2_io.h PATH_SUFFIXES nifti REQUIRED)
set(GDCM_LIBRARIES "")
foreach(part MSFF DSED DICT Common)
  find_library(GDCM_${part}_LIBRARY gdcm${part} REQUIRED)
  list(APPEND GDCM_LIBRARIES ${GDCM_${part}_LIBRARY})
endforeach()
