# SPDX-License-Identifier: MIT
# The id of the code that computes a sweep: a digest of its sources and of what compiles them. A mark keeps it (sweeps/run/resume.cpp), so that every
# program with the same code goes on with the sweep. When building, this file is a script that writes the one function that answers it.
if(CMAKE_SCRIPT_MODE_FILE)
  # -DSOURCE=FOLDER -DFOLDERS=NAME:NAME.. -DSETTINGS=TEXT -DOUTPUT=FILE.cpp
  string(REPLACE ":" ";" FOLDERS "${FOLDERS}")
  set(digests "${SETTINGS}\n")
  foreach(folder IN LISTS FOLDERS)
    file(GLOB_RECURSE files RELATIVE "${SOURCE}" "${SOURCE}/${folder}/*.cpp" "${SOURCE}/${folder}/*.h" "${SOURCE}/${folder}/*.glsl" "${SOURCE}/${folder}/*.comp")
    foreach(file IN LISTS files)
      file(SHA1 "${SOURCE}/${file}" digest)
      string(APPEND digests "${file} ${digest}\n")
    endforeach()
  endforeach()
  string(SHA1 id "${digests}")
  file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT "// generated: see cmake/code_id.cmake\n#include \"sweeps/run/code_id.h\"\n\nconst char* wholehand::sweeps::code_id() { return \"sha1-${id}\"; }\n")
  return()
endif()

# All that decides a number of a result, and what ranks of a cluster must have the same.
set(code_folders base shaders core host sweeps)
set(code_patterns)
foreach(folder IN LISTS code_folders)
  foreach(kind cpp h glsl comp)
    list(APPEND code_patterns "${PROJECT_SOURCE_DIR}/${folder}/*.${kind}")
  endforeach()
endforeach()
file(GLOB_RECURSE code_files CONFIGURE_DEPENDS ${code_patterns})
# how they are compiled, and the headers and tools from elsewhere that numbers come from
string(TOUPPER "${CMAKE_BUILD_TYPE}" code_type)
set(code_settings "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_SYSTEM_PROCESSOR} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${code_type}}"
  "${WHOLEHAND_BUILD_SPEED} ${WHOLEHAND_NATIVE} ${WHOLEHAND_SANITIZE}")
foreach(file IN ITEMS "${CMAKE_CURRENT_LIST_DIR}/core.cmake" "${CMAKE_CURRENT_LIST_DIR}/shaders.cmake"
    "${GLM_INCLUDE_DIR}/glm/detail/setup.hpp" "${GLSLANG_VALIDATOR}" "${SPIRV_OPT}")
  file(SHA1 "${file}" code_digest)
  list(APPEND code_settings ${code_digest})
endforeach()
string(REPLACE "${PROJECT_SOURCE_DIR}/" "" code_names "${code_files}")
string(SHA1 code_settings "${code_settings};${code_names}")
list(JOIN code_folders ":" code_folders)
add_custom_command(OUTPUT "${PROJECT_BINARY_DIR}/code_id.cpp"
  COMMAND "${CMAKE_COMMAND}" "-DSOURCE=${PROJECT_SOURCE_DIR}" "-DFOLDERS=${code_folders}" -DSETTINGS=${code_settings}
    "-DOUTPUT=${PROJECT_BINARY_DIR}/code_id.cpp" -P "${CMAKE_CURRENT_LIST_FILE}"
  DEPENDS ${code_files} "${CMAKE_CURRENT_LIST_FILE}" COMMENT "Writing the id of the code that computes" VERBATIM)
target_sources(sweeps_run PRIVATE "${PROJECT_BINARY_DIR}/code_id.cpp")
# alone, so that an edit of a source elsewhere compiles no more than this
set_source_files_properties("${PROJECT_BINARY_DIR}/code_id.cpp" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
