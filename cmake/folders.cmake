# SPDX-License-Identifier: MIT
# One library per folder. Every folder of the product stands on a floor, and uses folders of lower floors only: configuring fails on a link
# that goes up or sideways, and the test Folders.* on an #include that does.
set(WHOLEHAND_FLOORS
  shaders=0 include=0
  core=1
  system=2 scene=2 live=2 people=2 statistics=2
  host=3 device=3 objects=3 charts=3 program=3
  recordings=4 grips=4 advice=4
  sweeps=5 viewer=5
  evidence=6 cluster=6
  report=7
  trials=8 studies=8
  app=9 library=9
  python=10)

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

# wholehand_folder(NAME [USES FOLDER ...] [LINKS LIBRARY ...] [EXCEPT FILE ...] [QUICK] [HEADERS HEADER ...])
#
# makes the library NAME of NAME/*.cpp without the EXCEPT files (paths from the folder, may be patterns). USES and LINKS are what its
# includers need too. The rest is for speed (cmake/build_speed.cmake): QUICK is less optimized (-O1), and HEADERS are precompiled. Eight files are
# compiled as one.
function(wholehand_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 folder "QUICK" "" "USES;LINKS;HEADERS;EXCEPT")
  wholehand_floor(${name} floor)
  foreach(lower IN LISTS folder_USES)
    wholehand_floor(${lower} other)
    if(NOT other LESS floor)
      message(FATAL_ERROR "${name}/ (floor ${floor}) cannot use ${lower}/ (floor ${other}): a folder uses lower floors only")
    endif()
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${name}/*.cpp")
  if(folder_EXCEPT)
    list(TRANSFORM folder_EXCEPT PREPEND "${PROJECT_SOURCE_DIR}/${name}/")
    file(GLOB excepted CONFIGURE_DEPENDS ${folder_EXCEPT})
    list(REMOVE_ITEM sources ${excepted})
  endif()
  add_library(${name} STATIC ${sources})
  wholehand_hidden(${name})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(${name} PUBLIC ${folder_USES} ${folder_LINKS})
  if(folder_QUICK)
    wholehand_quick_build(${name})
  endif()
  if(folder_HEADERS)
    wholehand_precompile(${name} ${folder_HEADERS})
  endif()
  wholehand_together(${name} 8)
endfunction()
