# SPDX-License-Identifier: MIT
# cmake -DMODULE=FILE.spv -DNAME=NAME -DOUTPUT=FILE.h -DPASSES=... -DSPIRV_OPT=... -DSPIRV_DIS=... -P embed_module.cmake
# writes the optimized module as a C array of its words. Needs od, sed and awk beside the two programs.

# Sets `result` to the number of instructions with NoContraction (`precise`) in loops that ask to be unrolled.
function(count_precise_in_loops module result)
  execute_process(COMMAND "${SPIRV_DIS}" --raw-id --no-header "${module}" COMMAND awk [[
      $1 == "OpDecorate" && $3 == "NoContraction" { precise[$2] = 1 }
      $1 == "OpLoopMerge" && ($4 == "Unroll" || depth > 0) { end[++depth] = $2 }
      $3 == "OpLabel" && depth > 0 && $1 == end[depth] { --depth }
      $2 == "=" && depth > 0 && ($1 in precise) { ++count }
      END { print count + 0 }]]
    OUTPUT_VARIABLE count OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(${result} ${count} PARENT_SCOPE)
endfunction()

execute_process(COMMAND "${SPIRV_OPT}" ${PASSES} "${MODULE}" -o "${MODULE}.opt" COMMAND_ERROR_IS_FATAL ANY)
# spirv-opt (2023.1) keeps NoContraction in the first copy of a loop's body alone. A module that would lose it so is left as it is.
count_precise_in_loops("${MODULE}" before)
count_precise_in_loops("${MODULE}.opt" after)
set(embedded "${MODULE}.opt")
if(NOT before EQUAL after)
  set(embedded "${MODULE}")
endif()
execute_process(COMMAND od -A n -v -t x4 "${embedded}" COMMAND sed "s/ \\([0-9a-f]*\\)/0x\\1,/g"
  OUTPUT_VARIABLE words COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE "${MODULE}.opt")
file(WRITE "${OUTPUT}" "#pragma once\nconst uint32_t ${NAME}[] = {\n${words}};\n")
