# SPDX-License-Identifier: MIT
# cmake -DMODULE=FILE.spv -DNAME=NAME -DOUTPUT=FILE.h -DPASSES=... -DSPIRV_OPT=... -DOD=... -DSED=... -P embed_module.cmake
# writes the optimized module as a C array of its words.
execute_process(COMMAND "${SPIRV_OPT}" ${PASSES} "${MODULE}" -o "${MODULE}.opt" COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${OD}" -A n -v -t x4 "${MODULE}.opt" COMMAND "${SED}" "s/ \\([0-9a-f]*\\)/0x\\1,/g"
  OUTPUT_VARIABLE words COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE "${MODULE}.opt")
file(WRITE "${OUTPUT}" "#pragma once\nconst uint32_t ${NAME}[] = {\n${words}};\n")
