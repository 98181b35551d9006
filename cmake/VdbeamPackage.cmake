# cpack: vdbeam_VERSION_ARCH.deb with the program, libvdbeam-dev_VERSION_ARCH.deb with the library,
# python3-vdbeam_VERSION_ARCH.deb with the Python module.
# dpkg-shlibdeps finds what the program depends on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vdbeam)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
# Who builds the packages maintains them; Debian's own tools ask the environment as well (debchange(1)).
if(DEFINED ENV{DEBFULLNAME} AND DEFINED ENV{DEBEMAIL})
  set(vdbeam_packager "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
else()
  cmake_host_system_information(RESULT vdbeam_host QUERY FQDN)
  set(vdbeam_packager "vdbeam packager <$ENV{USER}@${vdbeam_host}>")
endif()
set(VDBEAM_MAINTAINER "${vdbeam_packager}" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_PACKAGE_CONTACT "${VDBEAM_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program development)
if(TARGET vdbeam_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME vdbeam)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "blender, python3") # of the add-on and the USD converter

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libvdbeam-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libopenvdb-dev, libtbb-dev, libopenexr-dev, libimath-dev, libpng-dev, libturbojpeg0-dev, zlib1g-dev, libfmt-dev, libtomlplusplus-dev, nlohmann-json3-dev, libhwy-dev, libxxhash-dev, libembree-dev, libassimp-dev, libopencolorio-dev")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vdbeam)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3-numpy")
include(CPack)
