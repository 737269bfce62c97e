# haptrial_optimise(TARGET FOLDER): -O2 (Settings.cmake), but -O3 for the kernels that compute on every
# tick, over meshes or over curves, and -O1 for tests, which run once. Results do not depend on it.
function(haptrial_level folder out)
  set(level 2)
  if(folder MATCHES "^tests")
    set(level 1)
  elseif(folder MATCHES "^core/(bone/(data|drill|dust|model|simulator|surface)|contact|control|deformable|device|geometry|scene|subject)" OR
         folder MATCHES "^analysis/(alignment|psychometric)")
    set(level 3)
  endif()
  set(${out} ${level} PARENT_SCOPE)
endfunction()

# Below -O3 GCC 12 sees overlaps and overflows in strings that cannot be.
function(haptrial_optimise target folder)
  haptrial_level("${folder}" level)
  if(NOT HAPTRIAL_SANITIZER)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O${level}> -Wno-restrict
                                             -Wno-array-bounds -Wno-stringop-overread)
  endif()
endfunction()
