# One library per folder, and a folder that is still empty is an empty library: the rules below hold for both.

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
