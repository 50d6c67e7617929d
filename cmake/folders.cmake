# SPDX-License-Identifier: MIT
# One library per folder. Every folder of the product stands on a floor, and uses folders of lower floors only: configuring fails on a link
# that goes up or sideways, and the test Folders.* on an #include that does.
set(WHOLEHAND_FLOORS
  shaders=0
  core=1
  system=2 scene=2 live=2
  host=3 device=3 objects=3 recordings=3
  grips=4
  sweeps=5 viewer=5
  evidence=6
  report=7
  app=8)

# Sets `result` to the floor of a folder.
function(wholehand_floor folder result)
  foreach(entry IN LISTS WHOLEHAND_FLOORS)
    if(entry MATCHES "^${folder}=([0-9]+)$")
      set(${result} ${CMAKE_MATCH_1} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "The folder ${folder}/ has no floor: name it in WHOLEHAND_FLOORS (cmake/folders.cmake)")
endfunction()

# wholehand_folder(NAME [USES FOLDER ...] [LINKS LIBRARY ...] [QUICK] [HEADERS HEADER ... | SHARED_HEADERS] [BATCH N])
#
# makes the library NAME of NAME/*.cpp. QUICK: nobody waits for its speed (wholehand_quick_build). HEADERS are precompiled for it alone;
# SHARED_HEADERS are those that most folders include, precompiled once. BATCH: how many files are compiled as one.
function(wholehand_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 folder "QUICK;SHARED_HEADERS" "BATCH" "USES;LINKS;HEADERS")
  wholehand_floor(${name} floor)
  foreach(lower IN LISTS folder_USES)
    wholehand_floor(${lower} other)
    if(NOT other LESS floor)
      message(FATAL_ERROR "${name}/ (floor ${floor}) cannot use ${lower}/ (floor ${other}): a folder uses lower floors only")
    endif()
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${name}/*.cpp")
  wholehand_library(${name} ${sources})
  wholehand_link(${name} ${folder_USES} ${folder_LINKS})
  if(folder_QUICK)
    wholehand_quick_build(${name})
  endif()
  if(folder_SHARED_HEADERS)
    if(NOT TARGET shared_headers)
      file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/shared_headers.cpp" CONTENT "")
      add_library(shared_headers OBJECT "${PROJECT_BINARY_DIR}/shared_headers.cpp")
      target_link_libraries(shared_headers PRIVATE fmt::fmt)
      target_precompile_headers(shared_headers PRIVATE <fmt/format.h> <algorithm> <string> <vector>)
    endif()
    target_precompile_headers(${name} REUSE_FROM shared_headers)
  elseif(folder_HEADERS)
    wholehand_precompile(${name} ${folder_HEADERS})
  endif()
  if(NOT folder_BATCH)
    set(folder_BATCH 8)
  endif()
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${folder_BATCH})
endfunction()

# wholehand_loops(FOLDER STEM ...): nothing but loops, and most of what a sanitized run would wait for: optimized there too.
function(wholehand_loops folder)
  if(WHOLEHAND_SANITIZE)
    foreach(stem IN LISTS ARGN)
      set_source_files_properties("${PROJECT_SOURCE_DIR}/${folder}/${stem}.cpp"
        PROPERTIES COMPILE_OPTIONS -O2 SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    endforeach()
  endif()
endfunction()

# wholehand_library(NAME [SOURCE ...])
function(wholehand_library name)
  if(ARGN)
    add_library(${name} STATIC ${ARGN})
    target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}")
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE "${PROJECT_SOURCE_DIR}")
  endif()
endfunction()

# wholehand_link(NAME LIBRARY ...): what includers of the folder's headers need too.
function(wholehand_link name)
  get_target_property(type ${name} TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    target_link_libraries(${name} INTERFACE ${ARGN})
  else()
    target_link_libraries(${name} PUBLIC ${ARGN})
  endif()
endfunction()

# wholehand_precompile(NAME HEADER ...): heavy headers that most files of the folder include.
function(wholehand_precompile name)
  get_target_property(type ${name} TYPE)
  if(NOT type STREQUAL "INTERFACE_LIBRARY")
    target_precompile_headers(${name} PRIVATE ${ARGN})
  endif()
endfunction()

# wholehand_quick_build(NAME ...): folders whose speed nobody waits for, but whose compilation everybody does.
function(wholehand_quick_build)
  foreach(name IN LISTS ARGN)
    get_target_property(type ${name} TYPE)
    if(NOT type STREQUAL "INTERFACE_LIBRARY")
      target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    endif()
  endforeach()
endfunction()
