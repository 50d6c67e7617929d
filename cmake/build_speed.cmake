# SPDX-License-Identifier: MIT
# What makes the build fast and changes nothing else: files are compiled some at a time, heavy headers once, and what nobody waits for with
# less optimization. The preset `plain` goes without the first two, so that every file is seen to include what it needs.
option(WHOLEHAND_BUILD_SPEED "Compile some files at a time, with precompiled headers" ON)

# wholehand_together(TARGET N): N files are compiled as one; 0: all of them. Names in their anonymous namespaces must not clash.
function(wholehand_together target batch)
  if(WHOLEHAND_BUILD_SPEED)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
    # GCC's -Wsubobject-linkage is about headers, and takes a file that a unity file includes for one
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# wholehand_grouped(TARGET): files with the same source property UNITY_GROUP are compiled as one.
function(wholehand_grouped target)
  if(WHOLEHAND_BUILD_SPEED)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  endif()
endfunction()

# wholehand_precompile(TARGET HEADER ...): headers that most files of the target include.
function(wholehand_precompile target)
  if(WHOLEHAND_BUILD_SPEED)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# wholehand_precompiled_by(TARGET OTHER): the headers that OTHER has precompiled, with the same options.
function(wholehand_precompiled_by target other)
  if(WHOLEHAND_BUILD_SPEED)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()

# wholehand_quick_build(TARGET ...): nobody waits for its speed, but everybody for its compilation.
function(wholehand_quick_build)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endforeach()
endfunction()

# wholehand_inlined(LIST): options with which Clang inlines what a sanitizer has made long. Else it leaves even an element of an array to a call,
# and the linker may take the copy of a file that is not optimized: a solve for efforts then takes three times as long.
function(wholehand_inlined list)
  set(options)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(options -mllvm -inline-threshold=2000)
  endif()
  set(${list} ${options} PARENT_SCOPE)
endfunction()

# wholehand_loops(FOLDER STEM ...): nothing but loops, and most of what a sanitized run would wait for: optimized there too.
function(wholehand_loops folder)
  if(WHOLEHAND_SANITIZE)
    wholehand_inlined(inlined)
    foreach(stem IN LISTS ARGN)
      set_source_files_properties("${PROJECT_SOURCE_DIR}/${folder}/${stem}.cpp"
        PROPERTIES COMPILE_OPTIONS "-O2;${inlined}" SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    endforeach()
  endif()
endfunction()
