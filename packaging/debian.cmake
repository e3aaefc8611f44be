# SPDX-License-Identifier: Apache-2.0
# `cpack` in the build folder makes one Debian package of each part; what each needs is found out by dpkg-shlibdeps.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME kontur)
# The project has no address of its own: who hands packages on names himself here.
set(KONTUR_PACKAGE_CONTACT "the kontur developers <developers@kontur.invalid>" CACHE STRING "Maintainer of the Debian packages: NAME <ADDRESS>")
set(CPACK_PACKAGE_CONTACT ${KONTUR_PACKAGE_CONTACT})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL command_line library development)
if(TARGET kontur_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Loaded when a reference solver runs, and when an archive is asked: dpkg-shlibdeps cannot see it.
set(CPACK_DEBIAN_PACKAGE_DEPENDS libopenblas0)
set(CPACK_DEBIAN_COMMAND_LINE_PACKAGE_DEPENDS "libopenblas0, libcurl4")

set(CPACK_DEBIAN_COMMAND_LINE_PACKAGE_NAME kontur)
set(CPACK_DEBIAN_COMMAND_LINE_PACKAGE_RECOMMENDS fonts-dejavu-core)
set(CPACK_COMPONENT_COMMAND_LINE_DESCRIPTION "${PROJECT_DESCRIPTION} (command line)\nThe command line. Research software, not a medical device.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libkontur${KONTUR_SOVERSION})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
# CPack knows no triggers of its own: with a shlibs file it would write maintainer scripts that call ldconfig.
set(shlibs ${PROJECT_BINARY_DIR}/debian/library/shlibs)
file(CONFIGURE OUTPUT ${shlibs} CONTENT "libkontur ${KONTUR_SOVERSION} libkontur${KONTUR_SOVERSION} (>= ${PROJECT_VERSION})\n")
file(WRITE ${PROJECT_BINARY_DIR}/debian/library/triggers "activate-noawait ldconfig\n")
file(CHMOD ${shlibs} ${PROJECT_BINARY_DIR}/debian/library/triggers PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${shlibs} ${PROJECT_BINARY_DIR}/debian/library/triggers)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "${PROJECT_DESCRIPTION} (shared library)\nThe shared library.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libkontur-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libkontur${KONTUR_SOVERSION} (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${PROJECT_DESCRIPTION} (development files)\nHeaders and files to build against the library.")

math(EXPR Python_NEXT_MINOR "0${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-kontur)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
# A module is made for one version of Python.
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${Python_NEXT_MINOR}), python3-numpy, libopenblas0")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_SOURCE_DIR}/python3-kontur/prerm)
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "fonts-dejavu-core, libcurl4")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "${PROJECT_DESCRIPTION} (Python package)\nThe Python package.")
include(CPack)
