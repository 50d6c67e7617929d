# SPDX-License-Identifier: MIT
# The Debian packages, one a component of cmake/install.cmake, by CPack: `cpack` in the build folder, after the target `packaging`.
set(WHOLEHAND_MAINTAINER "The wholehand authors <maintainers@wholehand.example>" CACHE STRING "Name and mail address of the one who packages")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "${WHOLEHAND_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # CPack would put it before the summary of each package
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS ${CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS})
set(CPACK_STRIP_FILES ON)
set(CPACK_THREADS 0)  # all
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SOURCE wholehand)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENTS_ALL "")
set(same_version "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")

# ---- what every package has under share/doc ----
# The day of a release is in CHANGELOG.md; before it, today counts (SOURCE_DATE_EPOCH where that is set).
string(TIMESTAMP WHOLEHAND_PACKAGE_DATE "%a, %d %b %Y 00:00:00 +0000" UTC)
configure_file(cmake/package/changelog.in "${packaging_dir}/changelog" @ONLY)
foreach(pair "changelog|changelog.Debian" "${PROJECT_SOURCE_DIR}/CHANGELOG.md|changelog")
  string(REGEX MATCH "^(.*)\\|(.*)$" pair "${pair}")
  cmake_path(ABSOLUTE_PATH CMAKE_MATCH_1 BASE_DIRECTORY "${packaging_dir}" OUTPUT_VARIABLE text)
  set(packed "${packaging_dir}/${CMAKE_MATCH_2}.gz")
  add_custom_command(OUTPUT "${packed}" COMMAND gzip -9nc "${text}" > "${packed}" DEPENDS "${text}" VERBATIM)
  list(APPEND packed_changelogs "${packed}")
endforeach()
add_custom_target(packed_changelogs DEPENDS ${packed_changelogs})
add_dependencies(packaging packed_changelogs)

# wholehand_package(COMPONENT NAME SECTION DEPENDS SUMMARY LINE ...): LINEs are the longer description.
function(wholehand_package component name section depends summary)
  install(FILES cmake/package/copyright ${packed_changelogs} DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${name}" COMPONENT ${component})
  string(TOUPPER ${component} key)
  list(JOIN ARGN "\n" text)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
endfunction()

set(what_it_is
  "A haptic gripper tracks only the thumb and the index finger. From these two"
  "points wholehand computes how a whole hand holds a vessel, scores many such"
  "grips over tilts and fills, and renders the forces in live sessions.")
wholehand_package(program wholehand science
  "wholehand-common ${same_version}, libvulkan1, mesa-vulkan-drivers | vulkan-icd"
  "whole-hand grasping with a two-finger gripper" ${what_it_is} "" "This package has the program, its manual pages and a rule for grippers.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libmujoco2.2.2")  # loaded at run time, for wholehand trials
wholehand_package(common wholehand-common science ""
  "whole-hand grasping with a two-finger gripper - scenes" ${what_it_is} "" "This package has the scenes that the program and the libraries know by name.")
set(CPACK_DEBIAN_COMMON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_COMMON_PACKAGE_SHLIBDEPS OFF)
set(development_depends "")
if(TARGET wholehand_library)
  set(development_depends "libwholehand${WHOLEHAND_ABI} ${same_version}")
  wholehand_package(library libwholehand${WHOLEHAND_ABI} libs
    "wholehand-common ${same_version}, libvulkan1"
    "whole-hand grasping with a two-finger gripper - C library" ${what_it_is} "" "This package has the shared library with its C interface.")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd")
  configure_file(cmake/package/shlibs.in "${packaging_dir}/shlibs" @ONLY)
  # The trigger runs ldconfig. CPack would write scripts that do it too, unless scripts are named here; those that are not there it leaves out.
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/package/triggers" "${packaging_dir}/shlibs" /nonexistent/postinst
    /nonexistent/postrm)
endif()
wholehand_package(development libwholehand-dev libdevel
  "${development_depends}"
  "whole-hand grasping with a two-finger gripper - for C and C++ programs" ${what_it_is} "" "This package has headers and static libraries," "and files for CMake and pkg-config.")
# what the C library alone does not need
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "libassimp-dev, libdraco-dev, libembree-dev, libfmt-dev, libglm-dev, libhdf5-dev, libmeshoptimizer-dev, libnetcdf-dev, libpugixml-dev, libqhull-dev, libtinygltf-dev, libtomlplusplus-dev, libvulkan-dev, libxxhash-dev, nlohmann-json3-dev")
if(TARGET wholehand_python)
  wholehand_package(python python3-wholehand python
    "wholehand-common ${same_version}, python3 (>= 3.11), python3 (<< 3.12), python3-numpy, python3-xarray, python3-netcdf4, libvulkan1"
    "whole-hand grasping with a two-finger gripper - Python module" ${what_it_is} "" "This package has the module wholehand for Python 3.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/package/python/postinst" "${PROJECT_SOURCE_DIR}/cmake/package/python/prerm")
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
include(CPack)
