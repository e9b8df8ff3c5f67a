# SPDX-License-Identifier: MIT
# What `cmake --install` and `cpack -G DEB` install: the program with manual pages, completion, scenes and examples; the
# libraries with their headers, for CMake and pkg-config; the Python module.
include(CMakePackageConfigHelpers)

install(TARGETS gatewalk COMPONENT program)
# The program itself writes manual pages, completion and schemas.
install(CODE "
  execute_process(COMMAND \"$<TARGET_FILE:gatewalk>\" help --write \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\"
    COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB pages \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1/gatewalk*.1\")
  execute_process(COMMAND gzip -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/gatewalk COMPONENT program)
install(DIRECTORY cli/cluster DESTINATION ${CMAKE_INSTALL_DATADIR}/gatewalk COMPONENT program)
install(TARGETS dynamics markov lattice EXPORT gatewalk COMPONENT dev
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gatewalk COMPONENT dev)
install(EXPORT gatewalk NAMESPACE gatewalk:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/gatewalk
  FILE gatewalkTargets.cmake COMPONENT dev)
set(find_png "")
if(GATEWALK_VIDEO)
  set(find_png "find_dependency(PNG 1.6)")
endif()
file(CONFIGURE OUTPUT gatewalkConfig.cmake CONTENT [[
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4)
find_dependency(TBB)
find_dependency(fmt 9)
find_dependency(hwy CONFIG)
find_dependency(netCDF)
find_dependency(tomlplusplus)
@find_png@
include("${CMAKE_CURRENT_LIST_DIR}/gatewalkTargets.cmake")
]] @ONLY)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gatewalkConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gatewalkConfig.cmake
  ${PROJECT_BINARY_DIR}/gatewalkConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/gatewalk COMPONENT dev)
set(libpng "")
if(GATEWALK_VIDEO)
  set(libpng "libpng >= 1.6, ")
endif()
# The prefix is relative to the .pc file, so that it stays valid for cmake --install --prefix DIR and for a folder that
# is moved. An absolute CMAKE_INSTALL_LIBDIR or CMAKE_INSTALL_INCLUDEDIR stays absolute.
set(pc_prefix "${CMAKE_INSTALL_PREFIX}")
if(NOT IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  file(RELATIVE_PATH pc_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
  string(PREPEND pc_prefix "\${pcfiledir}/")
  string(REGEX REPLACE "/$" "" pc_prefix "${pc_prefix}")
endif()
foreach(dir INCLUDEDIR LIBDIR)
  set(pc_${dir} "${CMAKE_INSTALL_${dir}}")
  if(NOT IS_ABSOLUTE "${pc_${dir}}")
    string(PREPEND pc_${dir} "\${prefix}/")
  endif()
endforeach()
string(REGEX REPLACE ".*/lib([^.]*)[.].*" "\\1" hdf5 "${HDF5_LIBRARY}")
file(CONFIGURE OUTPUT gatewalk.pc CONTENT [[
prefix=@pc_prefix@
includedir=@pc_INCLUDEDIR@/gatewalk
libdir=@pc_LIBDIR@

Name: gatewalk
Description: @PROJECT_DESCRIPTION@
Version: @PROJECT_VERSION@
Requires: eigen3 >= 3.4, fmt >= 9, tbb, libhwy, netcdf, @libpng@tomlplusplus
Cflags: -I${includedir} -std=c++20
Libs: -L${libdir} -lgatewalk_lattice -lgatewalk_markov -lgatewalk_dynamics -l@hdf5@ -lklu
]] @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/gatewalk.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
if(GATEWALK_PYTHON)
  install(TARGETS _core LIBRARY DESTINATION lib/python3/dist-packages/gatewalk COMPONENT python)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/python/gatewalk DESTINATION lib/python3/dist-packages COMPONENT python
    PATTERN __pycache__ EXCLUDE PATTERN *.so EXCLUDE)
endif()

# Three Debian packages: for users of the program, for C++ developers, for Python.
set(components "program;dev")
if(GATEWALK_PYTHON)
  list(APPEND components python)
endif()
set(packaging ${PROJECT_SOURCE_DIR}/cli/packaging)
set(names_program gatewalk)
set(names_dev libgatewalk-dev)
set(names_python python3-gatewalk)
foreach(component ${components})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${names_${component}})
  install(FILES ${packaging}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${names_${component}} COMPONENT ${component})
  # Debian's policy: compressed with gzip -9, without a time.
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/doc/${names_${component}}\")
    file(COPY_FILE \"${packaging}/changelog\" \"\${folder}/changelog\")
    execute_process(COMMAND gzip -9nf \"\${folder}/changelog\")" COMPONENT ${component})
endforeach()
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_CONTACT "the gatewalk authors <gatewalk@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "gnuplot-nox, ffmpeg")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Multi-scale Markov chain analysis of locomotion through obstacles
 Runs a body through single gates of a cluttered field, chains the outcomes
 over the whole field, and compares the final gates with the full dynamics.")
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, libtbb-dev, libhwy-dev, libnetcdf-dev, libhdf5-dev, libtomlplusplus-dev, libsuitesparse-dev, libpng-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION "Libraries of gatewalk: dynamics, chains, fields
 Static libraries with their headers, for CMake and pkg-config.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-scipy, python3-pandas, python3-xarray, python3-matplotlib")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Predictions of locomotion through obstacles, in Python
 All commands of gatewalk as functions, matrices for scipy, cells in numpy.")
include(CPack)
