# Finds the libraries that the vdbeam library links to: read by the build and, installed, by the
# package's config file. vdbeam_find is find_package in the one and find_dependency in the other.
vdbeam_find(TBB CONFIG)
vdbeam_find(Imath CONFIG)
vdbeam_find(OpenEXR CONFIG)
vdbeam_find(PNG)
vdbeam_find(ZLIB)
vdbeam_find(fmt CONFIG)
vdbeam_find(tomlplusplus CONFIG)
vdbeam_find(nlohmann_json CONFIG)
vdbeam_find(embree 3 CONFIG)
vdbeam_find(assimp CONFIG)
vdbeam_find(PkgConfig)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)

# OpenVDB ships find modules instead of a package config, and its folder's FindTBB and FindOpenEXR
# would shadow the config packages above, so the module path is restored at once.
set(vdbeam_saved_module_path ${CMAKE_MODULE_PATH})
list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_CXX_LIBRARY_ARCHITECTURE}/cmake/OpenVDB
     /usr/lib/cmake/OpenVDB /usr/local/lib/cmake/OpenVDB)
vdbeam_find(OpenVDB COMPONENTS openvdb)
set(CMAKE_MODULE_PATH ${vdbeam_saved_module_path})
