# SPDX-License-Identifier: MIT
# The language, warnings and sanitizers.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_COMPILE_WARNING_AS_ERROR ${WHOLEHAND_WERROR})
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")  # core/ has its own -O3

# Every folder may become part of the shared library. Hidden names cost no table of a dynamic linker, so position-independent code is as
# fast as the other; what the library shows is marked WH_API.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
function(wholehand_hidden target)
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

add_link_options(-Wl,--build-id=sha1)  # by which resumed trials and studies know their program
add_compile_options(-Wall -Wextra -Wpedantic $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -fdiagnostics-color=auto)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wshadow=local -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow)  # the last three: GCC 12's false alarms within std::string
endif()
if(WHOLEHAND_SANITIZE OR WHOLEHAND_ASSERTIONS)
  add_compile_definitions(_GLIBCXX_ASSERTIONS)  # bounds of containers
endif()
if(WHOLEHAND_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
if(WHOLEHAND_SANITIZE)
  add_compile_options(-fsanitize=${WHOLEHAND_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${WHOLEHAND_SANITIZE})
endif()
