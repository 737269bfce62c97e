# haptrial_optimise(TARGET FOLDER): a release build optimises most what computes, and compiles faster
# what waits: for the disk, for a person, for another program. Results do not depend on the level.
# Tests of core compute what they compare with; other tests wait for what they call.
# The columns of the session file and the loop of a session compute on every tick.
# At -O1 and -O2 GCC 12 sees overlaps and overflows in strings that cannot be.
set(HAPTRIAL_COMPUTING_TESTS "^tests/(core|analysis/contact)")
function(haptrial_optimise target folder)
  if(HAPTRIAL_SANITIZER)
    return()  # one level for all
  endif()
  if(folder MATCHES "^tests" AND NOT folder MATCHES "${HAPTRIAL_COMPUTING_TESTS}")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O0> -Wno-restrict -Wno-array-bounds -Wno-stringop-overread)
  elseif(folder MATCHES "^tests|^experiments/(command|console|stud)")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> -Wno-restrict -Wno-array-bounds -Wno-stringop-overread)
  elseif(folder MATCHES "^core/record/table|^experiments/loop")
    return()
  elseif(folder MATCHES "^core/(record|stream|network)|^core/base/definition|^experiments" OR
         (folder MATCHES "^analysis" AND NOT folder MATCHES "^analysis/(alignment|psychometric)"))
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O2> -Wno-restrict -Wno-array-bounds -Wno-stringop-overread)
  endif()
endfunction()
