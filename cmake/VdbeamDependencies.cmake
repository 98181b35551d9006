# All libraries come from the system's packages; nothing is downloaded.
find_package(TBB CONFIG REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(Imath CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(tomlplusplus CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)

# OpenVDB ships find modules instead of a package config, and its folder's FindTBB and FindOpenEXR
# would shadow the config packages above, so the module path is restored at once.
set(vdbeam_saved_module_path ${CMAKE_MODULE_PATH})
list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_CXX_LIBRARY_ARCHITECTURE}/cmake/OpenVDB
     /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
find_package(OpenVDB REQUIRED COMPONENTS openvdb)
set(CMAKE_MODULE_PATH ${vdbeam_saved_module_path})

set(VDBEAM_LIBRARIES OpenVDB::openvdb TBB::tbb OpenEXR::OpenEXR Imath::Imath PNG::PNG fmt::fmt
    tomlplusplus::tomlplusplus nlohmann_json::nlohmann_json PkgConfig::HWY)
set(VDBEAM_CLI_LIBRARIES CLI11::CLI11 fmt::fmt TBB::tbb nlohmann_json::nlohmann_json)
