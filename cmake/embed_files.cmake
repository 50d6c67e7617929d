# SPDX-License-Identifier: MIT
# Puts files into the program as they are.
#
#   embed_files(TARGET HEADER FUNCTION PATH FILE [PATH FILE ...])
#
# makes a static library TARGET that defines FUNCTION, declared in HEADER as
#   std::span<const EmbeddedFile> FUNCTION();
# with an entry for every FILE under its PATH. The assembler reads the files (.incbin): a megabyte costs no time, as an array of numbers
# would.
function(embed_files target header function)
  set(assembly "")
  set(symbols "")
  set(rows "")
  set(files "")
  set(number 0)
  set(pairs ${ARGN})
  while(pairs)
    list(POP_FRONT pairs path file)
    set(name "${target}_${number}")
    string(APPEND assembly
      "    \".global ${name}\\n.hidden ${name}\\n${name}:\\n.incbin \\\"${file}\\\"\\n\"\n"
      "    \".global ${name}_end\\n.hidden ${name}_end\\n${name}_end:\\n\"\n")
    string(APPEND symbols "extern const char ${name}[], ${name}_end[];\n")
    string(APPEND rows "    {\"${path}\", {${name}, static_cast<std::size_t>(${name}_end - ${name})}},\n")
    list(APPEND files "${file}")
    math(EXPR number "${number} + 1")
  endwhile()
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp")
  file(CONFIGURE OUTPUT "${source}" CONTENT
    "// generated: see cmake/embed_files.cmake\n#include \"${header}\"\n\n#include <cstddef>\n\nasm(\".pushsection .rodata\\n\"\n${assembly}    \".popsection\\n\");\n\nextern \"C\" {\n${symbols}}\n\nstd::span<const wholehand::EmbeddedFile> wholehand::${function}() {\n  static const EmbeddedFile FILES[] = {\n${rows}  };\n  return FILES;\n}\n"
    @ONLY)
  set_source_files_properties("${source}" PROPERTIES OBJECT_DEPENDS "${files}")
  add_library(${target} STATIC "${source}")
  wholehand_hidden(${target})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
endfunction()

# embed_folder(TARGET HEADER FUNCTION FOLDER [PATH FILE ...]): all files of the folder, each under its path in it, and the others.
function(embed_folder target header function folder)
  file(GLOB_RECURSE files RELATIVE "${PROJECT_SOURCE_DIR}/${folder}" CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*")
  set(pairs ${ARGN})
  foreach(file IN LISTS files)
    list(APPEND pairs "${file}" "${PROJECT_SOURCE_DIR}/${folder}/${file}")
  endforeach()
  embed_files(${target} ${header} ${function} ${pairs})
endfunction()
