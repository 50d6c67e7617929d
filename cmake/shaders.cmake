# SPDX-License-Identifier: MIT
# Compiles compute shaders to SPIR-V, optimizes and embeds them.
#
#   embed_shaders(TARGET HEADER FUNCTION GLOB ... [WIDE] [DEFINES NAME ...])
#
# makes a static library TARGET that defines FUNCTION, declared in HEADER as
#   std::span<const EmbeddedShader> FUNCTION();
# with an entry for every matching .comp in float and in double, where it or a file it includes mentions build.glsl in both
# builds, and where OUTLINE_SOURCE is mentioned for every source of the outline. A shader is compiled again when a file that it
# includes changes: glslangValidator writes the dependencies.

find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
find_program(SPIRV_OPT spirv-opt REQUIRED)
find_program(SPIRV_DIS spirv-dis REQUIRED)
# Loops that ask for it are unrolled here if the number of turns is a constant, and what this leaves without use is taken away. A
# driver does the same, in each process anew and more slowly (docs/results). No arithmetic is changed.
set(SHADER_PASSES --loop-unroll --ccp --eliminate-dead-branches --merge-blocks --eliminate-dead-code-aggressive)
set(SHADER_TARGET_ENV vulkan1.3)  # group sizes are LocalSizeId then: the device enables maintenance4

# Sets `result` to those of the words that the file or what it includes, at any depth, has in it. The answer is taken when configuring, so the
# files are watched and a change configures again.
function(shader_mentions file result)
  set(pending "${file}")
  set(seen "")
  set(found "")
  while(pending)
    list(POP_FRONT pending current)
    if(current IN_LIST seen OR NOT EXISTS "${current}")
      continue()
    endif()
    list(APPEND seen "${current}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${current}")
    foreach(word IN LISTS ARGN)
      file(STRINGS "${current}" mentions REGEX "${word}")
      if(mentions)
        list(APPEND found "${word}")
      endif()
    endforeach()
    cmake_path(GET current PARENT_PATH here)
    file(STRINGS "${current}" includes REGEX "^[ \t]*#[ \t]*include[ \t]*\"")
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^[^\"]*\"([^\"]+)\".*$" "\\1" name "${line}")
      list(APPEND pending "${here}/${name}" "${PROJECT_SOURCE_DIR}/${name}" "${PROJECT_SOURCE_DIR}/shaders/${name}")
    endforeach()
  endwhile()
  set(${result} "${found}" PARENT_SCOPE)
endfunction()

function(embed_shaders target header function)
  cmake_parse_arguments(PARSE_ARGV 3 embed "WIDE" "" "DEFINES")
  file(GLOB shaders CONFIGURE_DEPENDS ${embed_UNPARSED_ARGUMENTS})
  list(TRANSFORM embed_DEFINES PREPEND "-D")
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${target}.dir")
  file(MAKE_DIRECTORY "${folder}")
  set(includes "")
  set(rows "")
  set(outputs "")
  foreach(shader IN LISTS shaders)
    cmake_path(GET shader STEM stem)
    shader_mentions("${shader}" mentions build.glsl OUTLINE_SOURCE)
    set(variants "-1,-1")  # build and source of the outline
    if("OUTLINE_SOURCE" IN_LIST mentions)
      set(variants 0,0 0,1 1,0)
    elseif("build.glsl" IN_LIST mentions)
      set(variants 0,-1 1,-1)
    endif()
    if(embed_WIDE)
      list(FILTER variants EXCLUDE REGEX "^1,")
    endif()
    foreach(precision 0 1)
      foreach(variant IN LISTS variants)
        string(REPLACE "," ";" parts "${variant}")
        list(GET parts 0 build)
        list(GET parts 1 outline)
        set(name "${stem}_${precision}")
        set(defines -DREAL_IS_DOUBLE=${precision} ${embed_DEFINES})
        if(NOT build EQUAL -1)
          string(APPEND name "_${build}")
          list(APPEND defines -DSMALL=${build})
        endif()
        if(NOT outline EQUAL -1)
          string(APPEND name "_${outline}")
          list(APPEND defines -DOUTLINE_SOURCE=${outline})
        endif()
        set(module "${folder}/${name}.spv")
        set(output "${folder}/${name}.h")
        add_custom_command(OUTPUT "${module}"
          COMMAND "${GLSLANG_VALIDATOR}" --quiet -Os --target-env ${SHADER_TARGET_ENV} ${defines} "-I${PROJECT_SOURCE_DIR}"
            "-I${PROJECT_SOURCE_DIR}/shaders" --depfile "${module}.d" -o "${module}" "${shader}"
          DEPENDS "${shader}"
          DEPFILE "${module}.d"
          COMMENT "Compiling shader ${stem} (${defines})"
          VERBATIM)
        add_custom_command(OUTPUT "${output}"
          COMMAND "${CMAKE_COMMAND}" "-DMODULE=${module}" "-DNAME=${name}" "-DOUTPUT=${output}" "-DPASSES=${SHADER_PASSES}"
            "-DSPIRV_OPT=${SPIRV_OPT}" "-DSPIRV_DIS=${SPIRV_DIS}" -P "${PROJECT_SOURCE_DIR}/cmake/embed_module.cmake"
          DEPENDS "${module}" "${PROJECT_SOURCE_DIR}/cmake/embed_module.cmake" "${SPIRV_OPT}"
          COMMENT "Optimizing shader ${name}"
          VERBATIM)
        list(APPEND outputs "${output}")
        string(APPEND includes "#include \"${target}.dir/${name}.h\"\n")
        string(APPEND rows "    {\"${stem}\", ${precision}, ${build}, ${outline}, ${name}},\n")
      endforeach()
    endforeach()
  endforeach()
  set(table "${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp")
  if(shaders)
    set(body "constexpr wholehand::EmbeddedShader TABLE[] = {\n${rows}};\n}\n\nstd::span<const wholehand::EmbeddedShader> wholehand::${function}() { return TABLE; }\n")
  else()
    set(body "}\n\nstd::span<const wholehand::EmbeddedShader> wholehand::${function}() { return {}; }\n")
  endif()
  file(CONFIGURE OUTPUT "${table}" CONTENT
    "// generated: see cmake/shaders.cmake\n#include \"${header}\"\n\n#include <cstdint>\n\nnamespace {\n${includes}\n${body}" @ONLY)
  add_library(${target} STATIC "${table}" ${outputs})
  wholehand_hidden(${target})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
  target_compile_options(${target} PRIVATE -O0)  # tables only
endfunction()
