# SPDX-License-Identifier: MIT
# One library per folder. The folders stand here in their order, door by door: a folder uses those before it alone, and the two wings do not use
# each other. Configuring fails on a link that does otherwise, and the test Folders.* on an #include that does.
set(WHOLEHAND_FOLDERS
  base/text base/numbers base/system base/files base/statistics base/charts
  shaders
  core core/people core/reader core/meshes
  host
  device/session device/loop device/grippers device/simulated device/recordings device/advice device/run
  sweeps/grips sweeps/plan sweeps/lists sweeps/result sweeps/rank sweeps/run sweeps/cluster
  evidence/check evidence/report evidence/trials evidence/studies
  app/program app/viewer app/commands app/c app/python)
set(WHOLEHAND_WINGS device sweeps)

# wholehand_part(NAME WHAT FOLDER ...): the option WHOLEHAND_<NAME> leaves the folders out. C++ sees HAS_<NAME> where the first of them is there.
set(WHOLEHAND_LEFT_OUT "")
set(WHOLEHAND_PARTS "")  # HAS_<NAME> of those that are there
set(WHOLEHAND_IS_WHOLE TRUE)
macro(wholehand_part name what first)
  option(WHOLEHAND_${name} "Build ${what}" ON)
  if(NOT WHOLEHAND_${name})
    list(APPEND WHOLEHAND_LEFT_OUT ${first} ${ARGN})
    set(WHOLEHAND_IS_WHOLE FALSE)
  endif()
  if(NOT "${first}" IN_LIST WHOLEHAND_LEFT_OUT)
    list(APPEND WHOLEHAND_PARTS HAS_${name})
  endif()
endmacro()

# Sets `result` to whether a file needs a folder that is left out: tests it, or includes it, itself or through a header of tests/support.
function(wholehand_needs_left_out file result)
  get_property(is_known GLOBAL PROPERTY "needs_left_out:${file}" SET)
  if(NOT is_known)
    cmake_path(GET file PARENT_PATH folder)
    string(REGEX REPLACE "^.*/tests/" "" folder "${folder}")
    set(needs FALSE)
    if(folder IN_LIST WHOLEHAND_LEFT_OUT)
      set(needs TRUE)
    endif()
    file(STRINGS "${file}" lines REGEX "^#include \"[a-z_/]+/[a-z_0-9]+[.]h\"")
    foreach(line IN LISTS lines)
      string(REGEX MATCH "\"((.+)/[a-z_0-9]+[.]h)\"" line "${line}")
      if(CMAKE_MATCH_2 IN_LIST WHOLEHAND_LEFT_OUT)
        set(needs TRUE)
      elseif(CMAKE_MATCH_2 STREQUAL "tests/support" AND NOT needs)
        wholehand_needs_left_out("${PROJECT_SOURCE_DIR}/${CMAKE_MATCH_1}" needs)
      endif()
    endforeach()
    set_property(GLOBAL PROPERTY "needs_left_out:${file}" ${needs})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  endif()
  get_property(needs GLOBAL PROPERTY "needs_left_out:${file}")
  set(${result} ${needs} PARENT_SCOPE)
endfunction()

# Removes from a list of files those that need what is left out.
function(wholehand_remove_left_out list)
  if(WHOLEHAND_LEFT_OUT)
    foreach(file IN LISTS ${list})
      wholehand_needs_left_out("${file}" needs)
      if(needs)
        list(REMOVE_ITEM ${list} "${file}")
      endif()
    endforeach()
    set(${list} "${${list}}" PARENT_SCOPE)
  endif()
endfunction()

# Sets `result` to the place of a folder in the order.
function(wholehand_place folder result)
  list(FIND WHOLEHAND_FOLDERS "${folder}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "The folder ${folder}/ has no place: name it in WHOLEHAND_FOLDERS (cmake/folders.cmake)")
  endif()
  set(${result} ${place} PARENT_SCOPE)
endfunction()

# Fails where `name` may not use `other`.
function(wholehand_check_use name other)
  wholehand_place(${name} own)
  wholehand_place(${other} place)
  if(NOT place LESS own)
    message(FATAL_ERROR "${name}/ cannot use ${other}/: a folder uses those before it in WHOLEHAND_FOLDERS (cmake/folders.cmake)")
  endif()
  string(REGEX REPLACE "/.*" "" door "${name}")
  string(REGEX REPLACE "/.*" "" other_door "${other}")
  if(NOT door STREQUAL other_door AND door IN_LIST WHOLEHAND_WINGS AND other_door IN_LIST WHOLEHAND_WINGS)
    message(FATAL_ERROR "${name}/ cannot use ${other}/: ${door}/ and ${other_door}/ do not use each other")
  endif()
endfunction()

# wholehand_folder(FOLDER [USES FOLDER ...] [LINKS LIBRARY ...] [EXCEPT FILE ...] [QUICK] [EXACT] [HEADERS HEADER ...])
#
# makes a library of FOLDER/*.cpp without the EXCEPT files (paths from the folder, may be patterns). Its name is the folder's with _ for /. USES
# and LINKS are what its includers need too. The rest is for speed (cmake/build_speed.cmake): QUICK is less optimized (-O1), EXACT is compiled as
# the kernels are (core_options), and HEADERS are precompiled. Eight files are compiled as one. A folder that is left out makes no library.
function(wholehand_folder path)
  if(path IN_LIST WHOLEHAND_LEFT_OUT)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 folder "QUICK;EXACT" "" "USES;LINKS;HEADERS;EXCEPT")
  foreach(other IN LISTS WHOLEHAND_LEFT_OUT)
    list(REMOVE_ITEM folder_USES "${other}")
  endforeach()
  foreach(other IN LISTS folder_USES)
    wholehand_check_use(${path} ${other})
  endforeach()
  string(REPLACE "/" "_" name "${path}")
  list(TRANSFORM folder_USES REPLACE "/" "_")
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${path}/*.cpp")
  if(folder_EXCEPT)
    list(TRANSFORM folder_EXCEPT PREPEND "${PROJECT_SOURCE_DIR}/${path}/")
    file(GLOB excepted CONFIGURE_DEPENDS ${folder_EXCEPT})
    list(REMOVE_ITEM sources ${excepted})
  endif()
  wholehand_remove_left_out(sources)
  add_library(${name} STATIC ${sources})
  wholehand_hidden(${name})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(${name} PUBLIC ${folder_USES} ${folder_LINKS})
  if(folder_QUICK)
    wholehand_quick_build(${name})
  endif()
  if(folder_EXACT)
    core_options(${name})
  endif()
  if(folder_HEADERS)
    wholehand_precompile(${name} ${folder_HEADERS})
  endif()
  wholehand_together(${name} 8)
endfunction()
