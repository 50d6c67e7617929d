# SPDX-License-Identifier: MIT
# What `cmake --install` puts where, in components: program, common (the shipped scenes), library, development and python. A component is a
# Debian package (cmake/package.cmake). The target `packaging` builds what they consist of; nobody else waits for it.
include(CMakePackageConfigHelpers)
if(CMAKE_LIBRARY_ARCHITECTURE AND EXISTS /etc/debian_version)
  set(CMAKE_INSTALL_LIBDIR "lib/${CMAKE_LIBRARY_ARCHITECTURE}" CACHE PATH "Where libraries go: Debian's folder, under any prefix")
endif()
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)  # whatever the umask of the one who builds
set(WHOLEHAND_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/wholehand")
set(packaging_dir "${PROJECT_BINARY_DIR}/packaging")

set(with_all ALL)
if(WHOLEHAND_SANITIZE OR WHOLEHAND_FUZZ)
  set(with_all "")  # nobody installs these
endif()
add_custom_target(packaging ${with_all} DEPENDS wholehand)

# ---- program, and the scenes that it and the library find at share/wholehand (core/reader/shipped.cpp) ----
install(TARGETS wholehand RUNTIME COMPONENT program)
install(DIRECTORY examples/scenes/ DESTINATION "${CMAKE_INSTALL_DATADIR}/wholehand/scenes" COMPONENT common FILES_MATCHING PATTERN "*.toml")
install(DIRECTORY examples/extreme/ DESTINATION "${CMAKE_INSTALL_DATADIR}/wholehand/extreme" COMPONENT common FILES_MATCHING PATTERN "*.toml")
install(DIRECTORY docs/ DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/wholehand/docs" COMPONENT common
  FILES_MATCHING PATTERN "*.md" PATTERN pictures EXCLUDE PATTERN results EXCLUDE)
install(DIRECTORY examples/ DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/wholehand/examples" COMPONENT common
  FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ  # read, and copied; hand.gd stays a link to the other project's
  PATTERN scenes EXCLUDE PATTERN extreme EXCLUDE PATTERN __pycache__ EXCLUDE PATTERN .import EXCLUDE PATTERN "*.so" EXCLUDE)

install(FILES device/udev/60-wholehand.rules DESTINATION lib/udev/rules.d COMPONENT program)  # udev sees by itself that it is new

# ---- manual pages, from what the program says of itself ----
set(manual_dir "${packaging_dir}/man")
add_custom_command(OUTPUT "${manual_dir}/.made" DEPENDS wholehand cmake/package/manual.sh cmake/package/manual.h2m
  COMMAND sh "${PROJECT_SOURCE_DIR}/cmake/package/manual.sh" "$<TARGET_FILE:wholehand>" ${PROJECT_VERSION} "${manual_dir}"
  COMMENT "Writing manual pages" VERBATIM)
add_custom_target(manual DEPENDS "${manual_dir}/.made")
find_program(HELP2MAN help2man)
if(HELP2MAN)  # one of the packages of packages.txt for packaging; whoever only builds and installs goes without manual pages
  add_dependencies(packaging manual)
endif()
install(DIRECTORY "${manual_dir}/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT program OPTIONAL FILES_MATCHING PATTERN "*.1.gz")

# ---- completion of commands in shells, where each shell looks for it ----
function(install_completion shell folder file)
  set(script "${packaging_dir}/completion/${shell}/${file}")
  file(MAKE_DIRECTORY "${packaging_dir}/completion/${shell}")
  add_custom_command(OUTPUT "${script}" DEPENDS wholehand COMMAND wholehand completion ${shell} > "${script}" VERBATIM)
  add_custom_target(completion_${shell} DEPENDS "${script}")
  add_dependencies(packaging completion_${shell})
  install(FILES "${script}" DESTINATION "${CMAKE_INSTALL_DATADIR}/${folder}" COMPONENT program)
endfunction()
install_completion(bash bash-completion/completions wholehand)
install_completion(zsh zsh/vendor-completions _wholehand)  # Debian's; elsewhere zsh/site-functions
install_completion(fish fish/vendor_completions.d wholehand.fish)

# ---- library: the C face; development: its header, and how a build finds it ----
if(TARGET wholehand_library)
  add_dependencies(packaging wholehand_library)
  set_target_properties(wholehand_library PROPERTIES EXPORT_NAME wholehand)
  target_include_directories(wholehand_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  install(TARGETS wholehand_library EXPORT wholehandTargets
    LIBRARY COMPONENT library NAMELINK_COMPONENT development)
  install(FILES app/c/wholehand/wholehand.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/wholehand" COMPONENT development)
  install(EXPORT wholehandTargets NAMESPACE wholehand:: DESTINATION "${WHOLEHAND_PACKAGE_DIR}" COMPONENT development)
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" OUTPUT_VARIABLE WHOLEHAND_FROM_PC)
  configure_file(cmake/package/wholehand.pc.in "${packaging_dir}/wholehand.pc" @ONLY)
  install(FILES "${packaging_dir}/wholehand.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT development)
endif()
configure_package_config_file(cmake/package/wholehandConfig.cmake.in "${packaging_dir}/wholehandConfig.cmake"
  INSTALL_DESTINATION "${WHOLEHAND_PACKAGE_DIR}")
write_basic_package_version_file("${packaging_dir}/wholehandConfigVersion.cmake" COMPATIBILITY SameMinorVersion)  # before 1.0 each may break
install(FILES "${packaging_dir}/wholehandConfig.cmake" "${packaging_dir}/wholehandConfigVersion.cmake"
  DESTINATION "${WHOLEHAND_PACKAGE_DIR}" COMPONENT development)

# ---- development, too: base/, core/, host/ and sweeps/ but for the cluster, for programs in C++ (docs/library.md) ----
set(cpp_folders ${WHOLEHAND_FOLDERS})
list(FILTER cpp_folders INCLUDE REGEX "^(base|shaders|core|host|sweeps)(/|$)")
list(REMOVE_ITEM cpp_folders sweeps/cluster)
list(TRANSFORM cpp_folders REPLACE "/" "_" OUTPUT_VARIABLE cpp_libraries)
set(cpp_dir "${CMAKE_INSTALL_INCLUDEDIR}/wholehand/cpp")  # includes are named from here: "core/evaluator.h"
target_compile_features(core INTERFACE cxx_std_20)
install(TARGETS core_plain core_f64 core_f32 ${cpp_libraries} sweeps EXPORT wholehandCppTargets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}/wholehand" COMPONENT development INCLUDES DESTINATION "${cpp_dir}")
install(EXPORT wholehandCppTargets NAMESPACE wholehand:: DESTINATION "${WHOLEHAND_PACKAGE_DIR}" COMPONENT development)
add_dependencies(packaging ${cpp_libraries})
foreach(folder IN LISTS cpp_folders)
  file(GLOB headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*.h")
  install(FILES ${headers} DESTINATION "${cpp_dir}/${folder}" COMPONENT development)
endforeach()

# ---- python: cmake/python.cmake has its rules, with COMPONENT python ----
if(TARGET wholehand_python)
  add_dependencies(packaging wholehand_python)
endif()

include(package)
