# SPDX-License-Identifier: MIT
# The Python package: the module wholehand._core of app/python/*.cpp, and app/python/wholehand beside it. Errors have the words of app/program/, as on
# the command line.
if(NOT DEFINED Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)  # Debian's, which knows Debian's packages
endif()
find_package(Python 3.11 REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 2.10 REQUIRED)

wholehand_folder(app/python USES device/session sweeps/run evidence/check app/program
  LINKS fmt::fmt pybind11::headers Python::Module)
target_compile_definitions(app_python PRIVATE ${WHOLEHAND_PARTS})
add_library(wholehand_python MODULE $<TARGET_OBJECTS:app_python>)
set_target_properties(wholehand_python PROPERTIES PREFIX "" OUTPUT_NAME _core SUFFIX ".${Python_SOABI}.so"
  LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/python" LINK_DEPENDS "${PROJECT_SOURCE_DIR}/app/python/exported.map")
target_link_libraries(wholehand_python PRIVATE app_python)
# the module shows its entry alone, and loads only what it uses
target_link_options(wholehand_python PRIVATE "-Wl,--version-script=${PROJECT_SOURCE_DIR}/app/python/exported.map" -Wl,--as-needed)

set(WHOLEHAND_PYTHON_DIR "lib/python3/dist-packages" CACHE STRING "Where the Python package goes, under any prefix")
install(TARGETS wholehand_python LIBRARY DESTINATION "${WHOLEHAND_PYTHON_DIR}/wholehand" COMPONENT python)
install(DIRECTORY app/python/wholehand/ DESTINATION "${WHOLEHAND_PYTHON_DIR}/wholehand" COMPONENT python
  FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN __pycache__ EXCLUDE)
