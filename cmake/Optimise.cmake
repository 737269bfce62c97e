# haptrial_level(FOLDER OUT): the level of optimisation of a release build, 0 to 3. It optimises most
# what computes, and compiles faster what waits: for the disk, for a person, for another program.
# Results do not depend on the level.
# Tests of core compute what they compare with; other tests wait for what they call.
# The columns of the session file and the loop of a session compute on every tick.
function(haptrial_level folder out)
  set(level 3)
  if(folder MATCHES "^tests")
    set(level 0)
    if(folder MATCHES "^tests/(core|analysis/contact)")
      set(level 1)
    endif()
  elseif(folder MATCHES "^core/record/table|^experiments/loop")
    set(level 3)
  elseif(folder MATCHES "^experiments|^core/(record|stream|network|pages|markers)|^core/base/definition" OR
         (folder MATCHES "^analysis" AND NOT folder MATCHES "^analysis/(alignment|psychometric)"))
    set(level 2)
  endif()
  set(${out} ${level} PARENT_SCOPE)
endfunction()

# haptrial_optimise(TARGET FOLDER): at that level; one for all under a sanitizer.
# Below -O3 GCC 12 sees overlaps and overflows in strings that cannot be.
function(haptrial_optimise target folder)
  haptrial_level("${folder}" level)
  if(NOT HAPTRIAL_SANITIZER AND level LESS 3)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O${level}> -Wno-restrict
                                             -Wno-array-bounds -Wno-stringop-overread)
  endif()
endfunction()
