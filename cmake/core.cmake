# SPDX-License-Identifier: MIT
# The library `core`. Files in namespace CORE_NS are compiled once for each precision, the plain-double rest once.

# The reference computes what the source says: no contraction, no re-association. -O3 even where the build's own flags say
# less, so that sanitized runs stay short; a debug build is left alone. Nobody asks for errno or for floating-point exceptions: without
# them a square root is one instruction, and both sides of a small branch may be computed. No number changes by this.
function(core_options name)
  target_compile_options(${name} PRIVATE -ffp-contract=off -fno-math-errno -fno-trapping-math $<$<NOT:$<CONFIG:Debug>>:-O3>
    $<$<BOOL:${WHOLEHAND_NATIVE}>:-march=native>)
endfunction()

# core_library(NAME SOURCE ...)
function(core_library name)
  add_library(${name} STATIC ${ARGN})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  core_options(${name})
  wholehand_hidden(${name})
endfunction()

# Kernels are small functions that call each other from file to file, a million times a second. GCC keeps most of these calls, unless it
# sees all files at once and may let the code grow. A grip then takes a quarter less time, to the same bits. With sanitizers it is the
# build that would take long; Clang has a higher limit for inlining there.
function(core_inlined name)
  if(WHOLEHAND_SANITIZE)
    wholehand_inlined(inlined)
    target_compile_options(${name} PRIVATE ${inlined})
    wholehand_together(${name} 8)
    return()
  endif()
  wholehand_together(${name} 0)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${name} PRIVATE --param=max-inline-insns-auto=200 --param=inline-unit-growth=300)
  endif()
endfunction()

# core_precision(NAME REAL SOURCE ...): the kernels with REAL as their number type, in namespace NAME.
function(core_precision name real)
  core_library(${name} ${ARGN})
  core_inlined(${name})
  target_compile_definitions(${name} PRIVATE "REAL=${real}" CORE_NS=${name})
  target_link_libraries(${name} PUBLIC core_plain)
  if(real STREQUAL "long double")
    target_compile_options(${name} PRIVATE -Wno-narrowing)  # its door answers in double
  elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # a double in the float build is a mistake; clang also reports results that are handed out as double
    target_compile_options(${name} PRIVATE -Wdouble-promotion -Wfloat-conversion)
  endif()
endfunction()

file(GLOB core_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/core/*.cpp")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${core_sources})
foreach(source IN LISTS core_sources)
  file(STRINGS "${source}" lines REGEX "^namespace CORE_NS" LIMIT_COUNT 1)
  if(lines)
    list(APPEND core_real_sources "${source}")
  else()
    list(APPEND core_plain_sources "${source}")
  endif()
endforeach()
core_library(core_plain ${core_plain_sources})
wholehand_together(core_plain 8)
core_precision(core_f64 double ${core_real_sources})         # the product
core_precision(core_f32 float ${core_real_sources})          # what float costs
core_precision(core_ld "long double" ${core_real_sources})   # a wider reference for the tests, which link it
set_target_properties(core_ld PROPERTIES EXCLUDE_FROM_ALL TRUE)
target_link_libraries(core_plain PUBLIC base_text base_numbers fmt::fmt core_f64 core_f32)  # evaluators.cpp names both; static libraries may need each other
add_library(core INTERFACE)
target_link_libraries(core INTERFACE core_f64 core_f32 core_plain Threads::Threads)
