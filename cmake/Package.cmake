# make-package.sh: Debian packages of what Install.cmake installs, the command apart from the
# libraries. Dependencies are found from what the command links, but for what it loads when it draws.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "the haptrial authors")
# CPACK_PACKAGE_CONTACT is in Settings.cmake: the packages' change logs name it, too.
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES TRUE)
set(CPACK_COMPONENTS_ALL command development)
if(HAPTRIAL_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL TRUE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME haptrial)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS TRUE)
set(CPACK_DEBIAN_COMMAND_PACKAGE_DEPENDS "libosmesa6, gnuplot-nox | gnuplot, fonts-dejavu-core, fonts-noto-core")
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "ffmpeg, libjs-codemirror, xdg-utils")
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "libespeak-ng1, elastix")
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "Psychophysics experiments on a
haptic device or with virtual participants, from a definition file: sessions,
a recording of every tick, and the analysis.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libhaptrial-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers, static libraries and CMake
files, for protocols and programs of one's own.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-haptrial)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS TRUE)
if(HAPTRIAL_PYTHON)  # an extension serves the one version of Python that it was built for
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy, python3-pandas")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS haptrial)
# They compile the module at installation, and remove what Python compiled.
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/cmake/python3-haptrial/postinst
                                              ${CMAKE_SOURCE_DIR}/cmake/python3-haptrial/prerm)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Sessions of haptrial as pandas frames,
with its scores, fits and procedures, in Python.")

# The libraries that an exported target names, as packages.txt lists them for the build.
file(STRINGS ${CMAKE_SOURCE_DIR}/cmake/packages.txt lines REGEX "^build +[a-z0-9.+-]+-dev ")
list(TRANSFORM lines REPLACE "^build +([a-z0-9.+-]+) .*" "\\1")
list(JOIN lines ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
include(CPack)
