# haptrial_level(FOLDER OUT): the level of optimisation of a release build, 0 to 3 or s. It optimises
# most what computes, compiles faster what waits: for the disk, for a person, for another program, and
# keeps small what reads and writes text: commands, definitions, reports. Results do not depend on it.
# Tests are compiled once and run once, but not without any: the linker keeps one copy of a template
# that both sides have, and may keep the test's.
# The columns of the session file and the loop of a session compute on every tick.
function(haptrial_level folder out)
  set(level 3)
  if(folder MATCHES "^tests")
    set(level 1)
  elseif(folder MATCHES "^core/record/table|^experiments/loop")
    set(level 3)
  elseif(folder MATCHES "^experiments|^core/(record|stream|network|pages|markers)|^core/base/definition" OR
         (folder MATCHES "^analysis" AND NOT folder MATCHES "^analysis/(alignment|psychometric)"))
    set(level 2)
  endif()
  if(folder MATCHES "^experiments/(command|console|control|power|screen|studies|study)" OR
     folder MATCHES "^core/(base/definition|record/recovery|scene/read|psychometric/definition|nerve/setup|pages)" OR
     folder MATCHES "^protocols/(definition|[a-z_]+/definition|trials/(language|script))" OR
     folder MATCHES "^analysis/(document|link|power|[a-z_]+/(comparison|exchange|feedback|figures|report|study|words))")
    set(level s)
  endif()
  set(${out} ${level} PARENT_SCOPE)
endfunction()

# haptrial_optimise(TARGET FOLDER): at that level; one for all under a sanitizer.
# Below -O3 GCC 12 sees overlaps and overflows in strings that cannot be.
function(haptrial_optimise target folder)
  haptrial_level("${folder}" level)
  if(NOT HAPTRIAL_SANITIZER AND NOT level EQUAL 3)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O${level}> -Wno-restrict
                                             -Wno-array-bounds -Wno-stringop-overread)
  endif()
endfunction()
