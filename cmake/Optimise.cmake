# haptrial_level(FOLDER OUT): the level of optimisation of a release build, 0 to 3 or s. It optimises
# most what computes on every tick or over meshes, compiles faster what waits: for the disk, for a
# person or for another program, and keeps small what reads, prepares, draws and writes: commands,
# definitions, files, pictures, reports. Results do not depend on it.
# Tests are compiled once and run once, but not without any: the linker keeps one copy of a template
# that both sides have, and may keep the test's.
# The columns of the session file and the loop of a session compute on every tick; simulations of
# power spend their time in statistics, fits and the course of trials.
function(haptrial_level folder out)
  set(level 3)
  if(folder MATCHES "^tests")
    set(level 1)
  elseif(folder MATCHES "^core/record/table|^experiments/loop")
    set(level 3)
  elseif(folder MATCHES "^experiments" OR
         folder MATCHES "^core/(record|stream|network|pages|markers|base/definition)" OR
         folder MATCHES "^core/(bone/tools|deformable/calibration|nerve/record)" OR
         folder MATCHES "^core/render/(bone|gl)" OR
         folder MATCHES "^protocols/(tutoring|trials/(objects|presentation|stages))$" OR
         (folder MATCHES "^analysis" AND NOT folder MATCHES "^analysis/(alignment|psychometric)"))
    set(level 2)
  endif()
  if(folder MATCHES "^experiments/(command|console|control|devices|pages|plugin|power|runner|screen|studies|study)" OR
     folder MATCHES "^core/(base/definition|bone/(anatomy|data|record)|deformable/setup|device/(gamepad|input|pedal|vendor)|geometry/(files|volume_files))" OR
     folder MATCHES "^core/(hint|markers|nerve/setup|pages|psychometric/definition|record/(read|recovery)|render/(flat|mesh|trial)|scene/read|sound/cues)" OR
     folder MATCHES "^protocols/(bone_drilling$|definition|force_training$|[a-z_]+/(definition|display|nerves)|trials/(language|looks|script))" OR
     folder MATCHES "^analysis/(document|exchange|files|link|power|statistics/(design|words)|bone_drilling/(hints|metrics|nerves|validity)|trials/data|force_training/statistics)" OR
     folder MATCHES "^analysis/contact/(duck|evaluation|failure|identification|metrics|recording|registration|regression|simulation|truth)" OR
     folder MATCHES "^analysis/[a-z_]+/(comparison|exchange|feedback|figures|report|study|words)")
    set(level s)
  endif()
  set(${out} ${level} PARENT_SCOPE)
endfunction()

# haptrial_optimise(TARGET FOLDER): at that level; one for all under a sanitizer. Only what computes on
# every tick has its loops and functions aligned.
# Below -O3 GCC 12 sees overlaps and overflows in strings that cannot be.
function(haptrial_optimise target folder)
  haptrial_level("${folder}" level)
  if(NOT HAPTRIAL_SANITIZER AND NOT level EQUAL 3)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O${level}> -fno-align-functions
                                             -fno-align-loops -fno-align-jumps -Wno-restrict
                                             -Wno-array-bounds -Wno-stringop-overread)
  endif()
endfunction()

# haptrial_small(TARGET): each function in a section of its own, so that the link of the command leaves
# out those that nothing calls. Inline functions are not exported: plug-ins have their own. Checks in
# Eigen and JSON end the program as ever, but without texts that name functions with all their templates.
function(haptrial_small target)
  set(check "((x)?void():__builtin_abort())")
  target_compile_options(${target} PRIVATE -ffunction-sections -fdata-sections -fvisibility-inlines-hidden
                                           "-Deigen_assert(x)=${check}" "-DJSON_ASSERT(x)=${check}")
endfunction()
