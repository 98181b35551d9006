# All libraries come from the system's packages; nothing is downloaded.
macro(vdbeam_find)
  find_package(${ARGN} REQUIRED)
endmacro()
include(VdbeamLibraries)

set(VDBEAM_LIBRARIES OpenVDB::openvdb TBB::tbb OpenEXR::OpenEXR Imath::Imath PNG::PNG
    PkgConfig::TURBOJPEG ZLIB::ZLIB fmt::fmt tomlplusplus::tomlplusplus nlohmann_json::nlohmann_json PkgConfig::HWY PkgConfig::XXHASH
    embree assimp::assimp PkgConfig::OCIO)
set(VDBEAM_CLI_LIBRARIES CLI11::CLI11 fmt::fmt TBB::tbb nlohmann_json::nlohmann_json)
